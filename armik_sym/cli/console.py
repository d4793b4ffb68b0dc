"""Where text and tables go: tables are never cut, text is wrapped in a terminal only."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_PIPE_WIDTH = 200
_TABLE_WIDTH = 160


def output() -> Console:
    """The console for results, on stdout.

    Returns:
        A console that takes text literally; in a pipe without colours.

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
    console = output()
    console.print(text, soft_wrap=not console.is_terminal)


def show(table: Table) -> None:
    """Write a table to stdout, whole even where the window is too narrow for it.

    Args:
        table: The table.

    Source:
        None (command line).
    """
    console = output()
    console.width = max(console.width, _TABLE_WIDTH)
    console.print(table)


def plain_table(columns: list[tuple[str, bool]]) -> Table:
    """A table whose cells are never cut off.

    Args:
        columns: For every column its heading, of one or more lines, and whether it holds numbers.

    Returns:
        An empty table.

    Source:
        None (rich).
    """
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=(0, 1, 0, 0))
    for heading, number in columns:
        table.add_column(heading, justify="right" if number else "left", no_wrap=True)
    return table
