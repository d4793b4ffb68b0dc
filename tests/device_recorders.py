"""Simulated devices and recorders for tests of recordings."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import armik_sym as ak
from armik_sym.device.protocol import FrameParser, Sample
from armik_sym.device.recording import Recorder, RecordingSummary
from armik_sym.device.simulator import (
    Faults,
    ServedDevice,
    SimulatedDevice,
    sensors_of,
    serve_pty,
    serve_socket,
)

SERVERS = [
    pytest.param(serve_pty, id="pty", marks=pytest.mark.skipif("sys.platform == 'win32'")),
    pytest.param(serve_socket, id="socket"),
]


def simulated(faults: Faults | None = None, **options: Any) -> SimulatedDevice:
    """A device of seven channels that plays a bundled task."""
    motion = ak.load_task("drinking_lift").measured
    return SimulatedDevice(motion, sensors_of(ak.catalog.ehmcs()), faults=faults or Faults(), **options)


@contextmanager
def stopped_when_sent(recorder: Recorder, served: ServedDevice, seconds: float = 30.0) -> Iterator[None]:
    """Stop a recorder when the device has sent everything, or after some time."""

    def watch() -> None:
        served.wait(seconds)
        threading.Event().wait(0.3)
        recorder.stop()

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        recorder.stop()
        watcher.join()


def recorded(served: ServedDevice, file: Path, **options: Any) -> tuple[Recorder, RecordingSummary]:
    """Record a device until it has sent everything."""
    recorder = Recorder(served.port, file, **options)
    with stopped_when_sent(recorder, served):
        return recorder, recorder.run(seconds=40.0)


def sequences(file: Path) -> list[int]:
    """Sequence numbers of all samples in a recording, as the plain parser finds them."""
    return [each.sequence for each in FrameParser().feed(file.read_bytes()) if isinstance(each, Sample)]
