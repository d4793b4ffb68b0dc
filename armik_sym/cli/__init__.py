"""The command `armik`. Heavy imports happen inside the commands, so that `--help` answers at once."""

from armik_sym.cli.app import app, main

__all__ = ["app", "main"]
