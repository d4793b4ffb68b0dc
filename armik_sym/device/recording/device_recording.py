"""A recording of a device: samples as they were sent, and what is known about them."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.recording.gap import Gap
from armik_sym.device.recording.run_angles import angles_of_runs
from armik_sym.device.recording.sensor_warning import SensorWarning
from armik_sym.errors import CalibrationError, CalibrationWarning, RecordingError
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.read_motion import write_motion

if TYPE_CHECKING:
    from armik_sym.device.calibration import Calibration, EncoderZero

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

NO_INDEX = -1
"""Where no index pulse came."""


@dataclass(frozen=True, eq=False, repr=False)
class DeviceRecording:
    """What a device sent, every sample that came through whole, in the order it came.

    Attributes:
        path: The file.
        infos: What the device said about itself; more than one if it changed, or another one answered.
        sequence: Number of each sample from 0, without wraps; steps of more than one are losses, shape (n,).
        time: When each was measured, from the first one on, by the device's clock; after a restart of the
            device placed by the host's, shape (n,), in [s].
        counts: Raw counts, shape (n, channels), in [count].
        at_index: Registers at the index pulse, -1 where none came, shape (n, channels), in [count].
        gaps: Times in which nothing came.
        restarts: Rows of the first sample after each restart of the device.
        lost: Samples missing by their numbers.
        damaged: Pieces of the file that are no frame, or contradict themselves.
        strange: Samples left out because they have another number of channels than the first.
        unknown_version: Frames of other versions of the protocol.
        warnings: What the recorder found odd about sensors.
        port: Where the device was.
        start: When the first sample was measured, by the host's calendar, UTC.
        calibration_text: The calibration given to the recorder, TOML.
        complete: Whether the recorder ended it; False after kill -9, a power cut or a full disk.
        torn: Whether it ends within a frame.
    """

    path: Path
    infos: tuple[DeviceInfo, ...]
    sequence: Counts
    time: Array
    counts: Counts
    at_index: Counts
    gaps: tuple[Gap, ...]
    restarts: tuple[int, ...]
    lost: int
    damaged: int
    strange: int
    unknown_version: int
    warnings: tuple[SensorWarning, ...]
    port: str | None
    start: datetime | None
    calibration_text: str | None
    complete: bool
    torn: bool

    @property
    def info(self) -> DeviceInfo | None:
        """What the device said about itself first; None if no info frame came through."""
        return self.infos[0] if self.infos else None

    @property
    def n(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, in [s]."""
        return float(self.time[-1] - self.time[0]) if self.n else 0.0

    @property
    def calibration(self) -> Calibration | None:
        """The calibration given to the recorder; None if there was none, or it is damaged."""
        if self.calibration_text is None:
            return None
        from armik_sym.device.calibration import parse_calibration

        return parse_calibration(self.calibration_text, f"the calibration in {self.path}")

    def joint_angles(
        self, calibration: Calibration | None = None, *, zero: EncoderZero | None = None
    ) -> tuple[Array, tuple[str, ...]]:
        """Angles of all samples, those without an angle included.

        There is none in the dead zone of a potentiometer, and, from a restart of the device on, none of an
        encoder unless its zero comes from the index.

        Args:
            calibration: Calibration of this device; None: the one in the recording.
            zero: Where the zero of encoders comes from; None: from the calibration.

        Returns:
            Angles, shape (n, joints), in [rad], NaN where there is none, and the names of the joints.

        Raises:
            CalibrationError: If there is no calibration, or it belongs to another device.

        Source:
            None (this package).
        """
        chosen = calibration or self.calibration
        if chosen is None:
            raise CalibrationError(
                f"{self.path}: holds no calibration: give the one of this device (armik calibrate makes it)"
            )
        for info in self.infos:
            chosen.check_device(info)
        return angles_of_runs(self, chosen, zero), chosen.joint_names

    def angles(
        self, calibration: Calibration | None = None, *, zero: EncoderZero | None = None
    ) -> JointMotion:
        """Joint angles over time: samples that have an angle for every joint.

        Args:
            calibration: Calibration of this device; None: the one in the recording.
            zero: Where the zero of encoders comes from; None: from the calibration.

        Returns:
            Motion of the device's joints. Samples without one of the angles are left out, with a warning.

        Raises:
            CalibrationError: If there is no calibration, or it belongs to another device.
            RecordingError: If no sample is left.

        Source:
            None (this package).
        """
        q, names = self.joint_angles(calibration, zero=zero)
        good = np.isfinite(q).all(axis=1)
        if not good.any():
            raise RecordingError(
                f"{self.path}: none of its {self.n} samples has an angle for every joint: is it empty, or a "
                "joint in its dead zone all the time?"
            )
        if not good.all():
            worst = int(np.isnan(q).sum(axis=0).argmax())
            warnings.warn(
                f"{self.path}: {int((~good).sum())} of {self.n} samples left out, most of them because "
                f"{names[worst]} has no angle there",
                CalibrationWarning,
                stacklevel=2,
            )
        return JointMotion(self.time[good], q[good], names)

    def save(self, path: str | os.PathLike[str], calibration: Calibration | None = None) -> Path:
        """Write joint angles as `.csv`, `.mot` or `.sto`.

        Args:
            path: The file.
            calibration: Calibration of this device; None: the one in the recording.

        Returns:
            The file.

        Raises:
            CalibrationError: If there is no calibration, or it belongs to another device.
            RecordingError: If no sample has an angle for every joint.
            MotionFileError: If the file cannot be written.

        Source:
            None (this package).
        """
        write_motion(path, self.angles(calibration))
        return Path(path)

    def __repr__(self) -> str:
        device = "unknown device" if self.info is None else f"device {self.info.device_id}"
        parts = [f"{self.n} samples", f"{self.duration:g} s", device]
        parts += [f"{value} {name}" for name, value in self._troubles().items() if value]
        return f"DeviceRecording({', '.join(parts)})"

    def _troubles(self) -> dict[str, int]:
        return {
            "lost": self.lost,
            "damaged": self.damaged,
            "gaps": len(self.gaps),
            "restarts": len(self.restarts),
            "of another protocol version": self.unknown_version,
        }
