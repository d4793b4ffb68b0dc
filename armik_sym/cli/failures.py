"""What goes wrong, told in one paragraph on stderr."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

import typer
from typer.core import TyperGroup

from armik_sym.errors import ArmikError, ArmikWarning

NOT_OK = 1
FAILED = 2
STOPPED = 130


class FailingGroup(TyperGroup):
    """Commands whose errors end in one paragraph and an exit code, and whose warnings take one line.

    `ARMIK_DEBUG=1` lets errors through, with their traceback.
    """

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command.

        Args:
            ctx: The context of the command line.

        Returns:
            What the command returns.

        Raises:
            typer.Exit: With code 2 after an error, 130 after Ctrl-C.

        Source:
            None (command line).
        """
        with tidy_warnings():
            try:
                return super().invoke(ctx)
            except KeyboardInterrupt:
                typer.echo("stopped", err=True)
                raise typer.Exit(STOPPED) from None
            except BrokenPipeError:
                raise
            except (ArmikError, OSError) as error:
                if os.environ.get("ARMIK_DEBUG", "") not in ("", "0"):
                    raise
                typer.echo(f"error: {paragraph(error)}", err=True)
                raise typer.Exit(FAILED) from None


def paragraph(error: BaseException) -> str:
    """The message of an error without blank lines; of the system's errors the file and the reason.

    Args:
        error: The error.

    Returns:
        One paragraph.

    Source:
        None (command line).
    """
    if isinstance(error, OSError) and error.strerror and not isinstance(error, ArmikError):
        where = f"{error.filename}: " if error.filename is not None else ""
        return f"{where}{error.strerror}"
    lines = [line.rstrip() for line in str(error).splitlines() if line.strip()]
    return as_typed("\n".join(lines)) or type(error).__name__


def as_typed(text: str) -> str:
    """A message of the library with its Python arguments spelled as options of the command line.

    Args:
        text: The message, for example with 'tracking="soft"'.

    Returns:
        The message, with '--tracking soft'.

    Source:
        None (command line).
    """
    text = re.sub(r"""\b(tracking|orientation|search)=["']([\w-]+)["']""", r"--\1 \2", text)
    text = re.sub(r"\bn_best=(\d+)", r"--n-best \1", text)
    text = re.sub(r"read_markers\(path, unit='(\w+)'\)", r"--unit \1", text)
    text = re.sub(r",? or hand_rotation=", "", text)
    text = re.sub(r"\bfill_gaps=", "--fill", text)
    text = re.sub(r"\b(side|frame)=,", r"--\1", text)
    text = re.sub(r"\bn_best\b", "--n-best", text)
    return re.sub(r"\b(max)_(speed|acceleration)\b", r"--\1-\2", text)


@contextmanager
def tidy_warnings() -> Iterator[None]:
    """Show warnings of this package as one line each; leave all others as they are.

    Yields:
        Nothing.

    Source:
        None (command line).
    """
    with warnings.catch_warnings():
        warnings.simplefilter("always", ArmikWarning)
        others = warnings.showwarning

        def show(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if issubclass(category, ArmikWarning):
                typer.echo(f"warning: {' '.join(str(message).split())}", err=True)
            else:
                others(message, category, filename, lineno, file, line)

        warnings.showwarning = show
        yield
