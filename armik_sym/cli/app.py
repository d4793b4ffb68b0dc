"""The command `armik`: its sub-commands, and what is common to all of them."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from armik_sym._version import __version__
from armik_sym.cli.calibrate import calibrate
from armik_sym.cli.compare import compare
from armik_sym.cli.convert import convert
from armik_sym.cli.demo import demo
from armik_sym.cli.doctor import doctor
from armik_sym.cli.emit_c import emit_c
from armik_sym.cli.failures import FailingGroup
from armik_sym.cli.record import record
from armik_sym.cli.report import report
from armik_sym.cli.servo import servo
from armik_sym.cli.simulate_device import simulate_device
from armik_sym.cli.solve import solve

# Plain help and plain usage errors: the same in a terminal, a pipe and a log file.
app = typer.Typer(
    name="armik",
    cls=FailingGroup,
    help="Whole-trajectory inverse kinematics of the human arm.",
    epilog="Exit codes: 0 ok, 1 solved but not what was asked for, 2 error. ARMIK_DEBUG=1 shows tracebacks.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
_SOLVING = (demo, solve, compare, report, servo, convert, emit_c)
_DEVICE = (calibrate, record, simulate_device)
for command in (*_SOLVING, *_DEVICE, doctor):
    app.command(no_args_is_help=False)(command)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"armik_sym {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", help="Show the version.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    """Whole-trajectory inverse kinematics of the human arm."""


def main() -> None:
    """Run the command `armik`; the process ends with its exit code.

    Source:
        None (command line).
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            # A terminal that cannot show "°" shows "?" instead of a traceback.
            stream.reconfigure(errors="replace")
    app(prog_name="armik")
