"""The calibration of a device from postures whose angles are known."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.candidates import choose_line
from armik_sym.device.calibration.data import JointData, joint_data
from armik_sym.device.calibration.diagnosis import notes_on, refuse_large_residuals
from armik_sym.device.calibration.joint import (
    FULL_TURN,
    JointCalibration,
    JointQuality,
    ScaleSource,
    usual_track,
)
from armik_sym.device.calibration.line import Line, fit_zero
from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.setup import SMALLEST_MOVE, JointSetup, datasheet_scale
from armik_sym.device.channels import DeviceInfo, SensorKind
from armik_sym.errors import CalibrationError, OptionError

Array = NDArray[np.float64]

LARGEST_RESIDUAL = math.radians(5.0)
"""How far a posture may be from the line of its joint, in [rad]."""

LARGEST_SCALE_ERROR = 0.05
"""Standard error of a scale relative to it, at most."""

HIGHEST_SPEED = 30.0
"""Speed of a joint that a potentiometer is believed, in [rad/s]."""

_NOISE = math.radians(0.5)
_FEWEST_COUNTS = 8
_MUCH_ABOVE_NOISE = 10


def fit_calibration(
    info: DeviceInfo,
    postures: Sequence[Posture],
    joints: Sequence[JointSetup],
    *,
    angle_error: float = 0.0,
    smallest_move: float = SMALLEST_MOVE,
    largest_residual: float = LARGEST_RESIDUAL,
    date: str | None = None,
) -> Calibration:
    """Scale, direction and zero of every joint, by least squares over all postures in which it is known.

    angle = direction · scale · (counts - zero). Two postures determine a joint; more show how good it is. A
    joint whose setup gives scale and direction needs the zero pose only.

    Args:
        info: The device.
        postures: The postures, in the order in which they were taken.
        joints: The joints, base to hand.
        angle_error: Standard error with which the angles of postures are known, in [rad].
        smallest_move: How far apart two postures of a joint have to be, in [rad].
        largest_residual: How far a posture may be from the line of its joint, besides a count, in [rad].
        date: When the postures were taken, ISO 8601; None: now.

    Returns:
        The calibration, with residuals, standard errors and notes.

    Raises:
        CalibrationError: If the postures leave something open: the message names the joint, how far it was
            moved and how far it has to be; or if they contradict each other.
        OptionError: If an option cannot be.

    Source:
        None (this package); Nguyen 2021, Table 3 (sensors).
    """
    if not (math.isfinite(angle_error) and angle_error >= 0 and smallest_move > 0 and largest_residual > 0):
        raise OptionError(
            f"angle_error={angle_error!r}, smallest_move={smallest_move!r}, "
            f"largest_residual={largest_residual!r}: expected an error of 0 or more, and positive angles, in "
            "[rad]"
        )
    _check_names(info, postures, joints)
    fitted, notes = [], []
    for setup in joints:
        data = joint_data(setup, info.channels[setup.channel], postures)
        # A coarse sensor rounds: half a count in either posture is no contradiction.
        allowed = largest_residual + datasheet_scale(data.channel)
        joint, said = _fit_joint(data, info.rate, angle_error, smallest_move, allowed)
        fitted.append(joint)
        notes += said
    if date is None:
        date = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
    return Calibration(info.device_id, date, tuple(fitted), notes=tuple(notes))


def _check_names(info: DeviceInfo, postures: Sequence[Posture], joints: Sequence[JointSetup]) -> None:
    names = [setup.joint for setup in joints]
    for setup in joints:
        if not 0 <= setup.channel < len(info.channels):
            raise CalibrationError(
                f"joint {setup.joint!r} is said to be on channel {setup.channel}, but device "
                f"{info.device_id} has channels 0 to {len(info.channels) - 1}"
            )
    for posture in postures:
        unknown = [joint for joint in posture.angles if joint not in names]
        if unknown:
            raise CalibrationError(
                f"posture {posture.name!r} gives the angle of {unknown[0]!r}, which is no joint to "
                f"calibrate: these are {', '.join(names)}"
            )


def _fit_joint(
    data: JointData, rate: float, angle_error: float, smallest_move: float, largest_residual: float
) -> tuple[JointCalibration, list[str]]:
    setup = data.setup
    turned, notes = data.angles, []
    if setup.scale is not None and setup.direction is not None:
        # Full turns apart are the same to a potentiometer: the angles of the given scale nearest those known.
        slope = setup.direction * setup.scale
        turned = _turned_to_given(data, slope)
        line = fit_zero(data.counts, turned, data.errors, angle_error, slope)
        notes.append(f"{setup.joint}: scale and direction as given, not measured.")
    else:
        _refuse_small_move(data, smallest_move)
        line, turns = choose_line(data, angle_error, largest_residual)
        turned = data.angles + FULL_TURN * turns
        if setup.scale is not None:
            slope = math.copysign(setup.scale, line.slope)
            turned = _turned_to_given(data, slope)
            line = fit_zero(data.counts, turned, data.errors, angle_error, slope)
            notes.append(f"{setup.joint}: scale as given, not measured.")
        elif len(data.angles) == 2:
            notes.append(f"{setup.joint}: two postures only, nothing checks their angles.")
    refuse_large_residuals(data, line, turned, largest_residual)
    if setup.scale is None:
        _refuse_uncertain_scale(data, line)
    return _calibrated(data, line, rate), notes + notes_on(data, line, turned)


def _turned_to_given(data: JointData, slope: float) -> Array:
    """Known angles, a potentiometer's turned by full turns so that they fit the slope given."""
    if data.channel.kind is SensorKind.ENCODER:
        return data.angles
    offset = data.angles - slope * data.counts
    return np.asarray(data.angles - FULL_TURN * np.rint((offset - offset[0]) / FULL_TURN))


def _refuse_small_move(data: JointData, smallest_move: float) -> None:
    joint, moved, needed = data.setup.joint, math.degrees(data.moved), math.degrees(smallest_move)
    # Angles typed in degrees must not miss the limit by rounding.
    if data.moved < smallest_move * (1 - 1e-9):
        open_ = "direction" if data.setup.scale is not None else "scale and direction"
        raise CalibrationError(
            f"joint {joint!r} has to be moved: its known angles are {moved:.1f}° apart, at least "
            f"{needed:.1f}° are needed to determine its {open_}: add a posture with it held at another angle "
            "(or give its scale and direction)"
        )
    counts = float(np.ptp(data.counts))
    if counts < max(_FEWEST_COUNTS, _MUCH_ABOVE_NOISE * float(data.errors.max())):
        raise CalibrationError(
            f"joint {joint!r} has to be moved: it is said to have moved by {moved:.1f}°, but channel "
            f"{data.setup.channel} moved by {counts:.1f} counts only: another joint moved, the channel is "
            "another joint's, or its cable is broken"
        )


def _refuse_uncertain_scale(data: JointData, line: Line) -> None:
    uncertain = line.slope_error / abs(line.slope)
    if uncertain > LARGEST_SCALE_ERROR:
        needed = math.degrees(data.moved) * uncertain / LARGEST_SCALE_ERROR
        raise CalibrationError(
            f"joint {data.setup.joint!r} has to be moved further: its known angles are "
            f"{math.degrees(data.moved):.1f}° apart, which leaves its scale uncertain by "
            f"{100 * uncertain:.0f} % (allowed: {100 * LARGEST_SCALE_ERROR:.0f} %): move it by about "
            f"{needed:.0f}°, or hold more postures"
        )


def _calibrated(data: JointData, line: Line, rate: float) -> JointCalibration:
    setup, channel = data.setup, data.channel
    potentiometer = channel.kind is SensorKind.POTENTIOMETER
    residuals = line.residuals
    quality = JointQuality(
        len(data.angles),
        data.samples,
        float(np.sqrt(np.mean(residuals**2))),
        float(np.abs(residuals).max()),
        line.slope_error,
        line.zero_error,
    )
    return JointCalibration(
        setup.joint,
        setup.channel,
        channel.kind,
        channel.span,
        abs(line.slope),
        1 if line.slope > 0 else -1,
        line.zero,
        setup.middle,
        usual_track(channel.span) if potentiometer else None,
        HIGHEST_SPEED / rate + _NOISE if potentiometer else math.inf,
        data.index,
        ScaleSource.FITTED if setup.scale is None else ScaleSource.GIVEN,
        quality,
    )
