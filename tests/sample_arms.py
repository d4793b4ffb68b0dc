"""Arms that the tests of symbolic and compiled kinematics share."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from armik_sym.arm import Arm, DHChain, DHConvention, DHLink, JointType, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human


def _rigid(rotvec: list[float], shift: list[float]) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rotvec).as_matrix()
    T[:3, 3] = shift
    return T


def custom(convention: DHConvention) -> Arm:
    """Prismatic, fixed and odd-angled rows, base and tool, a length used twice, an awkward description."""
    rows = (
        DHLink("lift", theta=0.3, d=0.1, a=0.05, alpha=0.4, joint=JointType.PRISMATIC, sign=-1),
        DHLink("turn", theta=0.7, d=-0.2, a="upper", alpha=-1.1, sign=-1),
        DHLink("bracket", theta=-0.4, d="upper", a=0.03, alpha=0.9, joint=JointType.FIXED),
        DHLink("bend", theta=np.pi / 2, d="lower", a=0.02, alpha=np.pi / 2),
        DHLink("slide", d=0.2, alpha=-0.3, joint=JointType.PRISMATIC),
        DHLink("roll", theta=np.pi),
    )
    return Arm(
        f"custom_{convention.value}",
        DHChain(
            rows, convention, _rigid([0.1, 0.2, -0.3], [0.1, 0.2, 0.3]), _rigid([-0.4, 0.2, 0.9], [0.1, 0, 0])
        ),
        RangeOfMotion([-0.2, -3, -2, 0, -3], [0.2, 3, 2, 0.5, 3]),
        {"upper": 0.31, "lower": 0.27},
        description="odd */ /* ??/ \\ – ü @ARM@ \n#error x",
    )


BARE = Arm(
    "bare", DHChain((DHLink("a", d=0.1, alpha=0.5), DHLink("b", a=0.2))), RangeOfMotion([-1, -1], [1, 1])
)

ARMS = {
    arm.name: arm
    for arm in (
        ehmcs(),
        human(),
        alfaiz(),
        ehmcs(4),
        ehmcs(5),
        custom(DHConvention.STANDARD),
        custom(DHConvention.MODIFIED),
    )
}


def postures(arm: Arm, n: int, seed: int = 0, stretch: float = 1.0) -> np.ndarray:
    """Random postures, shape (n, dof); `stretch` > 1 leaves the range of motion."""
    middle, half = arm.rom.middle, 0.5 * arm.rom.width * stretch
    return np.random.default_rng(seed).uniform(middle - half, middle + half, (n, arm.dof))
