"""Arms with spherical shoulder and wrist that the tests of the swivel angle share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from armik_sym.arm import Arm, DHChain, DHConvention, DHLink, JointType, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose

RIGHT_ANGLE = np.pi / 2


def rigid(rotvec: list[float], shift: list[float]) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rotvec).as_matrix()
    T[:3, 3] = shift
    return T


def odd(convention: DHConvention) -> Arm:
    """Base, tool, fixed rows, signs, offsets; an elbow that is bent, shifted and askew in every way."""
    bracket = DHLink("bracket", theta=0.2, d=0.01, a=0.02, alpha=0.1, joint=JointType.FIXED)
    if convention is DHConvention.STANDARD:
        rows = (
            DHLink("stand", theta=0.5, d=0.2, a=0.1, alpha=0.8, joint=JointType.FIXED),
            DHLink("s1", theta=0.3, d=0.12, alpha=-RIGHT_ANGLE, sign=-1),
            DHLink("s2", theta=-0.8, alpha=RIGHT_ANGLE),
            DHLink("s3", theta=0.4, d="upper", a=0.03, alpha=1.2, sign=-1),
            bracket,
            DHLink("elbow", theta=1.1, d=0.02, a=0.03, alpha=-1.0),
            DHLink("w1", theta=-0.4, d="fore", alpha=RIGHT_ANGLE),
            DHLink("w2", theta=0.9, alpha=RIGHT_ANGLE, sign=-1),
            DHLink("w3", theta=0.6, d=0.05, a="hand", alpha=0.7),
        )
    else:
        rows = (
            DHLink("s1", theta=0.3, d=0.12, a=0.05, alpha=0.3, sign=-1),
            DHLink("s2", theta=-0.8, alpha=-RIGHT_ANGLE),
            DHLink("s3", theta=0.4, d="upper", alpha=RIGHT_ANGLE, sign=-1),
            bracket,
            DHLink("elbow", theta=1.1, d=0.02, a=0.03, alpha=1.3),
            DHLink("w1", theta=-0.4, d="fore", a=0.02, alpha=-1.2),
            DHLink("w2", theta=0.9, alpha=RIGHT_ANGLE, sign=-1),
            DHLink("w3", theta=0.6, d="hand", alpha=RIGHT_ANGLE),
        )
    base, tool = rigid([0.1, 0.2, -0.3], [0.1, 0.2, 0.3]), rigid([-0.4, 0.2, 0.9], [0.1, 0.0, 0.02])
    return Arm(
        f"odd_{convention.value}",
        DHChain(rows, convention, base, tool),
        RangeOfMotion([-2.0, -1.5, -2.5, -0.5, -2.0, -1.0, -3.0], [2.5, 1.0, 2.0, 2.0, 1.5, 1.2, 3.6]),
        {"upper": 0.3, "fore": 0.25, "hand": 0.08},
    )


ARMS = {
    arm.name: arm
    for arm in (ehmcs(), human(), alfaiz(), odd(DHConvention.STANDARD), odd(DHConvention.MODIFIED))
}
OF_THE_PAPERS = ("ehmcs", "human", "alfaiz")
BRANCHES = [(e, s, w) for e in (1, -1) for s in (1, -1) for w in (1, -1)]


def changed_row(arm: Arm, name: str, **values: object) -> Arm:
    """The arm with another DH row of that name."""
    links = tuple(replace(link, **values) if link.name == name else link for link in arm.chain.links)
    chain = DHChain(links, arm.chain.convention, arm.chain.base, arm.chain.tool)
    lengths = {key: value for key, value in arm.lengths.items() if key in chain.length_names}
    return Arm(arm.name, chain, arm.rom, lengths)


def anywhere(n: int, seed: int, dof: int = 7) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (n, dof))


def poses(arm: Arm, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return hand_pose(arm.chain, q, arm.lengths)


def pose_error(arm: Arm, q: np.ndarray, position: np.ndarray, rotation: np.ndarray) -> float:
    """Largest difference in [m], and in the entries of rotation matrices (about [rad])."""
    p, R = poses(arm, q)
    return max(float(np.abs(p - position).max()), float(np.abs(R - rotation).max()))


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Difference of angles modulo whole turns."""
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi)
