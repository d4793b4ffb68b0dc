"""kill -9 of a recorder at random moments: the file opens, and at most the last frame is missing."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from device_recorder_child import record_and_tell
from device_recorders import simulated

from armik_sym.device.recording import read_recording
from armik_sym.device.simulator import serve_pty

KILLS = 20
AT_A_TIME = 4

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has neither kill -9 nor terminals")


def killed(folder: Path, number: int, after: float) -> tuple[int, int]:
    """Record, kill, read: samples in the file, and samples the recorder had received."""
    context: Any = multiprocessing.get_context("forkserver")
    received: Synchronized[int] = context.Value("q", 0)
    device, file = simulated(seed=number), folder / f"{number}.armikrec"
    with serve_pty(device) as served:
        process = context.Process(target=record_and_tell, args=(served.port, str(file), received))
        process.start()
        give_up = time.monotonic() + 30.0
        while not received.value and time.monotonic() < give_up:
            time.sleep(0.01)
        time.sleep(after)
        os.kill(process.pid, signal.SIGKILL)
        process.join(10.0)
    assert process.exitcode == -signal.SIGKILL
    ends = itertools.accumulate(device.frames(), lambda sum_, frame: sum_ + len(frame.data), initial=0)
    whole = sum(1 for _ in itertools.takewhile(lambda end: end <= received.value, ends)) - 1
    samples = sum(frame.number is not None for frame in itertools.islice(device.frames(), whole))
    recording = read_recording(file)
    assert recording.sequence.tolist() == list(range(recording.n))
    assert recording.lost == recording.damaged == 0
    assert not recording.complete
    return recording.n, samples


def test_at_most_the_last_frame_is_lost(tmp_path: Path) -> None:
    context: Any = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["armik_sym.device.recording"])
    waits = np.random.default_rng(7).uniform(0.0, 0.8, KILLS).tolist()
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        found = list(pool.map(lambda each: killed(tmp_path, *each), enumerate(waits)))
    assert all(received - 1 <= kept <= received for kept, received in found), found
    assert sum(kept for kept, _ in found) > 500
