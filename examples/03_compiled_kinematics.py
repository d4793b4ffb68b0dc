"""Compiled kinematics: many postures at once, and C for a robot controller."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import armik_sym as ak


def main(out: Path = Path("armik_out")) -> int:
    """Evaluate 100,000 postures without a Python loop, then write the C library."""
    arm = ak.catalog.human(upper_arm=0.30, forearm=0.25, hand=0.18)
    kinematics = ak.compile(arm)

    rng = np.random.default_rng(0)
    q = arm.rom.lower + arm.rom.width * rng.uniform(0, 1, (100_000, arm.dof))
    positions = kinematics.position(q)
    jacobians = kinematics.jacobian(q)
    print(f"backend {kinematics.backend}: positions {positions.shape}, Jacobians {jacobians.shape}")
    print(f"farthest reach {np.linalg.norm(positions, axis=1).max():.3f} m of {arm.reach:.3f} m")

    folder = ak.emit_c(arm, out / "human_c", precision="float")
    print("C library:", sorted(file.name for file in folder.iterdir()))
    return 0


if __name__ == "__main__":
    main()
