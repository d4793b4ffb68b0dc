"""The set of random feasible trajectories: it is what it says, and the default method solves all of it."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from random_trajectories import COUNT, FAMILIES, RandomTrajectory, trajectories, trajectory
from reference_cost import cost, full_space_from
from smooth_motions import objective, path_of, smooth_angles, uneven_time

import armik_sym as ak
from armik_sym.arm import DHConvention
from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.errors import ArmikError
from armik_sym.trajectory.options import TrajectoryOptions

SPEED_LIMIT = TrajectoryOptions().max_speed
COST_SLACK, LARGEST_ERROR = 1.001, 1e-9


@functools.cache
def family(name: str) -> tuple[RandomTrajectory, ...]:
    return tuple(trajectories([name]))


def axes(of: RandomTrajectory) -> tuple[np.ndarray, np.ndarray]:
    """Direction of every joint's axis and a point on it, (n, 7, 3), from the frames of the chain."""
    frames = joint_frames(of.arm.chain, of.q, of.arm.lengths)
    before = of.arm.chain.convention is DHConvention.STANDARD
    rows = [i + (not before) for i, link in enumerate(of.arm.chain.links) if link.moves]
    return frames[:, rows][..., :3, 2], frames[:, rows][..., :3, 3]


def crossing_point(z: np.ndarray, p: np.ndarray, first: int) -> np.ndarray:
    """Where two axes that meet do so, shape (n, 3), by least squares."""
    A = np.stack([z[:, first], -z[:, first + 1]], axis=2)
    along = (np.linalg.pinv(A) @ (p[:, first + 1] - p[:, first])[:, :, None])[:, 0]
    return p[:, first] + along * z[:, first]


def from_line(v: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Angle between vectors and a line, 0 to 90°, in [deg]."""
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(v, line), axis=-1), np.abs((v * line).sum(axis=-1))))


def from_singularity(of: RandomTrajectory, what: str) -> np.ndarray:
    """Angle to the straight arm, the shoulder pole, the wrist singularity or the reference line, in [deg]."""
    z, p = axes(of)
    if what in ("shoulder", "wrist"):
        first = 0 if what == "shoulder" else 4
        return from_line(z[:, first], z[:, first + 2])
    shoulder, wrist = crossing_point(z, p, 0), crossing_point(z, p, 4)
    if what == "elbow":
        elbow = p[:, 3] + z[:, 3] * (z[:, 3] * (shoulder - p[:, 3])).sum(axis=1)[:, None]
        return from_line(elbow - shoulder, wrist - elbow)
    rest = RandomTrajectory(of.family, 0, of.arm, of.path, np.zeros((1, 7)), 0, 0.0)
    z0, p0 = axes(rest)
    s0 = crossing_point(z0, p0, 0)
    upper_arm = p0[:, 3] + z0[:, 3] * (z0[:, 3] * (s0 - p0[:, 3])).sum(axis=1)[:, None] - s0
    return from_line(wrist - shoulder, upper_arm)


def test_the_set_is_large_enough_and_no_two_are_alike() -> None:
    every = [of for name in FAMILIES for of in family(name)]
    assert len(every) >= 220
    assert all(len(family(name)) == COUNT >= 20 for name in FAMILIES)
    assert len({of.q.tobytes() for of in every}) == len(every)
    assert {of.arm.name for of in every} == {"ehmcs", "human", "alfaiz", "odd_standard", "odd_modified"}
    assert len({tuple(of.arm.length_values) for of in every}) > 80
    uneven = [np.ptp(np.diff(of.path.time)) > 1e-6 for of in every]
    assert 0.2 < np.mean(uneven) < 0.5


@pytest.mark.parametrize("name", FAMILIES)
def test_trajectories_are_feasible_and_natural(name: str) -> None:
    for of in family(name):
        n, duration = len(of.path), of.path.duration
        assert 60 <= n <= 300
        assert 1.0 <= duration <= 6.0
        assert 49 <= n / duration <= 201
        assert of.arm.rom.margin(of.q).min() >= of.margin - 1e-15 >= -1e-15
        speed = np.diff(of.q, axis=0) / np.diff(of.path.time)[:, None]
        assert np.abs(speed).max() < SPEED_LIMIT
        # Smooth: from one sample to the next the speed changes by a part of itself only.
        assert np.abs(np.diff(speed, axis=0)).max() < 0.6 * np.abs(speed).max()
        assert np.ptp(of.q, axis=0).min() > np.deg2rad(3)
        position, rotation = hand_pose(of.arm.chain, of.q, of.arm.lengths)
        np.testing.assert_allclose(of.path.position, position, atol=1e-15)
        np.testing.assert_allclose(of.path.rotation, rotation, atol=1e-14)


def test_trajectories_depend_on_family_and_number_only() -> None:
    for name in FAMILIES:
        again = trajectory(name, 3)
        np.testing.assert_array_equal(again.q, family(name)[3].q)
        np.testing.assert_array_equal(again.path.time, family(name)[3].path.time)
        np.testing.assert_array_equal(again.arm.rom.lower, family(name)[3].arm.rom.lower)


@pytest.mark.parametrize(
    ("name", "what", "nearest_deg", "farthest_deg"),
    [
        ("near_straight_arm", "elbow", 0.5, 3.0),
        ("through_straight_arm", "elbow", 0.0, 3.0),
        ("wrist_singularity", "wrist", 0.0, 3.0),
        ("reference_line", "reference", 0.0, 4.0),
        ("through_shoulder_pole", "shoulder", 0.0, 3.0),
        ("near_shoulder_pole", "shoulder", 0.2, 5.0),
    ],
)
def test_trajectories_pass_where_their_family_aims(
    name: str, what: str, nearest_deg: float, farthest_deg: float
) -> None:
    for of in family(name):
        away = from_singularity(of, what)
        assert nearest_deg - 1e-6 <= away[of.at] <= farthest_deg + 1e-6
        assert away.max() > 5.0


@pytest.mark.parametrize(
    ("name", "what", "joint"),
    [
        ("through_straight_arm", "elbow", 3),
        ("through_shoulder_pole", "shoulder", 1),
        ("wrist_singularity", "wrist", 5),
    ],
)
def test_some_hit_the_singularity_at_a_sample_and_some_between_two(name: str, what: str, joint: int) -> None:
    through = [of for of in family(name) if name != "wrist_singularity" or of.number % 3 != 2]
    hits = 0
    for of in through:
        away, q = from_singularity(of, what), of.q[:, joint]
        hits += away[of.at] < 1e-6
        before, after = q[of.at] - q[of.at - 1], q[of.at + 2] - q[of.at + 1]
        assert before * after > 0, "the joint passes, it does not turn round"
    assert 3 <= hits <= len(through) - 3


def test_wrist_limits_are_approached_and_touched() -> None:
    margins = [of.arm.rom.margin(of.q)[:, 4:].min() for of in family("wrist_limits")]
    assert max(margins) <= np.deg2rad(1.0)
    assert 3 <= sum(margin == 0 for margin in margins) < COUNT


def test_the_wrist_passes_behind_the_shoulder() -> None:
    for of in family("behind_the_shoulder"):
        z, p = axes(of)
        assert (crossing_point(z, p, 4) - crossing_point(z, p, 0))[of.at, 2] < -0.08


def test_tight_limits_leave_few_degrees() -> None:
    for of in family("tight_limits"):
        spare = np.rad2deg(of.arm.rom.width - np.ptp(of.q, axis=0))
        assert spare.min() > 0.4
        assert spare.max() < 10.0


def test_wide_motions_are_wide_and_fast_or_long() -> None:
    for of in family("wide_and_long"):
        assert np.ptp(of.q, axis=0).max() > 1.8
        assert of.path.duration >= 4.0 - 1e-12
    for of in family("wide_and_fast"):
        assert np.ptp(of.q, axis=0).max() > 1.5
        speed = np.abs(np.diff(of.q, axis=0) / np.diff(of.path.time)[:, None])
        assert speed.max() > 4.5


def test_resting_hands_rest() -> None:
    for of in family("rests"):
        still = np.abs(np.diff(of.q, axis=0)).max(axis=1) < 1e-12
        assert 0.1 < still.mean() < 0.7
        assert np.abs(np.diff(of.path.position[[*np.flatnonzero(still)]], axis=0)).max() > 0.01


def test_loops_are_closed() -> None:
    for of in family("loops"):
        np.testing.assert_allclose(of.q[0], of.q[-1], atol=1e-12)
        assert np.ptp(of.q, axis=0).max() > 0.2


@pytest.mark.parametrize("weights", [(1.0, 0.01, 1e-3), (0.0, 0.3, 2.0), (2.0, 0.0, 0.0)])
def test_the_cost_is_the_integral_summed_by_hand(weights: tuple[float, float, float]) -> None:
    arm = ehmcs()
    names = ("speed_weight", "acceleration_weight", "posture_weight")
    options = TrajectoryOptions(**dict(zip(names, weights, strict=True)))
    q = smooth_angles(arm, 90, 11)
    path = path_of(arm, q, uneven_time(90, 11))
    assert cost(arm, path, q, options) == pytest.approx(
        objective(path.time, q, arm.rom.middle, weights), rel=1e-10
    )
    still = np.tile(arm.rom.middle, (90, 1))
    assert cost(arm, path, still, options) == pytest.approx(0.0, abs=1e-12)


def test_the_reference_improves_on_the_motion_it_starts_from() -> None:
    of = trajectory("ordinary", 0)
    reference = full_space_from(of.arm, of.path, of.q)
    assert reference.converged
    assert 0 < reference.cost < cost(of.arm, of.path, of.q)
    assert reference.cost == pytest.approx(cost(of.arm, of.path, reference.q))
    again = full_space_from(of.arm, of.path, reference.q)
    assert again.cost == pytest.approx(reference.cost, rel=1e-6)


@pytest.mark.parametrize("name", FAMILIES)
def test_the_default_method_solves_all_from_cold_and_as_well_as_from_the_generating_motion(name: str) -> None:
    missed = [f"{of.name} ({of.arm.name}): {reason}" for of in family(name) if (reason := what_is_wrong(of))]
    assert not missed, "\n".join(missed)


def what_is_wrong(of: RandomTrajectory) -> str:
    """What the default method misses; empty if nothing."""
    try:
        solution = ak.solve(of.arm, of.path)
    except ArmikError as error:
        return f"{type(error).__name__}: {error}"
    ratio = cost(of.arm, of.path, solution.q) / full_space_from(of.arm, of.path, of.q).cost
    errors = max(solution.position_error.max(), solution.rotation_error.max())
    if not solution.ok or solution.rom_margin.min() < 0 or errors > LARGEST_ERROR:
        return "; ".join(solution.reasons) or f"largest error {errors:.2g} m or rad"
    return "" if ratio <= COST_SLACK else f"cost {ratio:.5f} times that from the generating motion"
