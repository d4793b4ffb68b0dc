"""Calibrations from TOML files."""

from __future__ import annotations

import math
from pathlib import Path

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.joint import JointCalibration, JointQuality, ScaleSource
from armik_sym.device.calibration.toml_table import TomlTable
from armik_sym.device.calibration.write import FORMAT
from armik_sym.device.channels import MOST_CHANNELS, SensorKind
from armik_sym.errors import CalibrationError

_TOP = ("format", "device_id", "date", "armik_sym_version", "notes", "joint")
_JOINT = (
    "name", "channel", "sensor", "span_counts", "scale_rad_per_count", "scale_source", "direction",
    "zero_counts", "middle_rad", "valid_counts", "largest_step_rad", "index_counts", "postures", "samples",
    "residual_rms_rad", "residual_max_rad", "scale_standard_error", "zero_standard_error_counts",
)  # fmt: skip
_LARGEST = 2**63 - 1


def load_calibration(path: str | Path) -> Calibration:
    """Read a calibration file.

    Args:
        path: The file.

    Returns:
        The calibration.

    Raises:
        CalibrationError: If it cannot be read, or says what cannot be; the message names the line.

    Source:
        None (file format of this package); docs/device.md.
    """
    return parse_calibration(read_text(Path(path)), str(path))


def read_text(path: Path) -> str:
    """The text of a file.

    Args:
        path: The file.

    Returns:
        Its text.

    Raises:
        CalibrationError: If it cannot be read.

    Source:
        None (bookkeeping).
    """
    try:
        return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")
    except FileNotFoundError:
        raise CalibrationError(f"{path}: no such file") from None
    except UnicodeDecodeError as error:
        raise CalibrationError(
            f"{path}: is no UTF-8 text (byte {error.start}): expected a TOML file"
        ) from None
    except OSError as error:
        raise CalibrationError(f"{path}: cannot be read: {error.strerror or error}") from None


def parse_calibration(text: str, name: str = "calibration") -> Calibration:
    """A calibration from the text of its file.

    Args:
        text: The text, as from `calibration_text`.
        name: Name of the file, beginning messages.

    Returns:
        The calibration.

    Raises:
        CalibrationError: If it says what cannot be; the message names the line.

    Source:
        None (file format of this package); docs/device.md.
    """
    top = TomlTable.parse(text, name)
    if top.string("format", "") != FORMAT:
        raise top.wrong("format", f"expected {FORMAT!r}: this is no calibration, or one of a later version")
    top.check_keys(_TOP)
    notes = top.values.get("notes", [])
    if not isinstance(notes, list) or not all(isinstance(note, str) for note in notes):
        raise top.wrong("notes", "expected a list of texts")
    device = top.integer("device_id", 0, 0xFFFFFFFF)
    date, version = top.string("date"), top.string("armik_sym_version")
    joints = tuple(_joint(table) for table in top.tables("joint"))
    try:
        return Calibration(device, date, joints, version, tuple(notes))
    except CalibrationError as error:
        raise CalibrationError(f"{name}: {error}") from None


def _joint(table: TomlTable) -> JointCalibration:
    table.check_keys(_JOINT)
    sensors = {kind.name.lower(): kind for kind in SensorKind}
    kind = sensors.get(table.string("sensor"))
    if kind is None:
        raise table.wrong("sensor", f"expected one of {', '.join(sensors)}")
    sources = {source.value: source for source in ScaleSource}
    source = sources.get(table.string("scale_source"))
    if source is None:
        raise table.wrong("scale_source", f"expected one of {', '.join(sources)}")
    quality = JointQuality(
        table.integer("postures", 0, _LARGEST),
        table.integer("samples", 0, _LARGEST),
        table.number_of("residual_rms_rad"),
        table.number_of("residual_max_rad"),
        table.number_of("scale_standard_error"),
        table.number_of("zero_standard_error_counts"),
    )
    values = (
        table.string("name"),
        table.integer("channel", 0, MOST_CHANNELS - 1),
        kind,
        table.integer("span_counts", 2, 0xFFFFFFFF),
        table.number_of("scale_rad_per_count"),
        table.integer("direction", -1, 1),
        table.number_of("zero_counts"),
        table.number_of("middle_rad"),
        _pair(table, "valid_counts"),
        table.number_of("largest_step_rad") if "largest_step_rad" in table.values else math.inf,
        table.number_of("index_counts") if "index_counts" in table.values else None,
        source,
        quality,
    )
    try:
        return JointCalibration(*values)
    except CalibrationError as error:
        # The field begins the name of its key: "scale" is scale_rad_per_count.
        field = str(error).split(": ", 1)[1].split(" ", 1)[0]
        key = next((key for key in _JOINT if key.startswith(field)), "name")
        raise CalibrationError(f"{table.name}: line {table.line(key)}: {error}") from None


def _pair(table: TomlTable, key: str) -> tuple[float, float] | None:
    if key not in table.values:
        return None
    value = table.values[key]
    if not isinstance(value, list) or len(value) != 2:
        raise table.wrong(key, "expected [lowest, highest]")
    return table.finite(key, value[0]), table.finite(key, value[1])
