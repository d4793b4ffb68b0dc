"""One line of the table `armik demo` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from armik_sym.motion.tasks import Task
    from armik_sym.solution import Solution

# Heading, and whether the column holds numbers.
HEADINGS = [
    ("task", False),
    ("samples", True),
    ("position\nerror\n[mm]", True),
    ("rotation\nerror\n[deg]", True),
    ("smallest\nmargin\n[deg]", True),
    ("largest\nstep\n[deg]", True),
    ("largest\ndifference to\nmeasured [deg]", True),
    ("mean\n[deg]", True),
    ("time\n[s]", True),
    ("verdict", False),
]


def row(task: Task, solution: Solution) -> list[str]:
    """The figures of one solved task, as text.

    Args:
        task: The task.
        solution: Its solution.

    Returns:
        One cell per heading; the differences to the measured angles are over all joints and samples.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    import numpy as np

    columns = [task.measured.joint_names.index(name) for name in solution.arm.joint_names]
    difference = np.rad2deg(np.abs(solution.q - task.measured.q[:, columns]))
    return [
        task.name,
        str(len(solution.q)),
        f"{1000 * solution.position_error.max():.1e}",
        f"{np.rad2deg(solution.rotation_error.max()):.1e}",
        f"{np.rad2deg(solution.rom_margin.min()):.2f}",
        f"{np.rad2deg(solution.max_step.max()):.2f}",
        f"{difference.max():.1f}",
        f"{difference.mean():.1f}",
        f"{solution.timing.total:.2f}",
        "ok" if solution.ok else "NOT ok",
    ]
