"""Where text and tables go: as wide as needed in a pipe, as wide as the window in a terminal."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_PIPE_WIDTH = 200


def output() -> Console:
    """The console for results, on stdout.

    Returns:
        A console that takes text literally; in a pipe 200 columns wide, without colours.

    Source:
        None (rich).
    """
    from rich.console import Console

    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Console(file=sys.stdout, width=width, markup=False, highlight=False, emoji=False)


def say(text: str) -> None:
    """Write text to stdout, lines as they are.

    Args:
        text: The text.

    Source:
        None (command line).
    """
    output().print(text, soft_wrap=True)


def plain_table(columns: list[tuple[str, bool]]) -> Table:
    """A table whose cells are never cut off.

    Args:
        columns: For every column its heading, and whether it holds numbers.

    Returns:
        An empty table.

    Source:
        None (rich).
    """
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for heading, number in columns:
        table.add_column(heading, justify="right" if number else "left", overflow="fold", no_wrap=False)
    return table
