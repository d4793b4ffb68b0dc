"""Fig. 14 of Nguyen 2021: without its search window the search finds the hand, but the arm jumps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import armik_sym as ak


def main(out: Path = Path("armik_out")) -> int:
    """Solve the reaching task with ISADE, Pro-ISADE and the whole-trajectory method; draw the joints."""
    arm = ak.catalog.ehmcs(dof=5)
    task = ak.load_task("drinking_reach")
    start = task.measured.q[0, : arm.dof]

    solutions = {}
    for method in ("isade", "pro-isade", "trajectory"):
        solution = ak.solve(arm, task.path, method, start=start, orientation="none")
        solutions[method] = solution
        print(
            f"{method:10s} hand error {1000 * solution.position_error.max():.1e} mm, largest step "
            f"{np.rad2deg(solution.max_step.max()):6.2f}°, {'ok' if solution.ok else 'NOT ok'}"
        )

    out.mkdir(exist_ok=True)
    picture = draw(task, solutions)
    picture.savefig(out / "published_methods.png", dpi=110)
    print(f"figure: {out / 'published_methods.png'}")
    return 0


def draw(task, solutions) -> Figure:
    """One panel per method: joint angles over time, the measured ones dotted."""
    figure = Figure(figsize=(11, 3.6), layout="constrained")
    panels = figure.subplots(1, len(solutions), sharey=True)
    names = [name.replace("_", " ") for name in task.measured.joint_names[:5]]
    for axes, (method, solution) in zip(panels, solutions.items(), strict=True):
        for i, name in enumerate(names):
            axes.plot(solution.time, np.rad2deg(solution.q[:, i]), color=f"C{i}", linewidth=1.3, label=name)
            axes.plot(solution.time, np.rad2deg(task.measured.q[:, i]), ":", color=f"C{i}", linewidth=1)
        axes.set_title(f"{method}: largest step {np.rad2deg(solution.max_step.max()):.1f}°")
        axes.set_xlabel("time [s]")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("joint angle [deg]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(names))
    figure.suptitle(f"{task.title} (synthetic): the same hand path, solved (lines) and measured (dotted)")
    return figure


if __name__ == "__main__":
    main()
