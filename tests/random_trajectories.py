"""Random feasible trajectories: smooth joint motions inside the limits and the hand paths they make.

`trajectories()` gives the whole set, always the same one: `COUNT` of each family in `FAMILIES`. Each family
aims at one kind of difficulty. Where the difficult places of an arm are comes from its recognised geometry.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from random_motions import Clock, motion_through, random_clock, random_waves
from scipy.spatial.transform import Rotation
from spherical_arms import odd, poses

from armik_sym.arm import Arm, DHConvention
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.axis_lines import turned
from armik_sym.swivel.closed_form import triple_angles
from armik_sym.swivel.equivalent_angles import nearest_in_range
from armik_sym.swivel.geometry import ELBOW_ZERO, pose_geometry
from armik_sym.swivel.reference import wrist_directions
from armik_sym.swivel.spherical_arm import recognise

COUNT = 20
SHOULDER, ELBOW, WRIST = 1, 3, 5  # the middle joint of each group

_EHMCS, _HUMAN, _ALFAIZ = ehmcs(), human(), alfaiz()
_ODD = (odd(DHConvention.STANDARD), odd(DHConvention.MODIFIED))
_PEOPLE = (_EHMCS, _HUMAN, _ALFAIZ)
_ALL = (*_PEOPLE, _ODD[0], *_PEOPLE, _ODD[1], _EHMCS, _HUMAN)


@dataclass(frozen=True, eq=False)
class RandomTrajectory:
    """A feasible trajectory: the arm with its range of motion, the path, and the angles that made it, (n, 7).

    `at` is the sample at (or just before) the place the family aims at; `margin` is how far inside the
    limits all angles are, in [rad].
    """

    family: str
    number: int
    arm: Arm
    path: HandPath
    q: np.ndarray
    at: int
    margin: float

    @property
    def name(self) -> str:
        return f"{self.family}-{self.number}"


@dataclass(frozen=True, eq=False)
class Aim:
    """What a motion shall do: arm, clock, some joint angles at the clock's moment, and how to pass them."""

    arm: Arm
    clock: Clock
    angles: dict[int, float] = field(default_factory=dict)
    turning: dict[int, int] = field(default_factory=dict)
    crossing: tuple[int, ...] = ()
    margin: float = np.deg2rad(0.5)
    top_speed: float = 4.0
    swing: tuple[float, float] = (0.3, 1.0)
    loops: int = 0


Family = Callable[[np.random.Generator, int], Aim]


def _someone(rng: np.random.Generator, number: int, arms: tuple[Arm, ...] = _ALL) -> Arm:
    """One of the arms in turn; every second person has other segment lengths."""
    arm = arms[number % len(arms)]
    if rng.random() < 0.5:
        return arm
    return arm.with_lengths(**{name: x * rng.uniform(0.75, 1.25) for name, x in arm.lengths.items()})


def wider(arm: Arm, joint: int, lower_deg: float, upper_deg: float) -> Arm:
    """The arm with another range of motion in one joint: a person who can do more than most."""
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[joint], upper[joint] = np.deg2rad([lower_deg, upper_deg])
    return arm.with_rom(lower, upper)


def singular_angles(arm: Arm, joint: int, reach: float = 0.0) -> np.ndarray:
    """Singular angles of the elbow or the middle joint of shoulder or wrist, inside the range of motion.

    Those at most `reach` [rad] outside count as well.
    """
    spherical = recognise(arm)
    offset = {
        SHOULDER: spherical.shoulder.offset,
        ELBOW: float(pose_geometry(spherical)[ELBOW_ZERO[0]]),
        WRIST: spherical.wrist.offset if spherical.wrist else 0.0,
    }[joint]
    period = 2 * np.pi if joint == ELBOW else np.pi  # the folded arm is not meant
    angles = -offset + period * np.arange(-4, 5)
    inside = (angles >= arm.rom.lower[joint] - reach) & (angles <= arm.rom.upper[joint] + reach)
    return angles[inside]


def _near(rng: np.random.Generator, arm: Arm, joint: int, off_deg: tuple[float, float]) -> tuple[float, int]:
    """An angle some degrees from a singular one, and on which side of it (±1)."""
    angle = rng.choice(singular_angles(arm, joint, reach=1e-6))
    off = np.deg2rad(rng.uniform(*off_deg))
    room = arm.rom.upper[joint] - angle - off, angle - off - arm.rom.lower[joint]
    side = 1 if room[0] > 0.1 and (room[1] < 0.1 or rng.random() < 0.5) else -1
    return angle + side * off, side


def _ordinary(rng: np.random.Generator, number: int) -> Aim:
    return Aim(_someone(rng, number), random_clock(rng))


def _wide_and_fast(rng: np.random.Generator, number: int) -> Aim:
    top = rng.uniform(6.0, 9.5)
    return Aim(_someone(rng, number), random_clock(rng), top_speed=top, swing=(1.5, 3.0))


def _wide_and_long(rng: np.random.Generator, number: int) -> Aim:
    """All over the range of motion and back, several times."""
    return Aim(
        _someone(rng, number),
        random_clock(rng, long=True),
        margin=np.deg2rad(0.1),
        top_speed=rng.uniform(6.0, 9.0),
        swing=(2.0, 4.0),
        loops=int(rng.integers(1, 3)),
    )


def _near_straight_arm(rng: np.random.Generator, number: int) -> Aim:
    arm = _someone(rng, number, _PEOPLE)
    angle, side = _near(rng, arm, ELBOW, (0.5, 3.0))
    return Aim(arm, random_clock(rng), {ELBOW: angle}, {ELBOW: side}, margin=np.deg2rad(0.1))


def _through_straight_arm(rng: np.random.Generator, number: int) -> Aim:
    """People whose elbow can be overstretched."""
    arm = wider(_someone(rng, number, _PEOPLE), ELBOW, -rng.uniform(8, 20), 145)
    clock = random_clock(rng, exact=number % 4 == 0)
    return Aim(arm, clock, {ELBOW: singular_angles(arm, ELBOW)[0]}, crossing=(ELBOW,))


def _wrist_limits(rng: np.random.Generator, number: int) -> Aim:
    arm, angles, turning = _someone(rng, number), {}, {}
    for joint in rng.choice([4, 5, 6], size=int(rng.integers(1, 4)), replace=False).tolist():
        off = 0.0 if rng.random() < 0.3 else np.deg2rad(rng.uniform(0, 1))
        side = int(rng.choice([1, -1]))
        angles[joint] = (arm.rom.lower if side > 0 else arm.rom.upper)[joint] + side * off
        turning[joint] = side
    return Aim(arm, random_clock(rng), angles, turning, margin=0.0)


def _wrist_singularity(rng: np.random.Generator, number: int) -> Aim:
    """Every third one turns round next to the singularity, the others pass through it."""
    arm = _someone(rng, number, (_ALFAIZ, _ODD[0], _HUMAN, _ODD[1], _EHMCS))
    if arm.name in ("ehmcs", "human", "alfaiz"):
        arm = wider(arm, WRIST, -rng.uniform(100, 125), rng.uniform(100, 125))
    if number % 3 == 2:
        angle, side = _near(rng, arm, WRIST, (0.2, 3.0))
        return Aim(arm, random_clock(rng), {WRIST: angle}, {WRIST: side})
    clock = random_clock(rng, exact=number % 2 == 0)
    return Aim(arm, clock, {WRIST: rng.choice(singular_angles(arm, WRIST))}, crossing=(WRIST,))


def _reference_line(rng: np.random.Generator, number: int) -> Aim:
    """The wrist passes through the line of the reference direction, every third one at 0.5-3° from it.

    For the arms of the catalogue: straight below or above the shoulder.
    """
    arm = _someone(rng, number)
    off = np.deg2rad(rng.uniform(0.5, 3)) if number % 3 == 2 else 0.0
    posture = _wrist_on_reference_line(rng, arm, off)
    return Aim(arm, random_clock(rng), dict(enumerate(posture)))


def _behind_the_shoulder(rng: np.random.Generator, number: int) -> Aim:
    """The wrist is at least 10 cm behind the shoulder (z points forward in these two)."""
    arm = _someone(rng, number, (_EHMCS, _HUMAN))
    spherical, inner = recognise(arm), np.deg2rad(2.0)
    while True:
        q = np.clip(arm.rom.random_postures(rng, 1), arm.rom.lower + inner, arm.rom.upper - inner)
        if wrist_directions(spherical, *poses(arm, q))[0, 2] < -0.1:
            return Aim(arm, random_clock(rng), dict(enumerate(q[0])))


def _through_shoulder_pole(rng: np.random.Generator, number: int) -> Aim:
    arm, clock = _someone(rng, number), random_clock(rng, exact=number % 2 == 0)
    return Aim(arm, clock, {SHOULDER: rng.choice(singular_angles(arm, SHOULDER))}, crossing=(SHOULDER,))


def _near_shoulder_pole(rng: np.random.Generator, number: int) -> Aim:
    arm = _someone(rng, number)
    angle, side = _near(rng, arm, SHOULDER, (0.2, 5.0))
    return Aim(arm, random_clock(rng), {SHOULDER: angle}, {SHOULDER: side})


def _rests(rng: np.random.Generator, number: int) -> Aim:
    return Aim(
        _someone(rng, number), random_clock(rng, slow=True, rests=True), top_speed=5.0, swing=(0.5, 1.2)
    )


def _loops(rng: np.random.Generator, number: int) -> Aim:
    return Aim(
        _someone(rng, number), random_clock(rng, slow=True), loops=int(rng.integers(1, 4)), top_speed=5.0
    )


def _tight_limits(rng: np.random.Generator, number: int) -> Aim:
    """A motion of another family; `trajectory` then narrows the range of motion to it."""
    return _UNLIMITED[number % len(_UNLIMITED)](rng, number)


_UNLIMITED: tuple[Family, ...] = (
    _ordinary,
    _wide_and_fast,
    _through_shoulder_pole,
    _reference_line,
    _near_straight_arm,
    _near_shoulder_pole,
    _wrist_singularity,
    _behind_the_shoulder,
)

FAMILIES: dict[str, Family] = {
    "ordinary": _ordinary,
    "wide_and_fast": _wide_and_fast,
    "wide_and_long": _wide_and_long,
    "near_straight_arm": _near_straight_arm,
    "through_straight_arm": _through_straight_arm,
    "wrist_limits": _wrist_limits,
    "wrist_singularity": _wrist_singularity,
    "reference_line": _reference_line,
    "behind_the_shoulder": _behind_the_shoulder,
    "through_shoulder_pole": _through_shoulder_pole,
    "near_shoulder_pole": _near_shoulder_pole,
    "tight_limits": _tight_limits,
    "rests": _rests,
    "loops": _loops,
}


def trajectory(family: str, number: int) -> RandomTrajectory:
    """One trajectory of the set; it depends on family and number only."""
    rng = np.random.default_rng([zlib.crc32(family.encode()), number])
    aim = FAMILIES[family](rng, number)
    q, arm, margin = _moved(rng, aim), aim.arm, aim.margin
    if family == "tight_limits":
        beyond = np.deg2rad(rng.uniform(0.5, 5.0, (2, arm.dof)))
        lower = np.maximum(arm.rom.lower, q.min(axis=0) - beyond[0])
        upper = np.minimum(arm.rom.upper, q.max(axis=0) + beyond[1])
        arm, margin = arm.with_rom(lower, upper), min(margin, np.deg2rad(0.5)) * (1 - 1e-9)
    path = HandPath(aim.clock.time, *poses(arm, q), note=f"{family}-{number}")
    return RandomTrajectory(family, number, arm, path, q, aim.clock.at, margin)


def trajectories(families: Iterable[str] = tuple(FAMILIES), limit: int = COUNT) -> Iterator[RandomTrajectory]:
    """The set, family by family, the first `limit` of each."""
    for family in families:
        for number in range(limit):
            yield trajectory(family, number)


def _moved(rng: np.random.Generator, aim: Aim) -> np.ndarray:
    """A motion that does what is aimed at; joints that are not named take random angles at the moment."""
    rom, dof = aim.arm.rom, aim.arm.dof
    posture = rom.middle + rom.width * rng.uniform(-0.3, 0.3, dof)
    for joint, angle in aim.angles.items():
        posture[joint] = angle
    waves = random_waves(rng, dof, aim.clock.moment, aim.crossing, aim.loops)
    return motion_through(
        aim.clock,
        waves,
        posture,
        rom.lower + aim.margin,
        rom.upper - aim.margin,
        swing=rng.uniform(*aim.swing, dof),
        top_speed=aim.top_speed,
        turning=aim.turning,
        crossing=aim.crossing,
    )


def _wrist_on_reference_line(rng: np.random.Generator, arm: Arm, off: float) -> np.ndarray:
    """A posture with the wrist `off` [rad] from the line of the reference direction.

    The whole arm of a random posture is turned rigidly about the shoulder: only joints 1-3 change.
    """
    spherical, inner = recognise(arm), np.deg2rad(2.0)
    lower, upper = arm.rom.lower + inner, arm.rom.upper - inner
    shoulder, r = spherical.shoulder, spherical.reference
    aside = np.cross(r, np.eye(3)[np.argmin(np.abs(r))])
    aim = Rotation.from_rotvec(off * aside / np.linalg.norm(aside)).apply(r)
    while True:
        q = np.clip(arm.rom.random_postures(rng, 1), lower, upper)
        w = wrist_directions(spherical, *poses(arm, q))[0]
        goal = aim * rng.choice([1.0, -1.0])
        twist = Rotation.from_rotvec(goal * rng.uniform(-np.pi, np.pi))
        turn = (twist * Rotation.align_vectors([goal], [w / np.linalg.norm(w)])[0]).as_matrix()
        R = np.eye(3)
        for axis, angle in zip(spherical.lines.direction[:3], q[0, :3], strict=True):
            R = R @ turned(axis, np.array([angle]))[0]
        Q = (shoulder.before.T @ turn @ R @ shoulder.after).reshape(1, 9)
        for side in (1, -1):
            angles = triple_angles(shoulder, Q, side, lower[:3], upper[:3])[0]
            q[:, :3] = nearest_in_range(angles, lower[:3], upper[:3], arm.rom.middle[None, :3])
            if np.all((q >= lower) & (q <= upper)):
                return q[0]
