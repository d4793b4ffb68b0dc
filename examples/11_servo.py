"""Servo: can the drives of an exoskeleton follow a solved motion, and if not, how much slower can they?"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.report import save_figure


def main(out: Path = Path("armik_out")) -> int:
    """Check a task, hurry it, slow it down, re-time it."""
    out.mkdir(exist_ok=True)
    arm, task = ak.catalog.ehmcs(), ak.load_task("drinking_lift")
    smooth = ak.solve(arm, task.path, start=task.measured.q[0])

    found = ak.servo.check(smooth, subject=ak.servo.Subject(mass=80.0, stature=1.80))
    print(found)
    print(f"figure: {save_figure(found.plot(title=task.title), out / 'servo.png')}")
    print(f"figure: {save_figure(found.plot_loops(), out / 'servo_loops.png')}\n")

    trembling = ak.solve(arm, task.path, "pro-isade", start=task.measured.q[0])
    other = ak.servo.check(trembling)
    off = (1000 * each.tracking.hand_peak for each in (other, found))
    print("Pro-ISADE on the same path: hand off by {:.1f} mm, instead of {:.1f} mm".format(*off))
    print(f"first reason: {other.reasons[0]}\n")

    hurried = ak.servo.ArmMotion(arm, smooth.time / 6, smooth.q)
    fast = ak.servo.check(hurried)
    print(f"six times as fast: {fast.reasons[0]}")
    print(f"slowed uniformly it works with a factor of {fast.slower_by:.3g}")

    retimed = ak.servo.retime(smooth, speed=np.deg2rad(40), acceleration=np.deg2rad(120))
    print(retimed)
    print("re-timed and checked again:", "ok" if ak.servo.check(retimed).ok else "NOT ok")
    return 0


if __name__ == "__main__":
    main()
