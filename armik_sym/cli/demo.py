"""`armik demo`: the main job on the bundled tasks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.arguments import backend_name
from armik_sym.cli.console import plain_table, say, show
from armik_sym.cli.demo_report import REPORT, write_demo_report
from armik_sym.cli.demo_row import HEADINGS, row
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import figure_format_name, prepare_folder, write_results
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
    figure_format: Annotated[
        str, typer.Option("--format", help="Of the figures: png, or pdf or svg for papers.")
    ] = "png",
    report: Annotated[bool, typer.Option(help="Also write report.html, with the drives simulated.")] = True,
) -> None:
    """Solve the five bundled tasks, draw them, and write a report to be opened in a browser.

    The data are synthetic. The solution is compared with the joint angles the paths belong to, and where
    there is a C compiler with Pro-ISADE and ISADE.

    Exit code 0: all solved; 1: a verdict is not ok; 2: error.
    """
    import armik_sym as ak

    chosen_backend, ending = backend_name(backend), figure_format_name(figure_format)
    arm = ak.catalog.ehmcs()
    tasks = [ak.load_task(name) for name in ak.task_names()]
    prepare_folder(out)
    solved: list[tuple[Task, Solution]] = []
    with ProgressBar("demo", steps=len(tasks) * (2 if report else 1)) as progress:
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
                figure_format=ending,
            )
            solved.append((task, solution))
            progress.finish()
        if report:
            write_demo_report(solved, out, chosen_backend, progress)
    _tell(solved, out, ending, report)
    if not all(solution.ok for _, solution in solved):
        raise typer.Exit(NOT_OK)


def _tell(solved: list[tuple[Task, Solution]], out: Path, ending: str, report: bool) -> None:
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
        f"Written to {out}: <task>_solution.csv, <task>_joints.{ending}, <task>_hand.{ending} and "
        f"<task>_swivel_map.{ending} of every task."
    )
    if report:
        say(f"Open this in a browser: {out / REPORT}")
