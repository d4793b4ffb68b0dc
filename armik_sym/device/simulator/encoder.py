"""An incremental encoder on a 16-bit quadrature counter: overflow, index pulse, lost counts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.channels import Channel, SensorKind
from armik_sym.device.simulator.potentiometer import check_direction
from armik_sym.device.simulator.sensor import Array, Counts, Readings
from armik_sym.errors import OptionError

REGISTER = 0x10000
"""Counts after which the register begins again."""


@dataclass(frozen=True, slots=True)
class Encoder:
    """An incremental encoder: register = r_0 + N - N_0 - lost mod 2^16, N = floor(K (φ_0 + s q) / 2π).

    K is the number of counts per turn, N_0 the edge at which it was switched on. The index pulse comes where
    N passes a multiple of K; the register is latched there.

    Attributes:
        direction: s; 1 if counts rise with the joint angle, -1 if they fall.
        mounting: φ_0, angle of the shaft from the index at joint angle 0, in [rad].
        span: K, in [count].
        start: r_0, what the register holds when it is switched on; None: any, from the seed, in [count].
        lost: Share of the edges that the counter misses.

    Raises:
        OptionError: If a value is out of range.

    Source:
        Nguyen 2021, §2.1 (encoders E6B2-CWZ6C: two phases and an index); the model is this package's.
    """

    direction: int = 1
    mounting: float = 0.0
    span: int = 4000
    start: int | None = None
    lost: float = 0.0

    def __post_init__(self) -> None:
        check_direction(self.direction)
        if self.span < 4:
            raise OptionError(f"span is {self.span!r} counts per turn, expected 4 or more")
        if self.start is not None and not 0 <= self.start < REGISTER:
            raise OptionError(f"start is {self.start!r}, expected 0 to {REGISTER - 1}")
        if not 0 <= self.lost <= 1:
            raise OptionError(f"lost is {self.lost!r}, expected a share of the edges from 0 to 1")

    @property
    def channel(self) -> Channel:
        """What the device says about it."""
        return Channel(SensorKind.ENCODER, self.span)

    @property
    def scale(self) -> float:
        """Joint angle per count: 2π / K, in [rad]."""
        return 2 * math.pi / self.span

    @property
    def index_to_zero(self) -> float:
        """Counts from the index pulse to joint angle 0: K φ_0 / 2π - ½, in [count]."""
        return self.mounting / self.scale - 0.5

    def edges(self, angle: Array) -> Counts:
        """Edges passed since the index: N = floor(K (φ_0 + s q) / 2π).

        Args:
            angle: Joint angles, shape (n,), in [rad].

        Returns:
            Edges, shape (n,), in [count].

        Source:
            None (definition).
        """
        return np.floor((self.mounting + self.direction * angle) / self.scale).astype(np.int64)

    def switched_on(self, random: np.random.SeedSequence) -> EncoderReader:
        """Switch the sensor on.

        Args:
            random: Where the start of the register and the lost counts come from.

        Returns:
            Its reader.

        Source:
            None (this package).
        """
        return EncoderReader(self, random)


class EncoderReader:
    """An encoder that is switched on: it remembers where it is, not where it was at the index.

    Attributes:
        start: What the register held when it was switched on, in [count].
    """

    def __init__(self, sensor: Encoder, random: np.random.SeedSequence) -> None:
        self._sensor = sensor
        self._random = np.random.default_rng(random)
        drawn = int(self._random.integers(0, REGISTER))
        self.start = drawn if sensor.start is None else sensor.start
        self._register = self.start
        self._edge: int | None = None

    def read(self, angle: Array) -> Readings:
        """Read the register at the next samples.

        Args:
            angle: True joint angles, shape (n,), in [rad].

        Returns:
            Registers, and where an index pulse came its latched register.

        Source:
            None (this package).
        """
        sensor = self._sensor
        if not len(angle):
            none = np.zeros(0, dtype=np.int64)
            return Readings(none, none.astype(np.bool_), none)
        edges = sensor.edges(angle)
        first = int(edges[0]) if self._edge is None else self._edge
        before = np.concatenate(([first], edges[:-1]))
        steps = edges - before
        counted = steps - np.sign(steps) * self._random.binomial(np.abs(steps), sensor.lost)
        total = self._register + np.cumsum(counted, dtype=np.int64)
        self._register, self._edge = int(total[-1]) % REGISTER, int(edges[-1])
        index, back = _index_pulses(before, edges, sensor.span)
        at_index = np.where(index, (total + back) % REGISTER, 0).astype(np.int64)
        return Readings(total % REGISTER, index, at_index)


def _index_pulses(before: Counts, edges: Counts, span: int) -> tuple[NDArray[np.bool_], Counts]:
    """Whether a multiple of the span was passed, and the edges from the sample to the latest one."""
    turn, turn_before = edges // span, before // span
    latest = np.where(turn > turn_before, turn, turn + 1) * span
    return turn != turn_before, latest - edges
