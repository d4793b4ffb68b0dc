"""`armik report`: one HTML file that shows a motion to a therapist and an engineer."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.arguments import backend_name
from armik_sym.cli.console import say
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import prepare_folder
from armik_sym.cli.progress_bar import ProgressBar
from armik_sym.cli.saved_solution import saved_solution
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.compiled.backend import Backend
    from armik_sym.motion.joint_motion import JointMotion
    from armik_sym.solution import Solution


def report(
    file: Annotated[
        Path,
        typer.Argument(
            help="A solution (npz, as armik solve writes it), joint angles (csv, mot, sto) or a hand path "
            "(csv), which is solved first."
        ),
    ],
    arm: Annotated[str, typer.Option(help="Arm: a name (ehmcs, human, alfaiz) or a TOML file.")] = "ehmcs",
    method: Annotated[str, typer.Option(help="How a hand path is solved, as in armik solve.")] = "trajectory",
    compare: Annotated[
        list[str] | None,
        typer.Option(help="Solve the hand path by this method, too, and put it beside; repeatable."),
    ] = None,
    measured: Annotated[
        Path | None, typer.Option(help="Measured joint angles (csv, mot, sto) to put beside.")
    ] = None,
    servo: Annotated[
        bool, typer.Option("--servo", help="Also simulate the drives of an exoskeleton (docs/servo.md).")
    ] = False,
    title: Annotated[
        str | None, typer.Option(help="What the motion is; default: the name of the file.")
    ] = None,
    note: Annotated[str | None, typer.Option(help="Where the data come from.")] = None,
    backend: Annotated[str, typer.Option(help="auto, c (compiled) or vm (no compiler needed).")] = "auto",
    out: Annotated[Path, typer.Option(help="The file to write, ending in .html.")] = Path(
        "armik_report.html"
    ),
) -> None:
    """Write a report: one HTML file with the verdict, an arm to turn and play, and all charts.

    It needs no network and no other file.

    Exit code 0: ok; 1: the motion is not what was asked for; 2: error.
    """
    import armik_sym as ak
    from armik_sym.motion.read_motion import read_motion
    from armik_sym.report.html import chapter_of, write_report

    chosen_backend = backend_name(backend)
    _check_target(out)
    model = ak.load_arm(arm)
    recorded = None if measured is None else read_motion(measured)
    with ProgressBar(file.name) as progress:
        found = saved_solution(file, model)
        if found is None:
            solution = ak.solve(
                model, ak.read_path(file), method, backend=chosen_backend, progress=progress
            )  # fmt: skip
            found = solution, True
    solution, path_known = found
    if compare and not path_known:
        raise OptionError(f"--compare: {file} holds joint angles alone, not the hand path that was asked for")
    chapter = chapter_of(
        solution,
        measured=recorded,
        others=solved_otherwise(solution, compare or [], chosen_backend),
        servo=servo,
        title=title or file.name,
        note=note,
        path_known=path_known,
    )
    prepare_folder(out.parent)
    written = write_report(out, [chapter])
    say(str(solution) if path_known else f"{'ok' if solution.ok else 'NOT ok'}: {len(solution.q)} samples")
    say(f"  written         {written}")
    if not solution.ok:
        raise typer.Exit(NOT_OK)


def write_solution_report(
    solution: Solution,
    folder: Path,
    stem: str,
    *,
    measured: JointMotion | None = None,
    title: str | None = None,
    note: str | None = None,
) -> Path:
    """Write the report of a solution beside its other files: `<stem>_report.html`.

    Args:
        solution: The solution, with its alternatives.
        folder: Where to; it exists.
        stem: First part of the name.
        measured: Measured motion of the same arm, or None.
        title: What the motion is.
        note: Where the data come from; None takes the note of the path.

    Returns:
        The file.

    Raises:
        MotionFileError: If the file cannot be written.

    Source:
        None (command line).
    """
    return solution.report(folder / f"{stem}_report.html", measured=measured, title=title, note=note)


def solved_otherwise(solution: Solution, methods: list[str], backend: Backend) -> dict[str, Solution]:
    """The task of a solution, solved by other methods from the same start.

    Args:
        solution: The solution.
        methods: Names of methods, as in `armik solve`.
        backend: "auto", "c" or "vm".

    Returns:
        Solutions by name of the method.

    Raises:
        OptionError: If a method is that of the solution, or there is no such method.

    Source:
        None (command line).
    """
    import armik_sym as ak

    found = {}
    for name in methods:
        if name == solution.method:
            raise OptionError(f"--compare {name}: the solution is by this method already")
        found[name] = ak.solve(solution.arm, solution.path, name, start=solution.start, backend=backend)
    return found


def _check_target(out: Path) -> None:
    if out.suffix.lower() not in (".html", ".htm"):
        raise OptionError(f"--out {out}: a report is written as .html")
