"""Postures are written down as they are taken, so that whatever ends a calibration costs none of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.posture_file import FORMAT, load_postures
from armik_sym.device.calibration.setup import JointSetup
from armik_sym.device.calibration.write import quoted, replace_text
from armik_sym.device.channels import DeviceInfo
from armik_sym.errors import CalibrationError

ENDING = ".postures.toml"
"""Behind the name of the calibration."""


class PostureLog:
    """A file of postures, written anew with each one; `load_postures` and `armik calibrate --from` read it.

    Attributes:
        path: The file.
        postures: The postures in it, by name.

    Source:
        None (file format of this package); docs/device.md.
    """

    def __init__(self, path: Path, info: DeviceInfo, setups: Sequence[JointSetup]) -> None:
        """Prepare a log; the file is made with the first posture.

        Args:
            path: The file.
            info: The device.
            setups: The joints.
        """
        self.path = path
        self.postures: dict[str, Posture] = {}
        self._info, self._setups = info, tuple(setups)

    def read(self) -> None:
        """Take over the postures of the file.

        Raises:
            CalibrationError: If it cannot be read, or is of another device or of other joints.

        Source:
            None (file format of this package).
        """
        found = load_postures(self.path)
        if (found.info.device_id, found.info.channels) != (self._info.device_id, self._info.channels):
            raise CalibrationError(
                f"{self.path}: its postures are of device {found.info.device_id}, or of other sensors, this "
                f"is device {self._info.device_id}: give another --out, or delete the file"
            )
        if found.setups != self._setups:
            raise CalibrationError(
                f"{self.path}: its joints are on other channels, or of another arm: give the same --arm and "
                "--channels, or delete the file"
            )
        self.postures = {posture.name: posture for posture in found.postures}

    def add(self, posture: Posture) -> None:
        """Write down one more posture.

        Args:
            posture: The posture.

        Raises:
            CalibrationError: If the file cannot be written.

        Source:
            None (file format of this package).
        """
        self.postures[posture.name] = posture
        lines = self._head()
        for each in self.postures.values():
            lines += ["", *_posture(each)]
        replace_text(self.path, "\n".join(lines) + "\n")

    def _head(self) -> list[str]:
        lines = [
            "# postures taken by armik calibrate; armik calibrate --from fits them",
            f"format = {quoted(FORMAT)}",
            f"device_id = {self._info.device_id}",
            f"rate_hz = {self._info.rate:.0f}",
            'angle_unit = "deg"',
        ]
        for channel in self._info.channels:
            lines += ["", "[[channel]]", f"sensor = {quoted(channel.kind.name.lower())}"]
            lines.append(f"span_counts = {channel.span}")
        for setup in self._setups:
            lines += ["", "[[joint]]", f"name = {quoted(setup.joint)}", f"channel = {setup.channel}"]
            lines.append(f"middle_rad = {setup.middle!r}")
        return lines


def _posture(posture: Posture) -> list[str]:
    angles = ", ".join(f"{quoted(name)} = {math.degrees(q)!r}" for name, q in posture.angles.items())
    index = ", ".join(f"{channel} = {register}" for channel, register in (posture.index or {}).items())
    return [
        "[[posture]]",
        f"name = {quoted(posture.name)}",
        f"angles = {{ {angles} }}",
        f"index = {{ {index} }}",
        f"counts = {posture.table.tolist()}",
    ]
