"""`armik calibrate`: from the counts of a device to its joint angles."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.calibrate_input import channels_typed
from armik_sym.cli.console import plain_table, say, show
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.device.calibration import Calibration


def calibrate(
    out: Annotated[Path, typer.Option(help="The calibration to write (.toml).")],
    port: Annotated[
        str | None, typer.Option(help="Port of the device: /dev/ttyUSB0, COM3, socket://HOST:PORT, ...")
    ] = None,
    source: Annotated[
        Path | None,
        typer.Option(
            "--from", help="Postures recorded before (.toml, see docs/device.md), instead of a port."
        ),
    ] = None,
    arm: Annotated[str, typer.Option(help="The arm that is measured: a name or an arm file.")] = "ehmcs",
    channels: Annotated[
        str | None, typer.Option(help="Channel of each joint, from 0, base to hand, separated by commas.")
    ] = None,
    datasheet: Annotated[
        str | None,
        typer.Option(
            metavar="SIGNS",
            help="Zero pose only: scales of the datasheets (345° over a potentiometer's track, counts per "
            "turn of an encoder), and these directions, such as +,-,+,+,-.",
        ),
    ] = None,
    zero: Annotated[
        Path | None,
        typer.Option(
            help="Zero pose only: take this calibration with new zeros of its encoders (after power-up)."
        ),
    ] = None,
    thorough: Annotated[
        bool, typer.Option("--thorough", help="Hold every joint half-way too: finds angles typed wrongly.")
    ] = False,
    angle_error: Annotated[
        float, typer.Option(help="How well the angles of postures are known, standard error in degrees.")
    ] = 0.0,
    seconds: Annotated[float, typer.Option(help="How long each posture is recorded, in seconds.")] = 1.0,
    baud: Annotated[int | None, typer.Option(help="Bits per second.")] = None,
) -> None:
    """Find scale, direction and zero of every joint: guided, posture by posture, or from a file.

    Postures are kept as they are taken: after Ctrl-C or an error the same command goes on from there.
    """
    from armik_sym.cli.calibrate_guided import Guided, new_zeros
    from armik_sym.device.calibration import fit_calibration, save_calibration
    from armik_sym.device.calibration.posture_file import load_postures

    _check(port, source, zero, datasheet, seconds)
    if not out.parent.is_dir():
        raise OptionError(f"--out {out}: there is no folder {out.parent}")
    if source is not None:
        read = load_postures(source)
        found = fit_calibration(read.info, read.postures, read.setups, angle_error=math.radians(angle_error))
    elif zero is not None:
        found = new_zeros(zero, str(port), seconds, baud)
    else:
        guided = Guided(str(port), baud, out, arm, channels_typed(channels), datasheet, thorough, seconds)
        found = guided.calibration(math.radians(angle_error))
    _show(found)
    say(f"\n{save_calibration(found, out)}: calibration of device {found.device_id}")


def _check(
    port: str | None, source: Path | None, zero: Path | None, datasheet: str | None, seconds: float
) -> None:
    if (port is None) == (source is None):
        raise OptionError(
            "give either --port, to calibrate a device, or --from, with postures recorded before"
        )
    if source is not None and (zero is not None or datasheet is not None):
        raise OptionError("--zero and --datasheet go with --port: a file says itself what is given in it")
    if zero is not None and datasheet is not None:
        raise OptionError("--zero and --datasheet exclude each other")
    if not 0.05 <= seconds <= 60:
        raise OptionError(f"--seconds is {seconds:g}, expected 0.05 to 60")


def _show(calibration: Calibration) -> None:
    from armik_sym.device.calibration.text import COLUMNS, rows

    table = plain_table([(name, name not in ("joint", "sensor")) for name in COLUMNS])
    for row in rows(calibration):
        table.add_row(*row)
    say("")
    show(table)
    for note in calibration.notes:
        say(f"note: {note}")
