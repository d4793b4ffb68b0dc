"""The arm: a DH chain, segment lengths and a range of motion."""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import JointType
from armik_sym.arm.names import check_identifier
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.errors import ArmModelError, UnitError, UnknownNameError

_LONGEST_SEGMENT = 5.0
_LARGEST_ANGLE = 4 * math.pi


@dataclass(frozen=True, eq=False)
class Arm:
    """A human arm or an exoskeleton: what moves, how far, and how long its segments are.

    T_base_hand(q) = base · Π T_i(q_i) · tool with lower ≤ q ≤ upper.

    Attributes:
        name: A plain identifier; it becomes part of the names in generated C.
        chain: The DH chain.
        rom: Range of motion of every joint, in [rad].
        lengths: Segment lengths by the names the chain uses, in [m].
        pointing_axis: Unit vector along the fingers in the hand frame, shape (3,).
        description: Where the numbers come from, in one sentence.
        up: Unit vector in the base frame that points up while the person sits or stands, shape (3,); None if
            that is not known.
        outward: Unit vector in the base frame that points sideways, from the body to the side of the arm,
            shape (3,); None if that is not known.

    Raises:
        ArmModelError: If the parts do not fit together.
        UnitError: If limits of a revolute joint look like degrees.

    Source:
        Nguyen 2021, §2 (what describes an arm).
    """

    name: str
    chain: DHChain
    rom: RangeOfMotion
    lengths: Mapping[str, float] = field(default_factory=dict)
    pointing_axis: NDArray[np.float64] = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    description: str = ""
    up: NDArray[np.float64] | None = None
    outward: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        check_identifier(self.name, "arm")
        if self.rom.dof != self.chain.dof:
            raise ArmModelError(
                f"arm {self.name!r}: the chain has {self.chain.dof} joints but the range of motion "
                f"{self.rom.dof}"
            )
        self._check_angles()
        self._check_lengths()
        self._set_unit_vector("pointing_axis")
        for key in ("up", "outward"):
            if getattr(self, key) is not None:
                self._set_unit_vector(key)

    def _set_unit_vector(self, key: str) -> None:
        """Replace a direction by a read-only copy, if it is a unit vector."""
        value = getattr(self, key)
        try:
            axis = np.array(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise ArmModelError(
                f"arm {self.name!r}: {key} is {value!r}, expected a unit vector (3,)"
            ) from None
        if axis.shape != (3,) or not math.isclose(float(np.linalg.norm(axis)), 1.0, abs_tol=1e-9):
            raise ArmModelError(f"arm {self.name!r}: {key} is {axis}, expected a unit vector (3,)")
        axis.flags.writeable = False
        object.__setattr__(self, key, axis)

    def _check_angles(self) -> None:
        for link, lower, upper in zip(self.chain.moving_links, self.rom.lower, self.rom.upper, strict=True):
            if link.joint is JointType.REVOLUTE and max(abs(lower), abs(upper)) > _LARGEST_ANGLE:
                raise UnitError(
                    f"arm {self.name!r}: range of motion of {link.name!r} is {lower:g} to {upper:g} rad, "
                    "more than two turns: if these are degrees, use RangeOfMotion.from_degrees or np.deg2rad"
                )

    def _check_lengths(self) -> None:
        needed = self.chain.length_names
        unknown = [name for name in self.lengths if name not in needed]
        if unknown:
            raise UnknownNameError(f"segment length of arm {self.name!r}", unknown[0], needed)
        for name in needed:
            value = self.lengths.get(name)
            if value is None:
                raise ArmModelError(f"arm {self.name!r}: segment length {name!r} is missing (in metres)")
            if isinstance(value, bool) or not isinstance(value, numbers.Real):
                raise ArmModelError(
                    f"arm {self.name!r}: segment length {name!r} is {value!r}, expected a number of metres"
                )
            if not 0.0 <= value <= _LONGEST_SEGMENT:
                too_long = _LONGEST_SEGMENT < value <= 1000 * _LONGEST_SEGMENT
                hint = f"; {value / 1000:g} m if this is in millimetres" if too_long else ""
                raise ArmModelError(
                    f"arm {self.name!r}: segment length {name!r} is {value:g}, expected 0 to "
                    f"{_LONGEST_SEGMENT:g} m{hint}"
                )
        ordered = {name: float(self.lengths[name]) for name in needed}
        object.__setattr__(self, "lengths", MappingProxyType(ordered))

    def __reduce__(self) -> tuple[type[Arm], tuple[object, ...]]:
        # The read-only view of the lengths cannot be pickled; workers and copies need the arm to be.
        lengths = dict(self.lengths)
        directions = (self.up, self.outward)
        rest = (lengths, self.pointing_axis, self.description, *directions)
        return Arm, (self.name, self.chain, self.rom, *rest)

    @property
    def dof(self) -> int:
        """Number of joints."""
        return self.chain.dof

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, from base to hand; each names the movement that increases its angle."""
        return self.chain.joint_names

    @property
    def rotates(self) -> NDArray[np.bool_]:
        """Which joints are revolute, the others being prismatic, shape (dof,)."""
        kinds = [link.joint for link in self.chain.moving_links]
        return np.array([kind is JointType.REVOLUTE for kind in kinds], dtype=np.bool_)

    @property
    def length_values(self) -> NDArray[np.float64]:
        """Segment lengths in the order of `chain.length_names`, shape (n_lengths,), in [m]."""
        return np.array(list(self.lengths.values()), dtype=np.float64)

    @property
    def reach(self) -> float:
        """Upper bound of the distance from base to hand: the sum of all shifts, in [m]."""
        total = float(np.linalg.norm(self.chain.base[:3, 3]) + np.linalg.norm(self.chain.tool[:3, 3]))
        for link in self.chain.links:
            for value in (link.d, link.a):
                total += self.lengths[value] if isinstance(value, str) else abs(value)
        farthest = np.maximum(np.abs(self.rom.lower), np.abs(self.rom.upper))
        return total + float(farthest[~self.rotates].sum())

    def joint_index(self, name: str) -> int:
        """Position of a joint in the posture vector.

        Args:
            name: Name of the joint.

        Returns:
            Its index, 0 for the joint next to the base.

        Raises:
            UnknownNameError: If the arm has no such joint.

        Source:
            None (bookkeeping).
        """
        if name not in self.joint_names:
            raise UnknownNameError(f"joint of arm {self.name!r}", name, self.joint_names)
        return self.joint_names.index(name)

    def with_rom(self, lower: ArrayLike, upper: ArrayLike) -> Arm:
        """The same arm with another range of motion: lower ≤ q ≤ upper.

        Args:
            lower: Lower limits, shape (dof,), in [rad].
            upper: Upper limits, shape (dof,), in [rad].

        Returns:
            A new arm.

        Raises:
            ArmModelError: If the limits do not fit the arm or contradict each other.

        Source:
            Nguyen 2021, Table 2.
        """
        return replace(self, rom=RangeOfMotion(np.asarray(lower), np.asarray(upper)))

    def with_lengths(self, **lengths: float) -> Arm:
        """The same arm with other segment lengths; those not named stay.

        Compiled kinematics take the lengths as arguments, so this never compiles anything.

        Args:
            **lengths: Segment lengths by name, in [m].

        Returns:
            A new arm.

        Raises:
            UnknownNameError: If the arm has no such segment length.
            ArmModelError: If a length is negative, not finite or above 5 m.

        Source:
            Nguyen 2021, Table 1.
        """
        return replace(self, lengths={**self.lengths, **lengths})
