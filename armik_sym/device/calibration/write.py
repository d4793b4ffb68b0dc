"""Calibrations as TOML text."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.joint import JointCalibration
from armik_sym.errors import CalibrationError

FORMAT = "armik calibration 1"


def calibration_text(calibration: Calibration) -> str:
    """A calibration as the text of its file; numbers come back to the last bit.

    Args:
        calibration: The calibration.

    Returns:
        TOML; angles are in [rad], as the names of the keys say.

    Source:
        TOML 1.0.
    """
    lines = [
        "# angle = direction * scale * (counts - zero); made by armik calibrate",
        f"format = {quoted(FORMAT)}",
        f"device_id = {calibration.device_id}",
        f"date = {quoted(calibration.date)}",
        f"armik_sym_version = {quoted(calibration.version)}",
        f"notes = [{', '.join(map(quoted, calibration.notes))}]",
    ]
    for joint in calibration.joints:
        lines += ["", "[[joint]]", *_joint_lines(joint)]
    return "\n".join(lines) + "\n"


def save_calibration(calibration: Calibration, path: str | Path) -> Path:
    """Write a calibration; the file is replaced whole or not at all.

    Args:
        calibration: The calibration.
        path: The file, usually *.toml.

    Returns:
        The file.

    Raises:
        CalibrationError: If it cannot be written.

    Source:
        None (file format of this package).
    """
    return replace_text(Path(path), calibration_text(calibration))


def replace_text(target: Path, text: str) -> Path:
    """Write a text file; it is replaced whole or not at all.

    Args:
        target: The file.
        text: Its text.

    Returns:
        The file.

    Raises:
        CalibrationError: If it cannot be written.

    Source:
        None (bookkeeping).
    """
    if not target.parent.is_dir():
        raise CalibrationError(f"{target}: cannot be written: there is no folder {target.parent}")
    beside = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8", newline="\n")
        beside.replace(target)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise CalibrationError(f"{target}: cannot be written: {error.strerror or error}") from None
    return target


def _joint_lines(joint: JointCalibration) -> list[str]:
    quality = joint.quality
    lines = [
        f"name = {quoted(joint.joint)}",
        f"channel = {joint.channel}",
        f"sensor = {quoted(joint.kind.name.lower())}",
        f"span_counts = {joint.span}",
        f"scale_rad_per_count = {joint.scale!r}  # {math.degrees(joint.scale):.6f} deg",
        f"scale_source = {quoted(joint.scale_source.value)}",
        f"direction = {joint.direction}",
        f"zero_counts = {joint.zero!r}",
        f"middle_rad = {joint.middle!r}  # {math.degrees(joint.middle):.1f} deg",
    ]
    if joint.valid is not None:
        lines.append(f"valid_counts = [{joint.valid[0]!r}, {joint.valid[1]!r}]")
    if joint.largest_step < math.inf:
        lines.append(f"largest_step_rad = {joint.largest_step!r}")
    if joint.index is not None:
        lines.append(f"index_counts = {joint.index!r}")
    return [
        *lines,
        f"postures = {quality.postures}",
        f"samples = {quality.samples}",
        f"residual_rms_rad = {quality.residual_rms!r}  # {math.degrees(quality.residual_rms):.3f} deg",
        f"residual_max_rad = {quality.residual_max!r}  # {math.degrees(quality.residual_max):.3f} deg",
        f"scale_standard_error = {quality.scale_error!r}",
        f"zero_standard_error_counts = {quality.zero_error!r}",
    ]


def quoted(text: str) -> str:
    """A text as TOML writes it.

    Args:
        text: The text.

    Returns:
        The same in quotation marks, escaped.

    Source:
        TOML 1.0.
    """
    # JSON escapes are TOML's, but for the one control character that JSON lets through.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")
