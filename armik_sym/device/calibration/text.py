"""A calibration in words, for people."""

from __future__ import annotations

import math

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.joint import JointCalibration, ScaleSource

COLUMNS = (
    "joint",
    "channel",
    "sensor",
    "scale [deg/count]",
    "direction",
    "zero [count]",
    "postures",
    "residual rms [deg]",
    "largest [deg]",
    "index [count]",
)
"""Headings of `rows`."""


def rows(calibration: Calibration) -> list[tuple[str, ...]]:
    """One row of text for each joint, standard errors behind ±.

    Args:
        calibration: The calibration.

    Returns:
        Rows with the columns of `COLUMNS`.

    Source:
        None (reporting).
    """
    return [_row(joint) for joint in calibration.joints]


def _row(joint: JointCalibration) -> tuple[str, ...]:
    quality = joint.quality
    fitted = joint.scale_source is ScaleSource.FITTED
    scale = f"{math.degrees(joint.scale):.6f}"
    error = f" ± {math.degrees(quality.scale_error):.6f}" if fitted else " (given)"
    return (
        joint.joint,
        str(joint.channel),
        joint.kind.name.lower(),
        scale + error,
        f"{joint.direction:+d}",
        f"{joint.zero:.2f} ± {quality.zero_error:.2f}",
        str(quality.postures),
        f"{math.degrees(quality.residual_rms):.2f}",
        f"{math.degrees(quality.residual_max):.2f}",
        "-" if joint.index is None else f"{joint.index:.0f}",
    )
