"""kill -9 of a recorder at random moments: the file opens, and at most the last frame is missing."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from device_recorder_child import record_and_tell
from device_recorders import simulated

from armik_sym.device.recording import read_recording
from armik_sym.device.simulator import SimulatedDevice, serve_pty

KILLS = 20
AT_A_TIME = 4

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has neither kill -9 nor terminals")


def killed(folder: Path, number: int, after: float) -> tuple[int, int, int]:
    """Record, kill, read: samples the recorder had before its last read, those in the file, and with it."""
    context: Any = multiprocessing.get_context("forkserver")
    received = context.RawArray("q", 2)
    device, file = simulated(seed=number), folder / f"{number}.armikrec"
    with serve_pty(device) as served:
        process = context.Process(target=record_and_tell, args=(served.port, str(file), received))
        process.start()
        give_up = time.monotonic() + 30.0
        while not received[1] and time.monotonic() < give_up:
            time.sleep(0.01)
        time.sleep(after)
        os.kill(process.pid, signal.SIGKILL)
        process.join(10.0)
    assert process.exitcode == -signal.SIGKILL
    recording = read_recording(file)
    assert recording.sequence.tolist() == list(range(recording.n))
    assert recording.lost == recording.damaged == 0
    assert not recording.complete
    return whole_samples(device, received[0]), recording.n, whole_samples(device, received[1])


def whole_samples(device: SimulatedDevice, n_bytes: int) -> int:
    """Samples that are whole in the first bytes of a device."""
    ends = itertools.accumulate(device.frames(), lambda sum_, frame: sum_ + len(frame.data), initial=0)
    whole = sum(1 for _ in itertools.takewhile(lambda end: end <= n_bytes, ends)) - 1
    return sum(frame.number is not None for frame in itertools.islice(device.frames(), whole))


def test_at_most_the_last_frame_is_lost(tmp_path: Path) -> None:
    context: Any = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["armik_sym.device.recording"])
    waits = np.random.default_rng(7).uniform(0.0, 0.8, KILLS).tolist()
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        found = list(pool.map(lambda each: killed(tmp_path, *each), enumerate(waits)))
    # A read mostly brings one frame, more only if the computer is busy. What came before it is in the file.
    assert all(before <= kept <= received for before, kept, received in found), found
    assert sum(kept for _, kept, _ in found) > 500
