"""A device on a socket whose joints are where a test puts them, and answers that move them when typed."""

from __future__ import annotations

import math
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import Sample, encode_info, encode_sample
from armik_sym.device.simulator import Encoder, Potentiometer

RATE = 200.0
PROMPTS = (b"]: ", b"held still: ")


class HeldDevice:
    """Sends frames of simulated sensors at the angles held at the moment.

    Attributes:
        angles_deg: Where the joints are, in [deg]; a joint moves there at 600 degrees per second.
        shaking_deg: Standard deviation of a tremor of all joints, in [deg].
    """

    def __init__(self, sensors: Sequence[Potentiometer | Encoder], device_id: int = 7) -> None:
        self.angles_deg = [0.0] * len(sensors)
        self.shaking_deg = 0.0
        self.info = DeviceInfo(device_id, RATE, tuple(sensor.channel for sensor in sensors), "held")
        self._readers = [s.switched_on(np.random.SeedSequence([3, k])) for k, s in enumerate(sensors)]
        self._at = np.zeros(len(sensors))
        self._sequence = 0
        self._random = np.random.default_rng(0)
        self._server = socket.create_server(("127.0.0.1", 0))
        self._server.settimeout(0.1)
        self.url = f"socket://127.0.0.1:{self._server.getsockname()[1]}"
        self.closing = False

    def run(self) -> None:
        """Serve one client after another until closing."""
        while not self.closing:
            try:
                client, _ = self._server.accept()
            except TimeoutError:
                continue
            with client:
                try:
                    while not self.closing:
                        client.sendall(self._frames())
                        time.sleep(1 / RATE)
                except OSError:
                    continue
        self._server.close()

    def _frames(self) -> bytes:
        goal = np.array(self.angles_deg)
        self._at += np.clip(goal - self._at, -600 / RATE, 600 / RATE)
        angles = self._at + self.shaking_deg * self._random.standard_normal(len(goal))
        readings = [r.read(np.array([math.radians(a)])) for r, a in zip(self._readers, angles, strict=True)]
        flags = sum(bool(reading.index[0]) << k for k, reading in enumerate(readings))
        latched = tuple(int(reading.index_counts[0]) for reading in readings if reading.index[0])
        counts = tuple(int(reading.counts[0]) for reading in readings)
        data = encode_sample(Sample(self._sequence, self._sequence * 5000, counts, flags, latched))
        self._sequence += 1
        return (encode_info(self.info) if self._sequence % 50 == 1 else b"") + data


@contextmanager
def serving(device: HeldDevice) -> Iterator[HeldDevice]:
    """Run a device beside a test."""
    thread = threading.Thread(target=device.run, daemon=True)
    thread.start()
    try:
        yield device
    finally:
        device.closing = True
        thread.join(5)


class Done(NamedTuple):
    """How a dialogue ended."""

    exit_code: int
    output: str


def converse(
    device: HeldDevice, arguments: Sequence[str], typed: Sequence[tuple[str, Sequence[float]]]
) -> Done:
    """Run the command `armik` as a process of its own; at each prompt move the joints, then type."""
    process = subprocess.Popen(
        [sys.executable, "-m", "armik_sym", *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        bufsize=0,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
    )
    guard = threading.Timer(120.0, process.kill)
    guard.start()
    output, answers = b"", list(typed)
    try:
        with process:
            if process.stdin is None or process.stdout is None:
                raise RuntimeError("no pipes")
            while piece := process.stdout.read(4096):
                output += piece
                if output.endswith(PROMPTS) and answers:
                    text, angles = answers.pop(0)
                    device.angles_deg = list(angles)
                    time.sleep(0.3)  # the time it takes to get there, before the key is pressed
                    process.stdin.write(f"{text}\n".encode())
                elif output.endswith(PROMPTS):
                    process.stdin.close()
    finally:
        guard.cancel()
    return Done(process.returncode, output.decode("utf-8"))
