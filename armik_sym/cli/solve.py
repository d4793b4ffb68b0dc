"""`armik solve`: a hand path or a recording in, a joint trajectory out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from armik_sym.cli.arguments import backend_name, only_for_trajectory, rate, settings
from armik_sym.cli.console import say
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import figure_format_name, prepare_folder, write_results
from armik_sym.cli.progress_bar import ProgressBar
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
from armik_sym.cli.report import write_solution_report
from armik_sym.cli.solve_input import first_posture, read_job
from armik_sym.cli.solve_output import check_arm_file, write_fit
from armik_sym.cli.solve_remarks import remarks, tracking_of


def solve(
    file: Annotated[
        Path,
        typer.Argument(
            help="Hand path (csv), markers (trc, c3d, bvh, csv), joint angles (csv, mot, sto) or a recording "
            "of a device (armikrec)."
        ),
    ],
    arm: Annotated[
        str | None,
        typer.Option(
            help="Arm: a name (ehmcs, human, alfaiz) or a TOML file. Hand path, device: default ehmcs. Joint "
            "angles: the arm they are of, needed. Markers: the kind of arm that is fitted to the person, "
            "with its range of motion; default human."
        ),
    ] = None,
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
        str | None,
        typer.Option(
            help="Trajectory only: exact, or soft for noisy or unreachable paths. Default: exact; of markers "
            "soft."
        ),
    ] = None,
    max_speed: Annotated[float | None, typer.Option(help="Largest joint speed, in deg/s.")] = None,
    max_acceleration: Annotated[
        float | None, typer.Option(help="Trajectory only: largest joint acceleration, deg/s^2.")
    ] = None,
    start: Annotated[
        str | None,
        typer.Option(
            help="Known first posture: degrees, separated by commas, one per joint; or, with markers or "
            "joint angles, the word recorded."
        ),
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
    lengths: Annotated[
        str | None,
        typer.Option(help="Markers: segment lengths fitted to the person, or those of --arm: fitted or arm."),
    ] = None,
    figures: Annotated[
        bool,
        typer.Option(help="Also draw joint angles, hand path and swivel map; takes longer."),
    ] = False,
    figure_format: Annotated[
        str, typer.Option("--format", help="Of figures: png, or pdf or svg for papers.")
    ] = "png",
    report: Annotated[
        bool, typer.Option("--report", help="Also write the report, NAME_report.html; takes longer.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Seed of everything random.")] = 0,
    backend: Annotated[str, typer.Option(help="auto, c (compiled) or vm (no compiler needed).")] = "auto",
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("armik_out"),
) -> None:
    """Solve a hand path, given as it is, by markers of a person, by joint angles, or by a device.

    Markers: an arm is fitted to the person; NAME_arm.toml is that arm, NAME_fit.txt says how well it fits.
    Joint angles, device: what the hand did follows from --arm, and is solved anew.

    Writes the joint angles (csv, npz), with --figures also figures, and prints what they are worth.
    With --n-best, NAME_solution_2.csv and so on hold the next best trajectories.

    Exit code 0: ok; 1: solved, but not what was asked for; 2: error.
    """
    import armik_sym as ak

    chosen_backend, chosen_format = backend_name(backend), figure_format_name(figure_format)
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
    typed = RecordingOptions(points, side, frame, base, rom, cutoff, fill, unit, begin, end)
    job = read_job(file, arm, lengths, typed, calibration)
    first = first_posture(start, job)
    chosen_tracking = tracking_of(job, method, options)
    options |= {"tracking": chosen_tracking} if chosen_tracking else {}
    prepare_folder(out)
    check_arm_file(job, arm, out, file.stem)
    with ProgressBar(file.name) as progress:
        solution = ak.solve(
            job.arm,
            job.path,
            method,
            start=first,
            seed=seed,
            backend=chosen_backend,
            progress=progress,
            **options,
        )
    measured = None if job.recorded is None or job.own_lengths else job.recorded.measured
    written = write_results(
        solution,
        out,
        file.stem,
        data_formats=(".csv", ".npz"),
        measured=measured,
        title=file.name,
        backend=chosen_backend,
        figures=figures,
        figure_format=chosen_format,
    )
    if report:
        written.append(write_solution_report(solution, out, file.stem, measured=measured, title=file.name))
    notes = remarks(job, start, chosen_tracking)
    written += write_fit(job, out, file.stem, notes)
    if job.from_markers and job.recorded is not None:
        say(f"{job.recorded.report}\n")
    say(str(solution))
    for note in notes:
        say(f"  note            {note}")
    say("  written         " + ", ".join(str(name) for name in written))
    if not solution.ok:
        raise typer.Exit(NOT_OK)
