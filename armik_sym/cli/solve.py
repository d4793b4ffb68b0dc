"""`armik solve`: a hand path in, a joint trajectory out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from armik_sym.cli.arguments import backend_name, only_for_trajectory, posture, rate, settings
from armik_sym.cli.console import say
from armik_sym.cli.device_recording import hand_path
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import prepare_folder, write_results
from armik_sym.cli.progress_bar import ProgressBar


def solve(
    file: Annotated[
        Path,
        typer.Argument(
            help="Hand path: a CSV file with units in its header; or a recording of a device (.armikrec)."
        ),
    ],
    arm: Annotated[str, typer.Option(help="Arm: a name (ehmcs, human, alfaiz) or a TOML file.")] = "ehmcs",
    method: Annotated[
        str,
        typer.Option(
            help="trajectory solves all samples at once; pro-isade, isade, lm, sugihara, alfaiz one by one."
        ),
    ] = "trajectory",
    orientation: Annotated[
        str | None,
        typer.Option(
            help="full, none or (trajectory only) pointing; default: full if the path has rotations."
        ),
    ] = None,
    tracking: Annotated[
        str | None, typer.Option(help="Trajectory only: exact, or soft for noisy or unreachable paths.")
    ] = None,
    max_speed: Annotated[float | None, typer.Option(help="Largest joint speed, in deg/s.")] = None,
    max_acceleration: Annotated[
        float | None, typer.Option(help="Trajectory only: largest joint acceleration, deg/s^2.")
    ] = None,
    start: Annotated[
        str | None, typer.Option(help="Known first posture: degrees, separated by commas, one per joint.")
    ] = None,
    search: Annotated[
        str | None,
        typer.Option(
            help="Trajectory only: auto (the swivel map where it fits, else full space), swivel, full-space."
        ),
    ] = None,
    n_best: Annotated[
        int | None,
        typer.Option(help="Trajectory only: how many different trajectories are wanted at most; default: 1."),
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Further option of the method (SI), repeatable."),
    ] = None,
    figures: Annotated[
        bool,
        typer.Option(help="Also draw joint angles, hand path and swivel map (png); takes longer."),
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 0,
    backend: Annotated[str, typer.Option(help="auto, c (compiled) or vm (no compiler needed).")] = "auto",
    calibration: Annotated[
        Path | None,
        typer.Option(help="Calibration (TOML) for a recording of a device; default: the one in it."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("armik_out"),
) -> None:
    """Solve a hand path.

    Writes the joint angles (csv, npz), with --figures also figures (png), and prints what they are worth.
    With --n-best, NAME_solution_2.csv and so on hold the next best trajectories.

    Exit code 0: ok; 1: solved, but not what was asked for; 2: error.
    """
    import armik_sym as ak

    chosen_backend = backend_name(backend)
    words = {"orientation": orientation, "tracking": tracking, "search": search, "n_best": n_best}
    only_for_trajectory(
        method,
        {
            "--tracking": tracking,
            "--max-acceleration": max_acceleration,
            "--search": search,
            "--n-best": n_best,
        },
    )
    options: dict[str, Any] = {
        **settings(set_ or []),
        **rate("max_speed", max_speed),
        **rate("max_acceleration", max_acceleration),
        **{name: value for name, value in words.items() if value is not None},
    }
    model = ak.load_arm(arm)
    path = hand_path(file, model, calibration)
    first = None if start is None else posture(start, model)
    prepare_folder(out)
    with ProgressBar(file.name) as progress:
        solution = ak.solve(
            model,
            path,
            method,
            start=first,
            seed=seed,
            backend=chosen_backend,
            progress=progress,
            **options,
        )
    written = write_results(
        solution,
        out,
        file.stem,
        data_formats=(".csv", ".npz"),
        title=file.name,
        backend=chosen_backend,
        figures=figures,
    )
    say(str(solution))
    say("  written         " + ", ".join(str(name) for name in written))
    if not solution.ok:
        raise typer.Exit(NOT_OK)
