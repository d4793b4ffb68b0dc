"""The report of `armik demo`: five tasks, each solved as a whole, by Pro-ISADE and by ISADE."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from armik_sym.cli.progress_bar import ProgressBar
    from armik_sym.compiled.backend import Backend
    from armik_sym.motion.tasks import Task
    from armik_sym.report.html import Chapter
    from armik_sym.solution import Solution

REPORT = "report.html"

_OTHERS = {"Pro-ISADE": "pro-isade", "ISADE": "isade"}
_TITLE = "Five tasks of daily life"
_NOTE = (
    "Synthetic data: paths and 'measured' angles resemble the tasks of Nguyen 2021, whose recordings were "
    "never published. Every task is solved as a whole from its first measured posture"
)


def write_demo_report(
    solved: list[tuple[Task, Solution]], folder: Path, backend: Backend, progress: ProgressBar
) -> Path:
    """Write `report.html`: every task with its drives simulated, beside the methods of the paper.

    Without a C compiler the methods of the paper would take minutes; then they are left out.

    Args:
        solved: The tasks and their solutions.
        folder: Where to; it exists.
        backend: "auto", "c" or "vm".
        progress: The progress bar; takes one step per task.

    Returns:
        The file.

    Raises:
        MotionFileError: If the file cannot be written.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    import armik_sym as ak
    from armik_sym.report.html import chapter_of, write_report
    from armik_sym.servo import check

    compiled = ak.compile(solved[0][1].arm, backend=backend).backend == "c"
    beside = "; Pro-ISADE and ISADE, which take one instant after another, stand beside it"
    note = f"{_NOTE}{beside if compiled else ''}."
    chapters: list[Chapter] = []
    for task, solution in solved:
        progress.begin(f"{task.title}: report")
        others = {
            name: ak.solve(solution.arm, task.path, method, start=solution.start, backend=backend)
            for name, method in _OTHERS.items()
            if compiled
        }
        chapters.append(
            chapter_of(
                solution,
                measured=task.measured,
                others=others,
                # The drives under all three methods once, for the first task: each simulation takes a second.
                servo=True if not chapters else check(solution),
                title=task.title,
                note="",
            )
        )
        progress.finish()
    return write_report(folder / REPORT, chapters, title=_TITLE, note=note)
