"""Simulated devices for tests, and readers that know nothing of the recorder."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import serial

import armik_sym as ak
from armik_sym.device.protocol import FrameParser, Sample
from armik_sym.device.simulator import ServedDevice, SimulatedDevice, sensors_of

SEVEN = sensors_of(ak.catalog.ehmcs())
BRUSHING = ak.load_task("brushing").measured


def device(**options: Any) -> SimulatedDevice:
    """The seven-joint device that brushes its teeth."""
    return SimulatedDevice(BRUSHING, options.pop("sensors", SEVEN), **options)


def first_samples(simulated: SimulatedDevice, n: int) -> list[Sample]:
    return list(itertools.islice(simulated.samples(), n))


def counts_of(samples: list[Sample]) -> np.ndarray:
    return np.array([sample.counts for sample in samples])


def index_counts_of(samples: list[Sample]) -> np.ndarray:
    """Register at the index pulse by sample and channel, -1 where none came."""
    latched = np.full((len(samples), len(samples[0].counts)), -1)
    for row, sample in zip(latched, samples, strict=True):
        row[[k for k in range(len(row)) if sample.index >> k & 1]] = sample.index_counts
    return latched


class PlainReader:
    """Opens a port with pyserial again and again, and parses what comes, until told to end."""

    def __init__(self) -> None:
        self.parser = FrameParser()
        self.samples: list[Sample] = []
        self.infos = 0
        self.openings = 0

    def read(self, served: ServedDevice, enough: Callable[[], bool], limit: float = 60.0) -> PlainReader:
        deadline = time.monotonic() + limit
        while not enough() and time.monotonic() < deadline:
            try:
                port = serial.serial_for_url(served.port, do_not_open=True, timeout=0.05)
                if served.port.startswith("socket://"):
                    # On a busy machine it could throw away what the device has sent since.
                    port.reset_input_buffer = lambda: None
                port.open()
            except serial.SerialException:
                time.sleep(0.01)
                continue
            self.openings += 1
            with port:
                self._read_open(port, enough, deadline)
        served.check()
        return self

    def _read_open(self, port: Any, enough: Callable[[], bool], deadline: float) -> None:
        try:
            while not enough() and time.monotonic() < deadline:
                self._take(port.read(max(1, port.in_waiting)))
        except serial.SerialException:
            self.parser.restart()

    def _take(self, data: bytes) -> None:
        for frame in self.parser.feed(data):
            if isinstance(frame, Sample):
                self.samples.append(frame)
            else:
                self.infos += 1

    @property
    def sequences(self) -> list[int]:
        return [sample.sequence for sample in self.samples]


def all_read(served: ServedDevice, reader: PlainReader) -> Callable[[], bool]:
    """Whether everything was sent and the reader has had time to parse what it had read."""
    seen: list[tuple[int, float]] = [(-1, 0.0)]

    def enough() -> bool:
        if not served.finished:
            return False
        now, so_far = time.monotonic(), reader.parser.counts.bytes_read
        if so_far != seen[0][0]:
            seen[0] = (so_far, now)
        return now - seen[0][1] > 0.3

    return enough


def open_descriptors() -> int:
    """Of this process; the look itself opens one more. 0 where the system does not say."""
    folder = Path("/proc/self/fd")
    return sum(1 for _ in folder.iterdir()) if folder.is_dir() else 0
