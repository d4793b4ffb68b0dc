"""The calibration of a device: all its joints, and whose and from when it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym._version import __version__
from armik_sym.device.calibration.encoder import EncoderZero, signed_step
from armik_sym.device.calibration.joint import REGISTER, JointCalibration
from armik_sym.device.channels import DeviceInfo, SensorKind
from armik_sym.errors import CalibrationError, UnknownNameError

if TYPE_CHECKING:
    from armik_sym.device.calibration.converter import AngleConverter

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Calibration:
    """From the raw counts of one device to its joint angles.

    Attributes:
        device_id: Number of the device it belongs to.
        date: When it was made, ISO 8601.
        joints: The joints, in the order of the angles.
        version: Version of this package that made it.
        notes: What the fit found worth knowing, one sentence each.

    Raises:
        CalibrationError: If there is no joint, or a joint or a channel occurs twice.
    """

    device_id: int
    date: str
    joints: tuple[JointCalibration, ...]
    version: str = __version__
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not self.joints:
            raise CalibrationError("a calibration needs at least one joint")
        for what, values in (
            ("joint", [joint.joint for joint in self.joints]),
            ("channel", [joint.channel for joint in self.joints]),
        ):
            twice = [value for i, value in enumerate(values) if value in values[:i]]
            if twice:
                raise CalibrationError(f"{what} {twice[0]!r} is calibrated twice: every joint has its own")

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, in the order of the angles."""
        return tuple(joint.joint for joint in self.joints)

    def joint(self, name: str) -> JointCalibration:
        """One joint by name.

        Args:
            name: Its name.

        Returns:
            The joint.

        Raises:
            UnknownNameError: If there is none of that name.

        Source:
            None (bookkeeping).
        """
        for joint in self.joints:
            if joint.joint == name:
                return joint
        raise UnknownNameError("calibrated joint", name, self.joint_names)

    def check_device(self, info: DeviceInfo) -> None:
        """Refuse another device, or the same with other sensors.

        Args:
            info: What the device says about itself.

        Raises:
            CalibrationError: If this calibration does not belong to it.

        Source:
            None (bookkeeping).
        """
        if info.device_id != self.device_id:
            raise CalibrationError(
                f"this calibration belongs to device {self.device_id}, made on {self.date}, but the data "
                f"come from device {info.device_id}: calibrate it (armik calibrate), or give its own "
                "calibration"
            )
        for joint in self.joints:
            if joint.channel >= len(info.channels):
                raise CalibrationError(
                    f"joint {joint.joint!r} is on channel {joint.channel}, but device {info.device_id} has "
                    f"channels 0 to {len(info.channels) - 1}: calibrate it again"
                )
            channel = info.channels[joint.channel]
            if (channel.kind, channel.span) != (joint.kind, joint.span):
                raise CalibrationError(
                    f"joint {joint.joint!r}: channel {joint.channel} of device {info.device_id} is now "
                    f"{_sensor(channel.kind, channel.span)}, but was {_sensor(joint.kind, joint.span)} when "
                    "it was calibrated: calibrate it again"
                )

    def converter(self, zero: EncoderZero = EncoderZero.STORED) -> AngleConverter:
        """A converter for samples as they come; it remembers overflows and turns.

        Args:
            zero: Where the zero of encoders comes from.

        Returns:
            The converter, at its beginning.

        Raises:
            CalibrationError: With `EncoderZero.INDEX`, if an encoder's index is not known.

        Source:
            None (this package).
        """
        from armik_sym.device.calibration.converter import AngleConverter

        return AngleConverter(self, zero)

    def angles(
        self, counts: ArrayLike, at_index: ArrayLike | None = None, *, zero: EncoderZero = EncoderZero.STORED
    ) -> Array:
        """Joint angles of a whole recording: angle = direction · scale · (counts - zero).

        The same as `converter(zero)` gives sample by sample. Warns where the index pulses of an encoder do
        not come whole turns apart.

        Args:
            counts: Raw counts of all channels, shape (n, channels), in [count].
            at_index: Registers at the index pulse, -1 where none came; same shape, in [count].
            zero: Where the zero of encoders comes from.

        Returns:
            Shape (n, joints), in [rad]; NaN in the dead zone of a potentiometer and, with
            `EncoderZero.INDEX`, in front of the first index pulse of an encoder.

        Raises:
            ShapeError: If shapes do not fit.
            CalibrationError: With `EncoderZero.INDEX`, if an encoder's index is not known.

        Source:
            None (this package).
        """
        converter = self.converter(zero)
        angles = converter.convert(counts, at_index)
        converter.warn_of_lost_counts()
        return angles

    def rezeroed(self, counts: ArrayLike, joints: Iterable[str] | None = None) -> Calibration:
        """The same calibration with the zeros of a new power-up, taken in the zero pose.

        Args:
            counts: Raw counts of all channels while every joint was held at 0, shape (n, channels), in
                [count].
            joints: Joints whose zero is taken; None: all measured by encoders, whose counters start anew.

        Returns:
            The calibration; an index known from an earlier power-up moves along.

        Raises:
            ShapeError: If the shape does not fit.
            UnknownNameError: If there is no joint of a name given.

        Source:
            None (this package).
        """
        from armik_sym.device.calibration.converter import checked_counts

        raw = checked_counts(counts, self, "counts in the zero pose")
        encoders = [each.joint for each in self.joints if each.kind is SensorKind.ENCODER]
        wanted = {self.joint(name).joint for name in (encoders if joints is None else joints)}
        return replace(
            self,
            joints=tuple(
                _with_zero(joint, raw[:, joint.channel]) if joint.joint in wanted else joint
                for joint in self.joints
            ),
        )


def _with_zero(joint: JointCalibration, counts: NDArray[np.int64]) -> JointCalibration:
    """A joint whose zero is the mean of the counts; an encoder's may lie across its overflow."""
    if joint.kind is SensorKind.POTENTIOMETER:
        return replace(joint, zero=float(counts.mean()))
    zero = float((counts[0] + signed_step(counts - counts[0]).mean()) % REGISTER)
    # Known modulo one turn is all an index says, so a zero taken in the pose moves it by the difference.
    index = None if joint.index is None else joint.index + zero - joint.zero
    return replace(joint, zero=zero, index=index)


def _sensor(kind: SensorKind, span: int) -> str:
    unit = "counts full scale" if kind is SensorKind.POTENTIOMETER else "counts per turn"
    return f"a {kind.name.lower()} of {span} {unit}"
