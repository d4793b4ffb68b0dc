"""Shoulder angles measured by the exoskeleton, as angles of the human arm (Nguyen 2021, Fig. 15)."""

from __future__ import annotations

import numpy as np

import armik_sym as ak


def main() -> int:
    """Convert a task's device angles, show them as a clinician names them, and convert them back."""
    measured = ak.load_task("brushing").measured.q  # synthetic device angles, (n, 7) [rad]
    arm = ak.elbow.human_posture(measured)

    names = ("flexion", "abduction", "internal rotation")
    for name, angle in zip(names, np.rad2deg(arm[:, :3]).T, strict=True):
        print(
            f"shoulder {name:18s} {angle[0]:7.1f}° at the start, {angle.min():7.1f}° to {angle.max():6.1f}°"
        )

    back = ak.elbow.device_posture(arm)
    print(f"there and back: {np.abs(back - measured).max():.1e} rad")

    q_human = ak.elbow.device_to_human(measured[:, :3])  # the angles q' of eq. (8) themselves
    print(f"q' of eq. (8) at the start: {np.round(q_human[0], 4)} rad")
    return 0


if __name__ == "__main__":
    main()
