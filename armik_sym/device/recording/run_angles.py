"""Angles over the restarts of a device: encoders begin anew, potentiometers do not care."""

from __future__ import annotations

import itertools
import warnings
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.channels import SensorKind
from armik_sym.errors import CalibrationWarning

if TYPE_CHECKING:
    from armik_sym.device.calibration import Calibration, EncoderZero


class Counts(Protocol):
    """What is needed of a recording."""

    @property
    def path(self) -> object:
        """Where it is from."""

    @property
    def counts(self) -> NDArray[np.int64]:
        """Raw counts, shape (n, channels), in [count]."""

    @property
    def at_index(self) -> NDArray[np.int64]:
        """Registers at the index pulse, shape (n, channels), in [count]."""

    @property
    def restarts(self) -> tuple[int, ...]:
        """Rows of the first sample after each restart."""


def angles_of_runs(
    recording: Counts, calibration: Calibration, zero: EncoderZero | None
) -> NDArray[np.float64]:
    """Angles of every run of a device by itself, as its registers begin anew with each.

    Args:
        recording: The counts.
        calibration: Calibration of the device.
        zero: Where the zero of encoders comes from; None: the calibration, whose zero holds for the first
            run.

    Returns:
        Shape (n, joints), in [rad]; NaN where there is no angle.

    Raises:
        ShapeError: If counts have fewer channels than the calibration needs.

    Source:
        None (this package).
    """
    from armik_sym.device.calibration import EncoderZero

    chosen = zero or EncoderZero.STORED
    encoders = [joint.kind is SensorKind.ENCODER for joint in calibration.joints]
    q = np.empty((len(recording.counts), len(encoders)))
    edges = [0, *recording.restarts, len(q)]
    for number, (begin, end) in enumerate(itertools.pairwise(edges)):
        converter = calibration.converter(chosen)
        q[begin:end] = converter.convert(recording.counts[begin:end], recording.at_index[begin:end])
        if number and chosen is EncoderZero.STORED:
            q[begin:end, encoders] = np.nan
        else:
            converter.warn_of_lost_counts()
    if recording.restarts and any(encoders) and chosen is EncoderZero.STORED:
        warnings.warn(
            f"{recording.path}: the device restarted at sample {recording.restarts[0]}: its encoders lost "
            "their zero, so their joints have no angles from there on (an index pulse can give it back: "
            "zero=EncoderZero.INDEX)",
            CalibrationWarning,
            stacklevel=3,
        )
    return q
