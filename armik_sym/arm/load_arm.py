"""Loading arms and patients by path or by name."""

from __future__ import annotations

import os
from pathlib import Path

from armik_sym.arm.arm_file import arm_from_table
from armik_sym.arm.catalog import lookup
from armik_sym.arm.model import Arm
from armik_sym.arm.patient_file import patient_from_table
from armik_sym.arm.toml_reader import load_toml
from armik_sym.errors import ArmFileError, UnknownNameError


def load_arm(path: str | os.PathLike[str]) -> Arm:
    """Load an arm or a patient from a TOML file, or an arm of the catalogue by its name.

    A file with `[[joint]]` rows describes an arm. A file with `arm = "ehmcs"` (or the path of an arm
    file, relative to it) describes a patient: that arm with a narrower range of motion,
    lower_arm ≤ lower_patient ≤ q ≤ upper_patient ≤ upper_arm.

    Args:
        path: Path of a `.toml` file, or a name of the catalogue ("ehmcs", "human", "alfaiz").

    Returns:
        The arm, in SI units.

    Raises:
        ArmFileError: If the file is missing, unreadable, incomplete or contradicts itself.
        UnitError: If a unit is not declared or contradicted by the values.
        UnknownNameError: If a name is not in the catalogue.

    Source:
        None (file format of this package, see `docs/files.md`).
    """
    target = Path(path)
    # A folder "ehmcs" in the working directory (say, of generated C) must not hide the arm of that name.
    named = os.fspath(path) in lookup.names()
    if named or (target.suffix.lower() != ".toml" and not target.exists()):
        return lookup.by_name(str(path))
    return _load(target, seen=())


def _load(path: Path, seen: tuple[Path, ...]) -> Arm:
    if path.resolve() in seen:
        raise ArmFileError(f"{path}: refers to itself through its 'arm' key")
    table = load_toml(path)
    if "joint" in table:
        return arm_from_table(path, table)
    parent = table.get("arm")
    if not isinstance(parent, str):
        raise ArmFileError(
            f'{path}: neither an arm ([[joint]] rows) nor a patient (arm = "NAME" or arm = "FILE.toml")'
        )
    if parent.lower().endswith(".toml"):
        arm = _load(path.parent / parent, (*seen, path.resolve()))
    elif parent in lookup.names():
        arm = lookup.by_name(parent)
    else:
        raise UnknownNameError(f"arm in {path}", parent, lookup.names())
    return patient_from_table(path, table, arm)
