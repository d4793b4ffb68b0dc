"""A table of numbers over time, as OpenSim keeps coordinates, forces and moments."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import (
    HandPathError,
    MotionFileWarning,
    RecordingError,
    ShapeError,
    UnitError,
    UnknownNameError,
)
from armik_sym.motion.checks import check_finite, check_increasing, check_shape, float_copy
from armik_sym.motion.joint_motion import JointMotion

Array = NDArray[np.float64]

# OpenSim names the translations of a joint so, by its own convention and in models around.
_TRANSLATION = re.compile(r"(_t|trans)_?[xyz]\Z", re.IGNORECASE)
_LOAD = re.compile(r"_(moment|force|torque|power)\Z", re.IGNORECASE)


@dataclass(frozen=True, eq=False, repr=False)
class StorageTable:
    """Columns of numbers over time, in the units of the file.

    Attributes:
        time: Strictly increasing times, shape (n,) with n ≥ 1, in [s]; read-only.
        names: Names of the k columns, each once.
        values: The numbers as the file has them, shape (n, k); NaN for a gap; read-only.
        in_degrees: Whether rotations are in degrees (True) or radians (False); None if the file does not
            say. Lengths are in [m], forces in [N] either way.
        title: What the table is called, such as "Coordinates".
        note: What was odd in the file, in words.
        source: Where the table comes from, such as a file name.

    Raises:
        ShapeError: If shapes or the number of names do not fit.
        RecordingError: If time does not increase, a value is infinite, or a name is blank or occurs twice.

    Source:
        OpenSim documentation, "Storage (.sto) files".
    """

    time: Array
    names: tuple[str, ...]
    values: Array
    in_degrees: bool | None = None
    title: str = ""
    note: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        names = tuple(self.names)
        if any(not isinstance(name, str) or not name.strip() for name in names) or len(set(names)) < len(
            names
        ):
            raise RecordingError(f"names are {names}, expected texts that are not blank, none twice")
        try:
            time, values = float_copy(self.time, "time"), float_copy(self.values, "values")
            check_shape(time, "time", (None,), "(n,)")
            if not len(time) or not names:
                raise ShapeError(
                    f"a table has {len(time)} samples and {len(names)} columns, needed is 1 each"
                )
            check_shape(values, "values", (len(time), len(names)), f"({len(time)}, {len(names)})")
            check_finite(time, "time")
            check_increasing(time)
        except HandPathError as error:
            raise RecordingError(str(error)) from None
        if np.isinf(values).any():
            i, j = np.argwhere(np.isinf(values))[0]
            raise RecordingError(f"column {names[j]!r} of sample {i} is infinite: a gap is NaN")
        for key, value in (("time", time), ("names", names), ("values", values)):
            object.__setattr__(self, key, value)

    def of(self, name: str) -> Array:
        """One column.

        Args:
            name: Its name.

        Returns:
            The numbers as the file has them, shape (n,).

        Raises:
            UnknownNameError: If there is no such column.

        Source:
            None (bookkeeping).
        """
        if name not in self.names:
            raise UnknownNameError("column", name, self.names)
        return self.values[:, self.names.index(name)]

    def joint_motion(self, joints: Sequence[str] | Mapping[str, str] | None = None) -> JointMotion:
        """Columns as joint angles: q = value · π/180 if the file says degrees.

        Args:
            joints: The columns that are joint angles, in order; or column by name of the joint, to rename
                them; None for all whose names are not those of translations ("…_tx", "…_transX").

        Returns:
            The motion, in [rad].

        Raises:
            UnitError: If the file does not say whether rotations are in degrees, or a column is a force.
            UnknownNameError: If there is no such column.
            HandPathError: If a column has gaps, or its name is no plain identifier.

        Source:
            OpenSim documentation, "Storage (.sto) files" (inDegrees).
        """
        if joints is None:
            joints = [name for name in self.names if not _TRANSLATION.search(name)]
            left_out = [name for name in self.names if name not in joints]
            if left_out:
                said = f"{self._where}columns left out, by their names translations: {', '.join(left_out)}"
                warnings.warn(f"{said}; choose columns with joints=…", MotionFileWarning, stacklevel=2)
        columns = column_of_joint(joints)
        loads = [name for name in columns.values() if _LOAD.search(name)]
        if loads:
            raise UnitError(f"{self._where}column {loads[0]!r} is a load, expected joint angles")
        if self.in_degrees is None:
            raise UnitError(
                f"{self._where}does not say whether angles are in degrees: write 'inDegrees=yes' or "
                "'inDegrees=no' into its header"
            )
        if not columns:
            raise UnitError(f"{self._where}has no column of joint angles, only {', '.join(self.names)}")
        factor = math.pi / 180.0 if self.in_degrees else 1.0
        q = np.column_stack([self.of(column) for column in columns.values()]) * factor
        try:
            return JointMotion(self.time, q, tuple(columns))
        except HandPathError as error:
            raise HandPathError(f"{self._where}{error}") from None

    @property
    def _where(self) -> str:
        return f"{self.source}: " if self.source else ""

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        angles = {True: "degrees", False: "radians", None: "an unknown unit"}[self.in_degrees]
        return (
            f"StorageTable({self.title!r}, {len(self)} samples, {len(self.names)} columns, rotations in "
            f"{angles}{', ' + self.source if self.source else ''})"
        )


def column_of_joint(joints: Sequence[str] | Mapping[str, str]) -> dict[str, str]:
    """Column by name of the joint, from any way to choose columns.

    Args:
        joints: Names, or column by name of the joint.

    Returns:
        Column by name of the joint.

    Source:
        None (bookkeeping).
    """
    return dict(joints) if isinstance(joints, Mapping) else {name: name for name in joints}


def angle_table(
    time: Array,
    q: Array,
    names: Sequence[str],
    rotates: Sequence[bool] | None = None,
    in_degrees: bool = True,
) -> StorageTable:
    """Joint angles as OpenSim keeps them: value = q · 180/π if in degrees; translations stay in metres.

    Args:
        time: Times, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad] (prismatic: [m]).
        names: Names of the joints.
        rotates: For each joint whether it is a rotation; None if all are.
        in_degrees: Whether the table is to be in degrees.

    Returns:
        The table, called "Coordinates".

    Source:
        OpenSim documentation, "Storage (.sto) files".
    """
    factor = 180.0 / math.pi if in_degrees else 1.0
    factors = [factor if rotation else 1.0 for rotation in (rotates or [True] * len(names))]
    return StorageTable(time, tuple(names), np.asarray(q) * factors, in_degrees, title="Coordinates")
