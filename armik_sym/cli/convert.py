"""`armik convert`: a recording, joint angles or an arm in another file format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armik_sym.cli.console import say
from armik_sym.cli.device_recording import convert_device_recording, is_device_recording
from armik_sym.cli.option_checks import number_or_word, only
from armik_sym.cli.recording_options import Calibration
from armik_sym.errors import OptionError


def convert(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="IN",
            help="Markers (.trc, .c3d, .csv, .bvh), joint angles (.mot, .sto, .csv), a recording of a device "
            "(.armikrec), or an arm.",
        ),
    ],
    target: Annotated[
        Path,
        typer.Argument(
            metavar="OUT",
            help="Markers: .trc, .c3d, .csv. Joint angles: .mot, .sto, .csv. Arm: .urdf, .toml.",
        ),
    ],
    unit: Annotated[
        str | None,
        typer.Option(help="Unit of lengths in a .bvh file, which has none: m, cm, mm, or metres per unit."),
    ] = None,
    joints: Annotated[
        str | None, typer.Option(help="Only these columns of joint angles, separated by commas.")
    ] = None,
    fill: Annotated[
        float | None, typer.Option(help="Fill gaps of markers up to this many seconds (cubic spline).")
    ] = None,
    cutoff: Annotated[
        float | None, typer.Option(help="Low-pass filter markers at this many Hz (zero-phase Butterworth).")
    ] = None,
    nexus: Annotated[
        bool, typer.Option("--nexus", help="Write a .csv of markers in the form of Vicon Nexus.")
    ] = False,
    calibration: Calibration = None,
) -> None:
    """Write a file in another format: units and names are kept, gaps stay gaps unless --fill is given."""
    if source.exists() and target.exists() and source.samefile(target):
        raise OptionError(f"{target}: would be overwritten by itself: choose another name")
    typed = {
        "--unit": unit,
        "--joints": joints,
        "--fill": fill,
        "--cutoff": cutoff,
        "--nexus": nexus or None,
        "--calibration": calibration,
    }
    if target.suffix.lower() in (".urdf", ".toml"):
        only("an arm", typed)
        _arm(source, target)
        return
    if is_device_recording(source):
        only("a recording of a device", typed, ("--calibration",))
        convert_device_recording(source, target, calibration)
        return
    from armik_sym.motion.file_kind import file_kind

    kind = file_kind(source)
    if kind == "path":
        raise OptionError(f"{source}: is a hand path, which no other format holds: convert markers or angles")
    if kind == "markers":
        only("markers", typed, ("--unit", "--fill", "--cutoff", "--nexus"))
        _markers(source, target, unit, fill, cutoff, nexus)
    else:
        only("joint angles", typed, ("--joints",))
        _angles(source, target, None if joints is None else [name.strip() for name in joints.split(",")])


def _arm(source: Path, target: Path) -> None:
    import armik_sym as ak

    arm = ak.load_arm(source)
    (ak.save_urdf if target.suffix.lower() == ".urdf" else ak.save_arm)(arm, target)
    say(f"{target}: arm {arm.name}, joints {', '.join(arm.joint_names)}")


def _markers(
    source: Path, target: Path, unit: str | None, fill: float | None, cutoff: float | None, nexus: bool
) -> None:
    from armik_sym.motion import read_markers, write_markers

    recording = read_markers(source, number_or_word(unit))
    if fill is not None:
        recording = recording.filled("cubic", fill)
    if cutoff is not None:
        recording = recording.filtered(cutoff)
    write_markers(target, recording, nexus=nexus)
    said = f" ({recording.note})" if recording.note else ""
    say(f"{target}: {recording!r}{said}")


def _angles(source: Path, target: Path, joints: list[str] | None) -> None:
    from armik_sym.motion import read_motion, read_storage, write_motion, write_storage

    endings = source.suffix.lower(), target.suffix.lower()
    if joints is None and all(ending in (".mot", ".sto") for ending in endings):
        # A table of forces, or of angles and translations, goes through as it is.
        table = read_storage(source)
        write_storage(target, table)
        say(f"{target}: {table!r}")
        return
    motion = read_motion(source, joints)
    write_motion(target, motion)
    say(f"{target}: {motion!r}")
