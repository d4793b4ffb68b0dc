"""`armik compare`: what methods say a person does, beside what the person did."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.arguments import backend_name
from armik_sym.cli.compare_output import say_all, write_comparisons
from armik_sym.cli.console import say
from armik_sym.cli.failures import NOT_OK, paragraph
from armik_sym.cli.output_files import prepare_folder
from armik_sym.cli.progress_bar import ProgressBar
from armik_sym.cli.recorded import Recorded, kind_of, read_recorded
from armik_sym.cli.recording_options import (
    Base,
    Begin,
    Calibration,
    Cutoff,
    End,
    Fill,
    Frame,
    Points,
    RecordingOptions,
    Rom,
    Side,
    Unit,
)
from armik_sym.errors import ArmModelError, OptionError, SolverError, UnknownNameError, UnreachablePathError

if TYPE_CHECKING:
    from armik_sym.comparison import Comparison
    from armik_sym.compiled.backend import Backend

_DEFAULT = ("trajectory", "pro-isade", "swivel-constant")


def compare(
    recording: Annotated[
        Path,
        typer.Argument(
            help="Markers (trc, c3d, bvh, csv), joint angles (csv, mot, sto; with --arm) or a recording of a "
            "device (armikrec)."
        ),
    ],
    points: Points = None,
    side: Side = None,
    frame: Frame = None,
    base: Base = None,
    rom: Rom = None,
    cutoff: Cutoff = None,
    fill: Fill = None,
    unit: Unit = None,
    begin: Begin = None,
    end: End = None,
    calibration: Calibration = None,
    arm: Annotated[
        str | None,
        typer.Option(
            help="A name or a TOML file. Joint angles: the arm they are of, needed. Markers: the kind of arm "
            "that is fitted (default: human). Device: the one it was calibrated as (default: ehmcs)."
        ),
    ] = None,
    method: Annotated[
        list[str] | None,
        typer.Option(
            help="Repeatable: a method of armik solve, or swivel-constant (default: "
            "trajectory, pro-isade, swivel-constant)."
        ),
    ] = None,
    tracking: Annotated[str, typer.Option(help="Of method trajectory: soft or exact.")] = "soft",
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 0,
    backend: Annotated[str, typer.Option(help="auto, c (compiled) or vm (no compiler needed).")] = "auto",
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("armik_compare"),
) -> None:
    """Compare solved motions with what a person did.

    Fits an arm to the markers, solves its hand path from the first measured posture only, by each method, and
    compares joint angles, swivel of the elbow and its position with the measured ones.
    swivel-constant keeps the swivel angle of the first posture: what any method should be better than.

    A difference is no error: many postures put the hand on the same path.

    Exit code 0: compared; 1: a method found no solution; 2: error.
    """
    chosen_backend = backend_name(backend)
    if tracking not in ("soft", "exact"):
        raise OptionError(f"--tracking is {tracking!r}: valid are soft, exact")
    kind = kind_of(recording)
    if kind == "path":
        raise OptionError(
            f"{recording} holds a hand path, which tells nothing of joints to compare with: use armik solve"
        )
    typed = RecordingOptions(points, side, frame, base, rom, cutoff, fill, unit, begin, end)
    recorded = read_recorded(recording, kind, arm, typed, calibration)
    wanted = _methods(method, recorded)
    prepare_folder(out)
    found, failed = _all(recorded, wanted, tracking, seed, chosen_backend)
    say_all(recorded, found, failed)
    written = write_comparisons(recorded, found, failed, out, chosen_backend)
    say("written: " + ", ".join(str(file) for file in written))
    if failed:
        raise typer.Exit(NOT_OK)


def _methods(typed: list[str] | None, recorded: Recorded) -> list[str]:
    """The methods asked for, each once; by default those the arm can be solved with."""
    from armik_sym.comparison import predictors
    from armik_sym.swivel.spherical_arm import why_not_spherical

    if typed is None:
        no_swivel = why_not_spherical(recorded.arm) or recorded.path.rotation is None
        return [name for name in _DEFAULT if not (name == "swivel-constant" and no_swivel)]
    for name in typed:
        if name not in predictors():
            raise UnknownNameError("method", name, predictors())
    return list(dict.fromkeys(typed))


def _all(
    recorded: Recorded, wanted: list[str], tracking: str, seed: int, backend: Backend
) -> tuple[dict[str, Comparison], dict[str, str]]:
    """The comparison of each method that found a solution, and why the others found none."""
    from armik_sym.comparison import compare as compared
    from armik_sym.comparison import predict

    found, failed = {}, {}
    with ProgressBar(recorded.name, steps=len(wanted)) as progress:
        for name in wanted:
            progress.begin(name)
            try:
                solution = predict(
                    recorded.arm,
                    recorded.path,
                    recorded.measured.q[0],
                    name,
                    tracking="exact" if tracking == "exact" else "soft",
                    seed=seed,
                    backend=backend,
                    progress=progress,
                )
            except (SolverError, UnreachablePathError, ArmModelError) as error:
                failed[name] = paragraph(error)
            else:
                found[name] = compared(solution, recorded.measured, backend=backend)
            progress.finish()
    return found, failed
