"""Postures and their counts from a file: a calibration without a device at hand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.catalog import by_name
from armik_sym.device.calibration.calibration_file import read_text
from armik_sym.device.calibration.encoder import NO_INDEX
from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.posture_table import posture_table
from armik_sym.device.calibration.setup import JointSetup, arm_setup
from armik_sym.device.calibration.toml_table import TomlTable
from armik_sym.device.channels import MOST_CHANNELS, Channel, DeviceInfo, SensorKind
from armik_sym.errors import ArmikError, CalibrationError

FORMAT = "armik postures 1"
_UNITS = {"deg": math.pi / 180, "rad": 1.0}
_TOP = ("format", "device_id", "rate_hz", "arm", "angle_unit", "table", "channel", "joint", "posture")
_CHANNEL = ("sensor", "span_counts")
_JOINT = ("name", "channel", "direction", "scale_rad_per_count", "middle_rad", "full_scale_rad")
_POSTURE = ("name", "angles", "counts", "index", "recording", "seconds")


@dataclass(frozen=True, slots=True)
class PostureFile:
    """What `fit_calibration` needs, read from a file.

    Attributes:
        info: The device.
        setups: The joints.
        postures: The postures, in their order.
    """

    info: DeviceInfo
    setups: tuple[JointSetup, ...]
    postures: tuple[Posture, ...]


def load_postures(path: str | Path) -> PostureFile:
    """Read postures: a TOML file that holds them, or names a CSV table or recordings that do.

    Args:
        path: The file; others it names are looked for beside it.

    Returns:
        Device, joints and postures.

    Raises:
        CalibrationError: If something is missing or contradicts itself; the message names file and line.

    Source:
        None (file format of this package); docs/device.md.
    """
    file = Path(path)
    top = TomlTable.parse(read_text(file), str(file))
    if top.string("format", "") != FORMAT:
        raise top.wrong("format", f"expected {FORMAT!r}")
    top.check_keys(_TOP)
    unit = _UNITS.get(top.string("angle_unit"))
    if unit is None:
        raise top.wrong("angle_unit", 'expected "deg" or "rad"')
    postures, infos = [], []
    for table in top.tables("posture") if "posture" in top.values else []:
        posture, seen = _posture(table, file.parent, unit)
        postures.append(posture)
        infos += seen
    if "table" in top.values:
        postures += posture_table(file.parent / top.string("table"), unit)
    if not postures:
        raise top.wrong("posture", 'expected tables [[posture]], or a CSV table = "postures.csv"')
    info = _info(top, infos)
    for posture in postures:
        if posture.table.shape[1] != len(info.channels):
            raise CalibrationError(
                f"{file}: posture {posture.name!r} has counts of {posture.table.shape[1]} channels, the "
                f"device has {len(info.channels)}"
            )
    return PostureFile(info, _setups(top, info), tuple(postures))


def _info(top: TomlTable, infos: list[DeviceInfo]) -> DeviceInfo:
    """The device, from the file or from the recordings, which may not contradict each other."""
    if len({(info.device_id, info.channels) for info in infos}) > 1:
        ids = ", ".join(sorted({str(info.device_id) for info in infos}))
        raise CalibrationError(f"{top.name}: its recordings are of different devices ({ids})")
    if "channel" not in top.values:
        if not infos:
            raise top.wrong(
                "channel", "expected tables [[channel]] with sensor and span_counts, or recordings"
            )
        return infos[0]
    channels = []
    for table in top.tables("channel"):
        table.check_keys(_CHANNEL)
        sensors = {kind.name.lower(): kind for kind in SensorKind}
        kind = sensors.get(table.string("sensor"))
        if kind is None:
            raise table.wrong("sensor", f"expected one of {', '.join(sensors)}")
        highest = 0x10000 if kind is SensorKind.POTENTIOMETER else 0xFFFFFFFF
        channels.append(Channel(kind, table.integer("span_counts", 2, highest)))
    if len(channels) > MOST_CHANNELS:
        raise top.wrong("channel", f"expected at most {MOST_CHANNELS} tables [[channel]]")
    rate = top.integer("rate_hz", 1, 0xFFFF) if "rate_hz" in top.values else 100
    device = top.integer("device_id", 0, 0xFFFFFFFF)
    if infos and (infos[0].device_id != device or infos[0].channels != tuple(channels)):
        raise top.wrong(
            "device_id", f"the recordings are of device {infos[0].device_id}, or of other sensors"
        )
    return DeviceInfo(device, float(rate), tuple(channels))


def _setups(top: TomlTable, info: DeviceInfo) -> tuple[JointSetup, ...]:
    if "joint" not in top.values:
        try:
            arm = by_name(top.string("arm", "ehmcs"))
        except ArmikError as error:
            raise top.wrong("arm", str(error)) from None
        return arm_setup(arm, info)
    setups = []
    for table in top.tables("joint"):
        table.check_keys(_JOINT)
        full = table.values.get("full_scale_rad")
        if full is not None and not (isinstance(full, list) and len(full) == 2):
            raise table.wrong("full_scale_rad", "expected [lowest, highest]")
        given = table.values
        try:
            setups.append(
                JointSetup(
                    table.string("name"),
                    table.integer("channel", 0, len(info.channels) - 1),
                    table.number_of("middle_rad", 0.0),
                    table.number_of("scale_rad_per_count") if "scale_rad_per_count" in given else None,
                    table.integer("direction", -1, 1) if "direction" in given else None,
                    None
                    if full is None
                    else (table.finite("full_scale_rad", full[0]), table.finite("full_scale_rad", full[1])),
                )
            )
        except CalibrationError as error:
            if str(error).startswith(top.name):
                raise
            raise CalibrationError(f"{top.name}: line {table.line('name')}: {error}") from None
    return tuple(setups)


def _posture(table: TomlTable, folder: Path, unit: float) -> tuple[Posture, list[DeviceInfo]]:
    table.check_keys(_POSTURE)
    angles = table.values.get("angles")
    if not isinstance(angles, dict):
        raise table.wrong("angles", "expected { joint = angle, ... }")
    known = {joint: unit * table.finite("angles", angle) for joint, angle in angles.items()}
    name = table.string("name")
    if ("counts" in table.values) == ("recording" in table.values):
        raise table.wrong("counts", "expected either counts or a recording")
    pulses: dict[int, int] | None = None
    infos: list[DeviceInfo] = []
    if "recording" in table.values:
        counts, pulses, infos = _recorded(table, folder)
    else:
        counts, pulses = np.empty(0, dtype=np.int64), _index(table)
        value = table.values["counts"]
        if isinstance(value, list) and value:
            rows = value if isinstance(value[0], list) else [value]
            if len({len(row) if isinstance(row, list) else -1 for row in rows}) == 1:
                counts = np.array(rows)
    try:
        return Posture(name, known, counts, pulses), infos
    except ArmikError as error:
        key = "counts" if "counts" in table.values else "recording"
        raise CalibrationError(f"{table.name}: line {table.line(key)}: {error}") from None


def _index(table: TomlTable) -> dict[int, int] | None:
    """Registers at index pulses, by channel."""
    given = table.values.get("index")
    if given is None:
        return None
    numbers = isinstance(given, dict) and all(
        key.isdecimal() and type(register) is int and 0 <= register <= 0xFFFF
        for key, register in given.items()
    )
    if not numbers:
        raise table.wrong("index", "expected { channel = register at the index pulse, ... }")
    return {int(key): register for key, register in given.items()}


def _recorded(table: TomlTable, folder: Path) -> tuple[NDArray[np.int64], dict[int, int], list[DeviceInfo]]:
    """Counts of a recording, or of the seconds given of it, and its index pulses up to there."""
    from armik_sym.device.recording import read_recording

    recording = read_recording(folder / table.string("recording"))
    first, last = -math.inf, math.inf
    if "seconds" in table.values:
        pair = table.values["seconds"]
        if not isinstance(pair, list) or len(pair) != 2:
            raise table.wrong("seconds", "expected [first, last], from the beginning of the recording")
        first, last = table.finite("seconds", pair[0]), table.finite("seconds", pair[1])
    time = recording.time - recording.time[0] if recording.n else recording.time
    inside = (time >= first) & (time <= last)
    if not inside.any():
        raise table.wrong("recording", "it has no sample there")
    pulses = {}
    for channel in range(recording.counts.shape[1]):
        at = recording.at_index[time <= last, channel]
        if (at != NO_INDEX).any():
            pulses[channel] = int(at[at != NO_INDEX][-1])
    return np.asarray(recording.counts[inside], dtype=np.int64), pulses, list(recording.infos)
