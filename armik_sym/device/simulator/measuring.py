"""What the program of a simulated device measures: samples in blocks, from one power-up to the next."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from armik_sym.device.protocol.frames import Sample
from armik_sym.device.simulator.playback import Playback
from armik_sym.device.simulator.sensor import Reader
from armik_sym.device.simulator.sensor_faults import SensorFaults

if TYPE_CHECKING:
    from armik_sym.device.simulator.simulated_device import SimulatedDevice

_BLOCK = 250
_WRAP = 1 << 32
_MICROSECOND = 1_000_000


def power_ups(device: SimulatedDevice) -> list[int]:
    """Numbers of the samples at which a device is switched on: the first one, and after each restart.

    Args:
        device: The device.

    Returns:
        Numbers from 0, increasing.

    Source:
        None (this package).
    """
    return sorted({0, *(math.ceil(at * device.rate) for at in device.faults.restart_at)})


def switched_on(device: SimulatedDevice, power_up: int = 0) -> list[Reader]:
    """Switch all sensors of a device on, with the noise that belongs to its seed.

    Args:
        device: The device.
        power_up: How often it was switched on before.

    Returns:
        One reader per channel.

    Source:
        None (this package).
    """
    return [
        sensor.switched_on(np.random.SeedSequence([device.seed, channel, power_up]))
        for channel, sensor in enumerate(device.sensors)
    ]


def measured_blocks(device: SimulatedDevice) -> Iterator[list[Sample]]:
    """Everything a device measures, without end.

    Args:
        device: The device.

    Yields:
        Samples in blocks; a block ends where the device is switched off.

    Source:
        None (this package).
    """
    playback = Playback(device.motion, device.at_end)
    faults = SensorFaults(device.faults, device.info.channels)
    starts = power_ups(device)
    for power_up, start in enumerate(starts):
        readers = switched_on(device, power_up)
        stop = starts[power_up + 1] if power_up + 1 < len(starts) else None
        first_sequence, first_time_us = (0, 0) if power_up else (device.first_sequence, device.first_time_us)
        for first, end in _blocks(start, stop):
            numbers = np.arange(first, end)
            clock = np.rint((numbers - start) * (_MICROSECOND / device.rate)).astype(np.int64)
            time = numbers / device.rate
            angles = playback.angles(time)
            readings = [reader.read(angles[:, k]) for k, reader in enumerate(readers)]
            counts = np.column_stack([reading.counts for reading in readings])
            faults.apply(time, counts)
            passed = np.column_stack([reading.index for reading in readings])
            latched = np.column_stack([reading.index_counts for reading in readings])
            flags = passed @ (1 << np.arange(len(readers)))
            columns = zip(
                (numbers - start + first_sequence).tolist(),
                (clock + first_time_us).tolist(),
                counts.tolist(),
                flags.tolist(),
                latched,
                passed,
                strict=True,
            )
            yield [
                Sample(
                    sequence % _WRAP,
                    time_us % _WRAP,
                    tuple(row),
                    flag,
                    tuple(pulses[came].tolist()) if flag else (),
                )
                for sequence, time_us, row, flag, pulses, came in columns
            ]


def _blocks(start: int, stop: int | None) -> Iterator[tuple[int, int]]:
    """Blocks of samples between two numbers, or without end."""
    if stop is not None:
        yield from pairwise([*range(start, stop, _BLOCK), stop])
        return
    while True:
        yield start, start + _BLOCK
        start += _BLOCK
