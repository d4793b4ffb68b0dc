"""`armik servo`: can the drives of an exoskeleton follow a motion?"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from armik_sym.cli.console import say
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.output_files import prepare_folder
from armik_sym.cli.progress_bar import ProgressBar
from armik_sym.cli.servo_input import motion_of

if TYPE_CHECKING:
    from armik_sym.servo import ServoCheck


def servo(
    file: Annotated[
        Path,
        typer.Argument(
            help="Joint angles (csv, npz, mot, sto; as armik solve writes them) or a hand path (csv)."
        ),
    ],
    arm: Annotated[str, typer.Option(help="Arm: a name (ehmcs, human, alfaiz) or a TOML file.")] = "ehmcs",
    method: Annotated[str, typer.Option(help="How a hand path is solved, as in armik solve.")] = "trajectory",
    drive: Annotated[
        str, typer.Option(help="Drives: a name or a TOML file (docs/servo.md).")
    ] = "light_exoskeleton",
    controller: Annotated[str, typer.Option(help="cascade (position over speed) or pid.")] = "cascade",
    bandwidth: Annotated[float, typer.Option(help="Crossover frequency of the loop, in Hz.")] = 8.0,
    phase_margin: Annotated[
        float | None, typer.Option(help="In degrees; default 65 for cascade, 50 for pid.")
    ] = None,
    feedforward: Annotated[str, typer.Option(help="none, speed or acceleration.")] = "acceleration",
    gravity: Annotated[bool, typer.Option("--gravity", help="The controller compensates gravity.")] = False,
    rate: Annotated[
        float | None, typer.Option(help="Of the controller, in Hz; default: of the drive.")
    ] = None,
    mass: Annotated[float, typer.Option(help="Of the person, in kg.")] = 73.0,
    stature: Annotated[float, typer.Option(help="Of the person, in m.")] = 1.741,
    sex: Annotated[str, typer.Option(help="male or female: which table of segment masses.")] = "male",
    hand_tolerance: Annotated[float, typer.Option(help="Largest error of the hand, in mm.")] = 10.0,
    joint_tolerance: Annotated[float, typer.Option(help="Largest error of a joint, in degrees.")] = 2.0,
    retime: Annotated[
        bool, typer.Option("--retime", help="Also re-time the motion as fast as the drives allow.")
    ] = False,
    figures: Annotated[bool, typer.Option(help="Draw tracking and loops (png).")] = True,
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("armik_servo"),
) -> None:
    """Simulate the drives of an exoskeleton following a motion.

    Prints what each joint is asked for and what its drive can do, how far joints and hand are off, and if the
    drives cannot follow, by how much slower they can.

    Exit code 0: the drives can follow; 1: they cannot; 2: error.
    """
    import armik_sym as ak
    from armik_sym.servo import Subject, Tolerances, check

    tolerances = Tolerances(joint=math.radians(joint_tolerance), hand=0.001 * hand_tolerance)
    person = Subject(mass, stature, sex)
    margin = None if phase_margin is None else math.radians(phase_margin)
    options: dict[str, Any] = {
        "bandwidth": bandwidth, "phase_margin": margin, "feedforward": feedforward,
        "gravity": gravity, "rate": rate,
    }  # fmt: skip
    model = ak.load_arm(arm)
    motion: Any = motion_of(file, model)
    prepare_folder(out)
    if motion is None:
        with ProgressBar(file.name) as progress:
            motion = ak.solve(model, ak.read_path(file), method, progress=progress)
    found = check(motion, drive, controller, tolerances=tolerances, subject=person, **options)
    say(str(found))
    if not found.ok:
        say(f"  slower          {_slower(found)}")
    written = _figures(found, out, file.stem, file.name) if figures else []
    if retime:
        written += _retime(found, out, file.stem, figures)
    if written:
        say("  written         " + ", ".join(str(name) for name in written))
    if not found.ok:
        raise typer.Exit(NOT_OK)


def _slower(found: ServoCheck) -> str:
    factor = found.slower_by
    if factor is None:
        return f"they cannot, even if everything takes {found.largest:g} times as long"
    return f"they can if everything takes {factor:.4g} times as long"


def _figures(found: ServoCheck, out: Path, stem: str, title: str) -> list[Path]:
    from armik_sym.report import save_figure

    return [
        save_figure(found.plot(title=title), out / f"{stem}_servo.png"),
        save_figure(found.plot_loops(), out / f"{stem}_loops.png"),
    ]


def _retime(found: ServoCheck, out: Path, stem: str, figures: bool) -> list[Path]:
    from armik_sym.errors import RetimingError
    from armik_sym.motion import JointMotion, write_motion
    from armik_sym.report import save_figure

    try:
        result = found.retimed()
    except RetimingError as error:
        say(f"  re-timed        cannot be: {error}")
        return []
    if result is None:
        say("  re-timed        no re-timing within the limits of the drives is followed")
        return []
    motion, again = result
    say(str(motion))
    say(str(again))
    written = out / f"{stem}_retimed.csv"
    names = found.setup.arm.joint_names
    write_motion(written, JointMotion(motion.time, motion.q, names))
    if not figures:
        return [written]
    return [written, save_figure(again.plot(title=f"{stem}, re-timed"), out / f"{stem}_retimed_servo.png")]
