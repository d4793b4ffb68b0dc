"""A device on a socket whose joints are where a test puts them, and answers that move them when typed."""

from __future__ import annotations

import io
import math
import socket
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from armik_sym.cli import app
from armik_sym.device.calibration import tap
from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import Sample, encode_info, encode_sample
from armik_sym.device.simulator import Encoder, Potentiometer

RATE = 200.0
SPEED = 3000.0  # [deg/s], of joints on their way
AT_REST = 10  # frames sent at the new angles before the key is pressed
CTRL_C = "^C"


class HeldDevice:
    """Sends frames of simulated sensors at the angles held at the moment.

    Attributes:
        angles_deg: Where the joints go, in [deg].
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
        self._client = False
        self._at_rest = 0

    def move(self, angles_deg: Sequence[float]) -> None:
        """Move the joints; returns when whoever listens has been sent frames from there."""
        self.angles_deg, self._at_rest = list(angles_deg), 0
        until = time.monotonic() + 30.0
        while self._client and self._at_rest < AT_REST and time.monotonic() < until:
            time.sleep(0.5 / RATE)

    def run(self) -> None:
        """Serve one client after another until closing."""
        while not self.closing:
            try:
                client, _ = self._server.accept()
            except TimeoutError:
                continue
            with client:
                self._client = True
                try:
                    while not self.closing:
                        client.sendall(self._frames())
                        time.sleep(1 / RATE)
                except OSError:
                    self._client = False
                    continue
        self._server.close()

    def _frames(self) -> bytes:
        goal = np.array(self.angles_deg)
        self._at += np.clip(goal - self._at, -SPEED / RATE, SPEED / RATE)
        self._at_rest = self._at_rest + 1 if np.array_equal(self._at, goal) else 0
        angles = self._at + self.shaking_deg * self._random.standard_normal(len(goal))
        readings = [r.read(np.array([math.radians(a)])) for r, a in zip(self._readers, angles, strict=True)]
        flags = sum(bool(reading.index[0]) << k for k, reading in enumerate(readings))
        latched = tuple(int(reading.index_counts[0]) for reading in readings if reading.index[0])
        counts = tuple(int(reading.counts[0]) for reading in readings)
        data = encode_sample(Sample(self._sequence, self._sequence * 5000, counts, flags, latched))
        self._sequence += 1
        return (encode_info(self.info) if self._sequence % 10 == 1 else b"") + data


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


class Answers(io.TextIOBase):
    """What is typed: before each answer the joints move; where there is none left, the input ends."""

    def __init__(self, device: HeldDevice, typed: Sequence[tuple[str, Sequence[float]]]) -> None:
        self._device, self._left = device, list(typed)

    def readline(self, size: int = -1) -> str:  # type: ignore[override]
        if not self._left:
            return ""
        text, angles = self._left.pop(0)
        if text == CTRL_C:
            raise KeyboardInterrupt
        self._device.move(angles)
        return f"{text}\n"


class Done(NamedTuple):
    """How a dialogue ended."""

    exit_code: int
    output: str


def converse(
    device: HeldDevice, arguments: Sequence[str], typed: Sequence[tuple[str, Sequence[float]]]
) -> Done:
    """Run the command `armik`; at each prompt move the joints, then type. Hands here come to rest at once."""
    output = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(output), redirect_stderr(output):
        patch.setattr(tap, "SETTLE", 0.05)
        patch.setattr(sys, "stdin", Answers(device, typed))
        with pytest.raises(SystemExit) as end:
            app(list(arguments))
    return Done(int(end.value.code or 0), output.getvalue())


def calibrate(
    device: HeldDevice, out: Path, typed: Sequence[tuple[str, Sequence[float]]], *more: str
) -> Done:
    """Run `armik calibrate` on a device, a tenth of a second per posture."""
    arguments = ["calibrate", "--port", device.url, "--out", str(out), "--seconds", "0.1", *more]
    return converse(device, arguments, typed)
