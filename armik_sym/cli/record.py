"""`armik record`: what a measuring device sends, into a file that survives whatever happens."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.console import say
from armik_sym.cli.device_recording import ENDING
from armik_sym.cli.failures import NOT_OK
from armik_sym.cli.record_view import RecordView
from armik_sym.cli.stop_signals import stopping
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.device.angles import LiveAngles
    from armik_sym.device.calibration import Calibration

_EXTRAS = ("swivel", "endpoint")


def record(
    port: Annotated[
        str,
        typer.Option(
            help="/dev/ttyUSB0, COM3, socket://HOST:PORT, rfc2217://HOST:PORT, or what pyserial takes."
        ),
    ],
    out: Annotated[Path, typer.Option(help="Recording to write (.armikrec); never overwritten.")],
    baud: Annotated[
        int | None, typer.Option(help="Bits per second of the firmware; default: 500000.")
    ] = None,
    calibration: Annotated[
        Path | None, typer.Option(help="Calibration (TOML) of the device: for angles, live and as .csv.")
    ] = None,
    arm: Annotated[
        str | None, typer.Option(help="Arm that the device is, for endpoint and swivel; default: ehmcs.")
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="Record for so long; default: until Ctrl-C.")] = None,
    wait: Annotated[float, typer.Option(help="Give up if no sample comes within so many seconds.")] = 3.0,
    live: Annotated[
        str, typer.Option(metavar="WHAT,...", help="Show these live, too: swivel, endpoint.")
    ] = "",
) -> None:
    """Record a device until Ctrl-C: every byte is in the file as it arrives.

    Shows rate, losses and, with --calibration, joint angles of device and human arm; a line that breaks is
    opened again. With --calibration, NAME.csv with the joint angles is written at the end.

    Exit code 0: ok; 1: recorded, but samples were lost; 2: error.
    """
    wanted = _wanted(live, calibration)
    if arm is not None and calibration is None:
        raise OptionError("--arm is for angles: give --calibration FILE, too")
    if out.suffix.lower() != ENDING:
        raise OptionError(f"--out {out}: recordings end in {ENDING}: {out.with_suffix(ENDING)}")
    table = out.with_suffix(".csv")
    if calibration is not None and table.exists():
        raise OptionError(f"{table}: exists already, and the angles would overwrite it: choose another --out")
    from armik_sym.device.recording import DEFAULT_BAUD, Recorder

    chosen = _calibration(calibration)
    with RecordView(_live_angles(chosen, arm), chosen, wanted) as view:
        recorder = Recorder(
            port,
            out,
            baud=DEFAULT_BAUD if baud is None else baud,
            calibration=chosen,
            wait=wait,
            notices=view.notices.put,
        )
        view.watch(recorder)
        with stopping(recorder.stop):
            summary = recorder.run(seconds)
    say(str(summary))
    if chosen is not None:
        _write_angles(out, table)
    if summary.status.lost or summary.status.gaps:
        raise typer.Exit(NOT_OK)


def _wanted(live: str, calibration: Path | None) -> frozenset[str]:
    wanted = frozenset(word.strip() for word in live.split(",") if word.strip())
    unknown = sorted(wanted - set(_EXTRAS))
    if unknown:
        raise OptionError(f"--live {unknown[0]!r}: valid are {', '.join(_EXTRAS)}")
    if wanted and calibration is None:
        raise OptionError(f"--live {','.join(sorted(wanted))} needs angles: give --calibration FILE")
    return wanted


def _calibration(file: Path | None) -> Calibration | None:
    from armik_sym.device.calibration import load_calibration

    return None if file is None else load_calibration(file)


def _live_angles(calibration: Calibration | None, arm: str | None) -> LiveAngles | None:
    if calibration is None:
        return None
    import armik_sym as ak
    from armik_sym.device.angles import LiveAngles

    return LiveAngles(calibration, None if arm is None else ak.load_arm(arm))


def _write_angles(out: Path, table: Path) -> None:
    from armik_sym.device.recording import read_recording

    recording = read_recording(out)
    recording.save(table)
    say(f"  angles          {table}")
