"""Postures and their counts from a CSV table."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from armik_sym.device.calibration.calibration_file import read_text
from armik_sym.device.calibration.posture import Posture
from armik_sym.errors import CalibrationError


def posture_table(path: Path, unit: float) -> list[Posture]:
    """Read postures from a CSV table.

    Columns: posture, one per joint with its angle (empty: not known), and channel_0, channel_1, and so on.
    Rows with the same posture are samples of it. Lines that begin with # are remarks.

    Args:
        path: The file.
        unit: From the unit of its angles to [rad].

    Returns:
        The postures, in the order in which they come first.

    Raises:
        CalibrationError: If something is missing or no number; the message names the line.

    Source:
        None (file format of this package); docs/device.md.
    """
    reader = csv.reader(read_text(path).splitlines())
    rows = [(reader.line_num, row) for row in reader if row and not row[0].lstrip().startswith("#")]
    if not rows:
        raise CalibrationError(f"{path}: the file is empty")
    head = [name.strip() for name in rows[0][1]]
    channels = [k for k, name in enumerate(head) if name.startswith("channel_")]
    if "posture" not in head or [head[k] for k in channels] != [f"channel_{i}" for i in range(len(channels))]:
        raise CalibrationError(
            f"{path}: line {rows[0][0]}: columns {', '.join(head)}: expected posture, joints, channel_0, "
            "channel_1, ..."
        )
    joints = {k: name for k, name in enumerate(head) if k not in channels and name != "posture"}
    angles: dict[str, dict[str, float]] = {}
    counts: dict[str, list[list[int]]] = {}
    for line, row in rows[1:]:
        if len(row) != len(head):
            raise CalibrationError(f"{path}: line {line}: {len(row)} values, expected {len(head)}")
        name = row[head.index("posture")].strip()
        known = {
            joint: unit * _number(path, line, joint, row[k]) for k, joint in joints.items() if row[k].strip()
        }
        if angles.setdefault(name, known) != known:
            raise CalibrationError(f"{path}: line {line}: posture {name!r} has other angles than before")
        counts.setdefault(name, []).append([_count(path, line, head[k], row[k]) for k in channels])
    return [Posture(name, angles[name], np.array(table)) for name, table in counts.items()]


def _number(path: Path, line: int, column: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise CalibrationError(f"{path}: line {line}, column {column}: {text.strip()!r} is no number")
    return value


def _count(path: Path, line: int, column: str, text: str) -> int:
    value = _number(path, line, column, text)
    if value != round(value) or not 0 <= value <= 0xFFFF:
        raise CalibrationError(
            f"{path}: line {line}, column {column}: {text.strip()!r}, expected a whole number from 0 to 65535"
        )
    return int(value)
