"""What is seen while a device is recorded: counters, angles, swivel and endpoint."""

from __future__ import annotations

import queue
import sys
import threading
from types import TracebackType
from typing import TYPE_CHECKING

import typer

from armik_sym.cli.record_lines import pose_lines, status_line

if TYPE_CHECKING:
    from rich.live import Live

    from armik_sym.device.angles import LiveAngles
    from armik_sym.device.calibration import Calibration
    from armik_sym.device.recording import Recorder, RecorderStatus

_IN_TERMINAL = 0.1  # [s], ten pictures a second
_IN_PIPE = 1.0
_LET_OTHERS = 0.001  # [s]


class RecordView:
    """Shows a running recording, from a thread of its own: a slow terminal keeps nobody from reading.

    In a terminal a few lines change in place, ten times a second; elsewhere one line is written a second.
    All of it goes to stderr. A context manager.

    Source:
        None (rich).
    """

    def __init__(
        self, live: LiveAngles | None, calibration: Calibration | None, wanted: frozenset[str]
    ) -> None:
        """Prepare a view.

        Args:
            live: Turns samples into angles; None: only counters are shown.
            calibration: The calibration behind it.
            wanted: What is shown beside the angles: "swivel", "endpoint".
        """
        self.notices: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._angles = live
        self._calibration = calibration
        self._wanted = wanted
        self._recorder: Recorder | None = None
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._show, name="armik record view", daemon=True)
        self._switching = 0.0
        self._latest: list[str] = []

    def watch(self, recorder: Recorder) -> None:
        """Begin to show a recorder."""
        self._recorder = recorder
        self._thread.start()

    def __enter__(self) -> RecordView:
        # Reading must not wait for a picture: the other thread gives way after a millisecond.
        self._switching = sys.getswitchinterval()
        sys.setswitchinterval(_LET_OTHERS)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join()
        sys.setswitchinterval(self._switching)
        self._say_notices(None)

    def _show(self) -> None:
        if not sys.stderr.isatty():
            while not self._ending.wait(_IN_PIPE):
                self._say_notices(None)
                typer.echo("  ".join(self._lines()), err=True)
            return
        from rich.console import Console
        from rich.live import Live
        from rich.text import Text

        console = Console(file=sys.stderr, markup=False, highlight=False, emoji=False)
        with Live(console=console, transient=True, auto_refresh=False) as live:
            ended = False
            while not ended:
                ended = self._ending.wait(_IN_TERMINAL)
                self._say_notices(live)
                live.update(Text("\n".join(self._lines())), refresh=True)

    def _lines(self) -> list[str]:
        if self._recorder is None:
            return []
        status = self._recorder.status()
        lines = [status_line(status)]
        samples = self._recorder.take_recent()
        if self._angles is not None and self._calibration is not None and samples:
            names = self._calibration.joint_names
            self._latest = pose_lines(self._angles, names, samples, self._wanted)
        if not status.connected and not self._ending.is_set():
            self._latest = []  # a posture of some time ago is no live one
        elif self._zero_lost(status):
            self._latest = ["no angles: the device restarted, and its encoders lost their zero"]
        return lines + self._latest

    def _zero_lost(self, status: RecorderStatus) -> bool:
        return (
            status.restarts > 0
            and self._calibration is not None
            and any(joint.kind.name == "ENCODER" for joint in self._calibration.joints)
        )

    def _say_notices(self, live: Live | None) -> None:
        while not self.notices.empty():
            text = f"note: {self.notices.get()}"
            if live is not None:
                live.console.print(text, soft_wrap=True)
            else:
                typer.echo(text, err=True)
