"""A patient whose joints move less: the same path, other limits, and what happens at the edge."""

from __future__ import annotations

import numpy as np

import armik_sym as ak


def main() -> int:
    """Narrow the range of motion until exact tracking becomes impossible, then track softly."""
    arm = ak.catalog.ehmcs()
    path = ak.load_task("drinking_lift").path

    stiff = arm.with_rom(*narrowed(arm, "shoulder_abduction", -50.0, 15.0))
    print(ak.solve(stiff, path))

    elbow = arm.with_rom(*narrowed(arm, "elbow_flexion", 0.0, 100.0))
    try:
        ak.solve(elbow, path)
    except ak.ArmikError as error:
        print(f"\n{error}\n")
    print(ak.solve(elbow, path, tracking="soft", position_tolerance=0.2, rotation_tolerance=0.5))
    return 0


def narrowed(arm: ak.Arm, joint: str, lower_deg: float, upper_deg: float) -> tuple[np.ndarray, np.ndarray]:
    """Limits of an arm with one joint narrowed."""
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    i = arm.joint_index(joint)
    lower[i], upper[i] = np.deg2rad([lower_deg, upper_deg])
    return lower, upper


if __name__ == "__main__":
    main()
