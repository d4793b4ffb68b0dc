"""A skeleton and its motion, as `.bvh` files keep them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError, RecordingError, ShapeError, UnknownNameError
from armik_sym.motion.checks import check_finite, check_shape, float_copy
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.units import is_rate, length_unit

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")


@dataclass(frozen=True)
class BvhJoint:
    """One joint of a skeleton.

    Attributes:
        name: Its name; the end of a limb is called after its parent, "LeftHand_end".
        parent: Index of its parent, -1 for the root.
        offset: Shift from the parent, in the unit of the file.
        channels: Its channels, in the order of the file; none for the end of a limb.

    Source:
        Meredith & Maddock (2001), Motion capture file formats explained.
    """

    name: str
    parent: int
    offset: tuple[float, float, float]
    channels: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class BvhMotion:
    """Channels of the joints over time.

    Attributes:
        joints: The joints, parents before children; the first is the root.
        frame_time: Time from frame to frame, in [s].
        values: Channels in the order of the joints, shape (n, channels): lengths in the unit of the file,
            which it does not state, rotations in degrees; read-only.
        note: What was odd in the file, in words.
        source: Where the motion comes from, such as a file name.

    Raises:
        ShapeError: If shapes do not fit.
        RecordingError: If joints contradict each other, or a value is not finite.

    Source:
        Meredith & Maddock (2001), Motion capture file formats explained.
    """

    joints: tuple[BvhJoint, ...]
    frame_time: float
    values: Array
    note: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for i, joint in enumerate(self.joints):
            if (joint.parent < 0) != (i == 0) or joint.parent >= i:
                raise RecordingError(
                    f"joint {joint.name!r} has the parent {joint.parent}, expected one before it"
                )
            wrong = [channel for channel in joint.channels if channel not in CHANNELS]
            if wrong or len(set(joint.channels)) < len(joint.channels):
                raise RecordingError(
                    f"joint {joint.name!r} has the channels {', '.join(joint.channels)}, expected some of "
                    f"{', '.join(CHANNELS)}, each once"
                )
            if joint.name in seen:
                raise RecordingError(f"joint {joint.name!r} occurs twice: every joint needs its own name")
            seen.add(joint.name)
        if not is_rate(repr(float(self.frame_time))):
            raise RecordingError(f"frame_time is {self.frame_time!r} s, expected a positive number")
        values = float_copy(self.values, "values")
        check_shape(values, "values", (None, self.channel_count), f"(n, {self.channel_count})")
        if not len(values) or not values.size:
            raise ShapeError(f"values has shape {values.shape}, expected at least one frame and one channel")
        check_finite(values, "values")
        object.__setattr__(self, "values", values)

    @property
    def channel_count(self) -> int:
        """Number of channels of all joints."""
        return sum(len(joint.channels) for joint in self.joints)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the joints."""
        return tuple(joint.name for joint in self.joints)

    @property
    def rate(self) -> float:
        """Frames per second, in [Hz]."""
        return 1.0 / self.frame_time

    @property
    def time(self) -> Array:
        """Times, shape (n,), in [s], from 0."""
        return np.arange(len(self.values), dtype=np.float64) * self.frame_time

    def rotations(self, name: str) -> Array:
        """Rotation of a joint against the world: R = Π R_parent, each the product of its channels in order.

        Args:
            name: The joint.

        Returns:
            Rotation matrices, shape (n, 3, 3).

        Raises:
            UnknownNameError: If there is no such joint.

        Source:
            Meredith & Maddock (2001), Motion capture file formats explained.
        """
        if name not in self.names:
            raise UnknownNameError("joint", name, self.names)
        index, chain = self.names.index(name), []
        while index >= 0:
            chain.append(index)
            index = self.joints[index].parent
        from scipy.spatial.transform import Rotation  # slow to import, and few recordings are of this kind

        R = Rotation.identity(len(self.values))
        for index in reversed(chain):
            R = R * self._turn(index)
        return np.asarray(R.as_matrix(), dtype=np.float64)

    def positions(self, unit: str | float) -> MarkerRecording:
        """Where the joints are: p = p_parent + R_parent · (offset + position channels).

        Args:
            unit: Unit of the lengths, "m", "cm" or "mm", or metres per unit: the file does not say.

        Returns:
            A recording with one marker for every joint and end of a limb, in the axes of the file.

        Raises:
            UnknownNameError: If the unit is another word.
            OptionError: If the factor is not positive.

        Source:
            Meredith & Maddock (2001), Motion capture file formats explained.
        """
        metres = metres_of(unit)
        positions: list[Array] = []
        turns: list[Rotation] = []
        for index, joint in enumerate(self.joints):
            local = np.asarray(joint.offset) + self._shift(index)
            if joint.parent < 0:
                positions.append(local)
                turns.append(self._turn(index))
            else:
                parent = turns[joint.parent]
                positions.append(positions[joint.parent] + parent.apply(local))
                turns.append(parent * self._turn(index) if joint.channels else parent)
        said = f"lengths taken as {unit}" if isinstance(unit, str) else f"lengths taken as {metres:g} m"
        note = f"{self.note}; {said}" if self.note else said
        position = np.stack(positions, axis=1) * metres
        return MarkerRecording(self.time, self.names, position, note, self.source, self.rate)

    def _columns(self, index: int) -> dict[str, int]:
        first = sum(len(joint.channels) for joint in self.joints[:index])
        return {channel: first + i for i, channel in enumerate(self.joints[index].channels)}

    def _turn(self, index: int) -> Rotation:
        from scipy.spatial.transform import Rotation  # slow to import, and few recordings are of this kind

        R = Rotation.identity(len(self.values))
        for channel, column in self._columns(index).items():
            if channel.endswith("rotation"):
                R = R * Rotation.from_euler(channel[0], self.values[:, [column]], degrees=True)
        return R

    def _shift(self, index: int) -> Array:
        columns = self._columns(index)
        shift = np.zeros((len(self.values), 3))
        for axis, channel in enumerate(CHANNELS[:3]):
            if channel in columns:
                shift[:, axis] = self.values[:, columns[channel]]
        return shift

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        return (
            f"BvhMotion({len(self.joints)} joints, {len(self)} frames at {self.rate:.6g} Hz"
            f"{', ' + self.source if self.source else ''})"
        )


def metres_of(unit: str | float) -> float:
    """Metres of one unit of length.

    Args:
        unit: "m", "cm" or "mm", or the number of metres.

    Returns:
        The number of metres.

    Raises:
        UnknownNameError: If the unit is another word.
        OptionError: If the number is not positive.

    Source:
        SI.
    """
    if isinstance(unit, str):
        return float(f"1e{length_unit(unit).shift}")
    if not (math.isfinite(unit) and unit > 0):
        raise OptionError(f"unit is {unit!r} m, expected a positive number of metres")
    return float(unit)
