"""`armik demo`: the main job on the bundled tasks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.arguments import backend_name
from armik_sym.cli.console import plain_table, say, show
from armik_sym.cli.demo_row import HEADINGS, row
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import prepare_folder, write_results
from armik_sym.cli.progress_bar import ProgressBar

if TYPE_CHECKING:
    from armik_sym.motion.tasks import Task
    from armik_sym.solution import Solution

_ABOUT = (
    "The data are synthetic: paths and 'measured' joint angles resemble the five tasks of Nguyen 2021, whose "
    "recordings were never published. Each task is solved from its first measured posture; two joint "
    "trajectories may put the hand on the same path, so the difference to the measured one is not an error."
)


def demo(
    out: Annotated[Path, typer.Option(help="Folder for figures and joint angles.")] = Path("armik_demo"),
    backend: Annotated[str, typer.Option(help="auto, c (compiled) or vm (no compiler needed).")] = "auto",
) -> None:
    """Solve the five bundled tasks and draw them.

    The data are synthetic. The solution is compared with the joint angles the paths belong to.

    Exit code 0: all solved; 1: a verdict is not ok; 2: error.
    """
    import armik_sym as ak

    chosen_backend = backend_name(backend)
    arm = ak.catalog.ehmcs()
    tasks = [ak.load_task(name) for name in ak.task_names()]
    prepare_folder(out)
    solved: list[tuple[Task, Solution]] = []
    with ProgressBar("demo", steps=len(tasks)) as progress:
        for task in tasks:
            progress.begin(task.title)
            solution = ak.solve(
                arm, task.path, start=task.measured.q[0], backend=chosen_backend, progress=progress
            )
            write_results(
                solution,
                out,
                task.name,
                data_formats=(".csv",),
                measured=task.measured,
                title=task.title,
                backend=chosen_backend,
            )
            solved.append((task, solution))
            progress.finish()
    _report(solved, out)
    if not all(solution.ok for _, solution in solved):
        raise typer.Exit(NOT_OK)


def _report(solved: list[tuple[Task, Solution]], out: Path) -> None:
    (out / "README.txt").write_text(f"{_ABOUT}\n", encoding="utf-8")
    table = plain_table(HEADINGS)
    for task, solution in solved:
        table.add_row(*row(task, solution))
    show(table)
    say("")
    for task, solution in solved:
        for reason in solution.reasons:
            say(f"{task.name}: {reason}")
    say(_ABOUT)
    say(
        f"Written to {out}: <task>_solution.csv, <task>_joints.png, <task>_hand.png and "
        "<task>_swivel_map.png of every task."
    )
