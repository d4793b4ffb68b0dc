"""A progress bar on stderr, only where somebody watches."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import TYPE_CHECKING

from armik_sym.progress import Progress

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID


class ProgressBar:
    """Shows stage, iteration and largest constraint violation of a running solve.

    A context manager; call it with `Progress` reports. Without a terminal it shows nothing, and when
    it ends it leaves nothing behind.

    Source:
        None (rich).
    """

    def __init__(self, title: str, steps: int | None = None) -> None:
        """Prepare a bar.

        Args:
            title: What is being solved.
            steps: How many solves there will be; None for one of unknown length.
        """
        self._title = title
        self._steps = steps
        self._bar: Bar | None = None
        self._task: TaskID | None = None

    def __enter__(self) -> ProgressBar:
        if sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
            from rich.progress import Progress as Bar

            self._bar = Bar(
                TextColumn("{task.description}", markup=False),
                BarColumn(bar_width=20),
                TimeElapsedColumn(),
                TextColumn("{task.fields[detail]}", markup=False),
                console=Console(file=sys.stderr),
                transient=True,
            )
            self._task = self._bar.add_task(self._title, total=self._steps, detail="preparing")
            self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, report: Progress) -> None:
        """Show a report of the solver."""
        self._update(detail=detail(report))

    def begin(self, title: str) -> None:
        """Say what is being solved now."""
        self._update(description=title, detail="preparing")

    def finish(self) -> None:
        """One more solve is done."""
        self._update(advance=1)

    def _update(self, **changes: object) -> None:
        if self._bar is not None and self._task is not None:
            self._bar.update(self._task, **changes)  # type: ignore[arg-type]


def detail(report: Progress) -> str:
    """A report in a few words.

    Args:
        report: The report.

    Returns:
        Text such as "exact tracking, iteration 7, violation 2e-05".

    Source:
        None (command line).
    """
    words = report.stage
    if report.iteration:
        words += f", iteration {report.iteration}"
    if report.violation:
        words += f", violation {report.violation:.0e}"
    return words
