"""The same hand path solved by three methods and followed by the same drives: what jumps cost.

    python benchmarks/servo.py                 the tables of docs/servo.md
    python benchmarks/servo.py --slower        also by how much slower the drives could follow (takes minutes)
    python benchmarks/servo.py --feedforward none --controller pid

ISADE searches every pose anew and may jump from sample to sample; Pro-ISADE searches near the sample before;
the whole-trajectory method minimises speed over the whole path. Each is solved from the first measured
posture of the bundled (synthetic) tasks, and followed in simulation by the drives of the package.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import armik_sym as ak
from armik_sym.servo import ServoCheck

METHODS = ("isade", "pro-isade", "trajectory")


def row(task: str, method: str, check: ServoCheck, slower: bool) -> str:
    """One line of the table."""
    tracking = check.tracking
    error = np.rad2deg(tracking.joint_error)
    most = max(v.torque / v.torque_limit for v in check.joints)
    fast = max(v.speed / v.speed_limit for v in check.joints)
    cells = [task, method, f"{1000 * tracking.hand_rms:.2f}", f"{1000 * tracking.hand_peak:.2f}"]
    cells += [f"{np.sqrt(np.mean(error**2)):.3f}", f"{np.abs(error).max():.2f}"]
    cells += [f"{100 * fast:.0f} %", f"{100 * most:.0f} %", "yes" if check.ok else "no"]
    if slower:
        factor = check.slower_by
        cells.append(f"> {check.largest:g}" if factor is None else f"{factor:.2f}")
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Solve, follow, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--slower", action="store_true")
    parser.add_argument("--controller", default="cascade", choices=("cascade", "pid"))
    parser.add_argument("--feedforward", default="acceleration", choices=("none", "speed", "acceleration"))
    parser.add_argument("--rate", type=float)
    parser.add_argument("--task", action="append", choices=ak.task_names())
    asked = parser.parse_args()
    arm = ak.catalog.ehmcs()
    heads = ["task", "method", "hand RMS [mm]", "hand peak [mm]", "joints RMS [°]", "joints peak [°]",
             "speed of limit", "torque of limit", "follows"]  # fmt: skip
    heads += ["slower by"] if asked.slower else []
    print(f"| {' | '.join(heads)} |\n|---|---|{'--:|' * (len(heads) - 2)}", flush=True)
    spent, simulated = 0.0, 0.0
    for name in asked.task or ak.task_names():
        task = ak.load_task(name)
        for method in METHODS:
            solution = ak.solve(arm, task.path, method, start=task.measured.q[0])
            begin = time.process_time()
            options = {"feedforward": asked.feedforward, "rate": asked.rate}
            check = ak.servo.check(solution, controller=asked.controller, **options)
            spent += time.process_time() - begin
            simulated += check.tracking.passes * task.path.duration
            print(row(name, method, check, asked.slower), flush=True)
    print(f"\nchecks: {spent / simulated:.3f} s of processor time per second of simulated motion and pass")


if __name__ == "__main__":
    main()
