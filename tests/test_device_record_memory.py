"""The memory of a recorder does not grow with what it records."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

from device_recorders import simulated, stopped_when_sent

from armik_sym.device.recording import Recorder
from armik_sym.device.simulator import Faults, serve_socket

ALLOWED = 200_000  # [byte]; a list of the samples would take 600,000


def test_memory_stays_flat(tmp_path: Path) -> None:
    device = simulated(Faults(damaged_bytes=0.002), rate=1000.0)
    seen: list[tuple[int, int]] = []

    def look(recorder: Recorder) -> None:
        seen.append((recorder.status().samples, tracemalloc.get_traced_memory()[0]))

    with serve_socket(device, speed=None, seconds=5.0) as served:
        recorder = Recorder(served.port, tmp_path / "a.armikrec")
        keep = recorder._keep

        def counted(file, arrival) -> None:
            keep(file, arrival)
            samples = recorder.status().samples
            if samples >= 1000 * (len(seen) + 1):
                look(recorder)

        recorder._keep = counted
        with stopped_when_sent(recorder, served, 90.0):
            tracemalloc.start()
            try:
                recorder.run(90.0)
                look(recorder)
            finally:
                tracemalloc.stop()
    assert seen[-1][0] > 4_000
    # The simulator's account takes one byte a sample.
    growth = seen[-1][1] - seen[0][1] - (seen[-1][0] - seen[0][0])
    assert growth < ALLOWED, seen
