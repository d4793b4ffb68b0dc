"""Counts as angles, block by block or sample by sample, with what has to be remembered in between."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.encoder import NO_INDEX, EncoderState, EncoderZero, encoder_angles
from armik_sym.device.calibration.potentiometer import WiperState, potentiometer_angles
from armik_sym.device.channels import SensorKind
from armik_sym.device.protocol.frames import Sample
from armik_sym.errors import CalibrationError, CalibrationWarning, ShapeError

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


class AngleConverter:
    """Joint angles of samples as they come, in memory that does not grow.

    However a recording is cut into blocks, the angles are the same to the last bit; blocks cost less than
    single samples. A pause, such as a cable that was pulled, needs nothing: registers are followed over it as
    long as the device kept its power.

    Attributes:
        calibration: The calibration used.
        zero: Where the zero of encoders comes from.
    """

    def __init__(self, calibration: Calibration, zero: EncoderZero = EncoderZero.STORED) -> None:
        """Start in front of the first sample; see `Calibration.converter`."""
        if zero is EncoderZero.INDEX:
            for joint in calibration.joints:
                if joint.kind is SensorKind.ENCODER and joint.index is None:
                    raise CalibrationError(
                        f"joint {joint.joint!r}: its index pulse was not passed during the calibration, so "
                        "it cannot give the zero: take the zero pose after each power-up, or calibrate again "
                        "and move this joint past its index"
                    )
        self.calibration = calibration
        self.zero = zero
        self._wipers = [WiperState() for _ in calibration.joints]
        self._encoders = [EncoderState() for _ in calibration.joints]

    @property
    def lost_counts(self) -> dict[str, int]:
        """Joints whose index pulses do not come whole turns apart, and by how many counts they are off."""
        pairs = zip(self.calibration.joints, self._encoders, strict=True)
        return {joint.joint: state.off for joint, state in pairs if state.off}

    def convert(self, counts: ArrayLike, at_index: ArrayLike | None = None) -> Array:
        """Angles of the next samples.

        Args:
            counts: Raw counts of all channels, shape (n, channels) or (channels,), in [count].
            at_index: Registers at the index pulse, -1 where none came; same shape, in [count].

        Returns:
            Shape (n, joints) or (joints,), in [rad]; NaN where there is no angle.

        Raises:
            ShapeError: If shapes do not fit.

        Source:
            None (this package).
        """
        raw = checked_counts(counts, self.calibration, "counts")
        pulses = np.full_like(raw, NO_INDEX)
        if at_index is not None:
            pulses = checked_counts(at_index, self.calibration, "at_index", lowest=NO_INDEX)
            if pulses.shape != raw.shape:
                raise ShapeError(f"at_index has shape {pulses.shape}, expected {raw.shape} as counts have")
        angles = np.empty((len(raw), len(self.calibration.joints)))
        for k, joint in enumerate(self.calibration.joints):
            column = raw[:, joint.channel]
            if joint.kind is SensorKind.POTENTIOMETER:
                angles[:, k] = potentiometer_angles(joint, column, self._wipers[k])
            else:
                pulse = pulses[:, joint.channel]
                angles[:, k] = encoder_angles(joint, column, pulse, self._encoders[k], self.zero)
        return angles if np.ndim(counts) == 2 else angles[0]

    def samples(self, samples: Sequence[Sample]) -> Array:
        """Angles of the next samples, as the parser hands them out.

        Args:
            samples: The samples.

        Returns:
            Shape (n, joints), in [rad]; NaN where there is no angle.

        Raises:
            ShapeError: If a sample has too few channels.

        Source:
            None (this package).
        """
        if not samples:
            return np.empty((0, len(self.calibration.joints)))
        return self.convert(*sample_arrays(samples))

    def warn_of_lost_counts(self) -> None:
        """Warn of every joint in `lost_counts`.

        Source:
            None (bookkeeping).
        """
        for joint, off in self.lost_counts.items():
            why = (
                "the device was switched off since the calibration, or counts were lost: take the zero again "
                "(armik calibrate --zero), or use the zero of the index"
                if self.zero is EncoderZero.STORED
                else "counts were lost: check the cable and the speed of the encoder"
            )
            degrees = math.degrees(off * self.calibration.joint(joint).scale)
            warnings.warn(
                f"joint {joint!r}: the register at the index pulse is {off} counts ({degrees:.1f}°) off "
                f"whole turns: {why}",
                CalibrationWarning,
                stacklevel=3,
            )


def sample_arrays(samples: Sequence[Sample]) -> tuple[Counts, Counts]:
    """Samples as arrays.

    Args:
        samples: At least one sample, all with the same number of channels.

    Returns:
        Counts, and registers at the index pulse with -1 where none came; both shape (n, channels), in
        [count].

    Raises:
        ShapeError: If numbers of channels differ.

    Source:
        None (bookkeeping).
    """
    channels = len(samples[0].counts)
    for sample in samples:
        if len(sample.counts) != channels:
            raise ShapeError(
                f"sample {sample.sequence} has {len(sample.counts)} channels, expected {channels} as before"
            )
    counts = np.array([sample.counts for sample in samples], dtype=np.int64)
    at_index = np.full_like(counts, NO_INDEX)
    for k, sample in enumerate(samples):
        if sample.index:
            flagged = [c for c in range(channels) if sample.index >> c & 1]
            at_index[k, flagged] = sample.index_counts
    return counts, at_index


def checked_counts(values: ArrayLike, calibration: Calibration, what: str, lowest: int = 0) -> Counts:
    """Raw counts as an array with one row per sample.

    Args:
        values: Whole numbers, shape (n, channels) or (channels,), in [count].
        calibration: Says which channels are needed.
        what: What they are, beginning a message.
        lowest: The lowest value allowed.

    Returns:
        Shape (n, channels), in [count].

    Raises:
        ShapeError: If they are no whole numbers from `lowest` to 65535, or a channel is missing.

    Source:
        None (input check).
    """
    array = np.asarray(values)
    if array.dtype.kind not in "iu" or array.ndim not in (1, 2):
        raise ShapeError(
            f"{what}: {array.dtype} of shape {array.shape}, expected whole numbers (n, channels) or "
            "(channels,)"
        )
    table = array.astype(np.int64).reshape(-1, array.shape[-1])
    needed = 1 + max(joint.channel for joint in calibration.joints)
    if table.shape[1] < needed:
        raise ShapeError(f"{what}: {table.shape[1]} channels, but the calibration needs {needed}")
    bad = (table < lowest) | (table > 0xFFFF)
    if bad.any():
        row, column = np.argwhere(bad)[0]
        raise ShapeError(
            f"{what}: sample {row}, channel {column} is {table[row, column]}, expected {lowest} to 65535"
        )
    return table
