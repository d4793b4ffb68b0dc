"""Registers of an incremental encoder as angles: overflow, zero, index pulse, lost counts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.joint import REGISTER, JointCalibration, steps_between

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

NO_INDEX = -1
"""In place of a register at the index where no index pulse came."""

INDEX_TOLERANCE = 4
"""Counts by which registers at the index may differ: the pulse is one period of the signals wide."""

HALF = REGISTER // 2


class EncoderZero(Enum):
    """Where the zero of an encoder comes from; a counter forgets it when the power goes.

    STORED: from the calibration; right if the device was not switched off since, or its zero was taken
    again. INDEX: from the index pulse; there are no angles before the first pulse, and absolute ones after.
    """

    STORED = "stored"
    INDEX = "index"


def signed_step(difference: Counts | int) -> Counts:
    """Steps of a 16-bit register, overflow in either direction undone: ((d + 2^15) mod 2^16) - 2^15.

    Right for steps below half the register: with 4,000 counts per turn below 8.19 turns from one sample to
    the next, so 4,096 turns per second at 500 samples per second.

    Args:
        difference: Register minus the register before, any shape, in [count].

    Returns:
        Steps from -32768 to 32767, in [count].

    Source:
        None (modular arithmetic).
    """
    return np.asarray((np.asarray(difference) + HALF) % REGISTER - HALF, dtype=np.int64)


@dataclass(slots=True)
class EncoderState:
    """What has to be remembered of one encoder from sample to sample.

    Attributes:
        register: Latest register, None before the first sample, in [count].
        position: The same with overflows counted, in [count].
        zero: Position at angle 0, NaN as long as it is not known, in [count].
        index: Position at an index pulse, NaN if none is known, in [count].
        off: Largest deviation of an index pulse from whole turns, with its sign, in [count].
    """

    register: int | None = None
    position: int = 0
    zero: float = math.nan
    index: float = math.nan
    off: int = 0


def encoder_angles(
    joint: JointCalibration, registers: Counts, at_index: Counts, state: EncoderState, zero: EncoderZero
) -> Array:
    """Angles of one encoder: direction · scale · (position - zero).

    Args:
        joint: The joint.
        registers: Registers, shape (n,), in [count].
        at_index: Registers at the index pulse, `NO_INDEX` where none came, shape (n,), in [count].
        state: What is remembered; changed.
        zero: Where the zero comes from.

    Returns:
        Angles, shape (n,), NaN as long as the zero is not known, in [rad].

    Source:
        None (this package).
    """
    if not registers.size:
        return np.empty(0)
    if state.register is None:
        _begin(joint, int(registers[0]), state, zero)
    steps = signed_step(steps_between(registers, state.register or 0))
    position = state.position + np.cumsum(steps)
    first_known = 0 if not math.isnan(state.zero) else len(registers)
    for k in np.flatnonzero(at_index != NO_INDEX):
        pulse = int(position[k] + signed_step(int(at_index[k] - registers[k])))
        if math.isnan(state.zero):
            state.zero, first_known = _zero_from_index(joint, pulse), int(k)
        _check_index(joint, pulse, state)
    state.register, state.position = int(registers[-1]), int(position[-1])
    angles = np.asarray((joint.direction * joint.scale) * (position - state.zero))
    angles[:first_known] = np.nan
    return angles


def _begin(joint: JointCalibration, register: int, state: EncoderState, zero: EncoderZero) -> None:
    """Start counting, with as many overflows as bring the first angle nearest the middle."""
    state.register = state.position = register
    if zero is EncoderZero.STORED:
        middle = float(joint.position(joint.middle))
        state.position += REGISTER * round((middle - register) / REGISTER)
        state.zero = joint.zero
        state.index = math.nan if joint.index is None else joint.index


def _zero_from_index(joint: JointCalibration, pulse: int) -> float:
    """Position at angle 0 after an index pulse; of all turns the pulse nearest the middle is meant."""
    if joint.index is None:
        return math.nan
    zero = pulse + joint.zero - joint.index
    middle = zero + joint.direction * joint.middle / joint.scale
    return zero + joint.span * round((pulse - middle) / joint.span)


def _check_index(joint: JointCalibration, pulse: int, state: EncoderState) -> None:
    """Index pulses come whole turns apart, or counts were lost."""
    if math.isnan(state.index):
        state.index = pulse
        return
    off = round((pulse - state.index + joint.span / 2) % joint.span - joint.span / 2)
    if abs(off) > max(abs(state.off), INDEX_TOLERANCE):
        state.off = off
