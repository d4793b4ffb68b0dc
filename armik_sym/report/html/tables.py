"""The tables of a report: cells as text, ready to be escaped."""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata

import numpy as np
from numpy.typing import NDArray

from armik_sym._version import __version__
from armik_sym.arm.display_units import JointUnit, joint_unit, joint_units
from armik_sym.arm.limit_words import opposite_movement
from armik_sym.report.html.chapter import Chapter
from armik_sym.report.words import joint_title, without_exponents
from armik_sym.servo import ServoCheck
from armik_sym.solution import Solution
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]

# Ranges from here on are written without decimals, in [deg] or [mm].
_WIDE = 10.0
_PACKAGES = ("numpy", "scipy", "casadi", "control", "matplotlib", "plotly")


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes:
        caption: What it shows.
        head: Headings, the first column being the name of the row.
        rows: Cells.
    """

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def for_readers(self) -> Table:
        """The table with all numbers written out.

        Returns:
            The same table without exponents.

        Source:
            None (reporting).
        """
        rows = tuple(tuple(without_exponents(cell) for cell in row) for row in self.rows)
        return Table(self.caption, self.head, rows)


def joint_table(s: Solution) -> Table:
    """What each joint does: range used, range allowed, room, peak speed and acceleration.

    Args:
        s: The solution.

    Returns:
        One row per joint.

    Source:
        None (reporting).
    """
    rows = []
    for j, (name, unit) in enumerate(zip(s.arm.joint_names, joint_units(s.arm), strict=True)):
        low, high = (unit.factor * float(value) for value in (s.q[:, j].min(), s.q[:, j].max()))
        lower, upper = (unit.factor * float(rom[j]) for rom in (s.arm.rom.lower, s.arm.rom.upper))
        opposite = opposite_movement(name)
        minus = "" if opposite is None else joint_title(opposite).lower()
        rows.append(
            (
                joint_title(name),
                minus,
                _range(low, high, unit),
                _range(lower, upper, unit),
                unit.text(float(s.rom_margin[j]), 3),
                unit.text(float(s.max_speed[j]), 3, "/s"),
                unit.text(float(s.max_acceleration[j]), 3, "/s²"),
            )
        )
    head = (
        "Joint",
        "a negative angle means",
        "used",
        "allowed",
        "room to the limit",
        "peak speed",
        "peak acceleration",
    )
    return Table("Joints: what is used of what is allowed", head, tuple(rows))


def method_table(chapter: Chapter) -> Table | None:
    """The solution beside the same task solved in other ways; None if there is nothing beside it.

    Args:
        chapter: The chapter.

    Returns:
        One row per way.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    if not chapter.others:
        return None
    names = {"": f"this report ({chapter.solution.method})", **{name: name for name in chapter.others}}
    rows = []
    for key, each in {"": chapter.solution, **chapter.others}.items():
        cells = [
            names[key],
            "ok" if each.ok else "not ok",
            _small(1000 * float(each.position_error.max()), "mm"),
        ]
        if chapter.solution.orientation is not Orientation.NONE:
            cells.append(_small(float(np.rad2deg(each.rotation_error.max())), "°"))
        cells += [
            joint_unit(each.arm, int(each.rom_margin.argmin())).text(float(each.rom_margin.min())),
            _most(each, each.max_step),
            _most(each, each.max_speed, "/s"),
            _degrees(each.arc_length),
        ]
        if chapter.differences:
            cells.append(_degrees(chapter.differences[key].all_joints.mean))
        if len(chapter.checks) > 1:
            cells.append(_off(chapter.checks, key))
        rows.append(tuple(cells))
    head = ["Way", "verdict", "hand off by at most"]
    head += ["hand turned wrong by at most"] if chapter.solution.orientation is not Orientation.NONE else []
    head += ["least room to a limit", "largest change between instants", "fastest joint", "way of all joints"]
    head += ["mean difference to measured"] if chapter.differences else []
    head += ["hand off with the drives, at most (RMS)"] if len(chapter.checks) > 1 else []
    return Table("The same hand path solved in other ways", tuple(head), tuple(rows))


def difference_table(chapter: Chapter) -> Table | None:
    """How far each joint is from the measured one; None if nothing was measured.

    Args:
        chapter: The chapter.

    Returns:
        One row per measured joint.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    found = chapter.differences.get("")
    if found is None:
        return None
    rows = [
        (joint_title(name), *(_tidy(unit, value) for value in (d.mean, d.rms, d.max)))
        for name, unit, d in zip(found.joint_names, found.units, found.joints, strict=True)
    ]
    if found.elbow_summary is not None:
        d = found.elbow_summary
        rows.append(("Elbow (distance)", *(f"{1000 * value:.3g} mm" for value in (d.mean, d.rms, d.max))))
    head = ("Joint", "mean", "root mean square", "largest")
    return Table("Difference between this motion and the measured one", head, tuple(rows))


def servo_table(check: ServoCheck) -> Table:
    """What the drive of each joint is asked for, and what it can do.

    Args:
        check: The check.

    Returns:
        One row per joint.

    Source:
        None (reporting).
    """
    rows = [
        (
            joint_title(v.name),
            "can follow" if v.ok else "cannot follow",
            f"{np.rad2deg(v.speed):.3g} of {np.rad2deg(v.speed_limit):.3g}°/s",
            f"{v.torque:.2g} of {v.torque_limit:.3g} Nm",
            f"{v.torque_rms:.2g} of {v.torque_rated:.3g} Nm",
            f"{np.rad2deg(v.error_peak):.2g}°",
            f"{np.rad2deg(v.margins.phase):.0f}°",
        )
        for v in check.joints
    ]
    head = (
        "Joint", "verdict", "speed, of what the drive can", "peak torque", "torque all the time (RMS)",
        "off by at most", "phase margin",
    )  # fmt: skip
    return Table("Drives: what is asked of what they can do", head, tuple(rows))


def settings_table(chapter: Chapter) -> Table:
    """Everything needed to repeat the solution.

    Args:
        chapter: The chapter.

    Returns:
        Names and values.

    Source:
        None (reporting).
    """
    s = chapter.solution
    rows = {
        "method": s.method,
        "orientation": s.orientation.value,
        "seed": str(s.seed),
        "start posture [rad or m]": "free" if s.start is None else json.dumps(np.asarray(s.start).tolist()),
        "arm": s.arm.name,
        "segment lengths [m]": json.dumps(dict(s.arm.lengths)),
        "lower limits [rad or m]": json.dumps(s.arm.rom.lower.tolist()),
        "upper limits [rad or m]": json.dumps(s.arm.rom.upper.tolist()),
        **{f"option {key}": _value(value) for key, value in s.settings.items()},
        "solver": f"{s.status}, {s.iterations} iterations",
        "time": f"build {s.timing.build:.2g} s, compile {s.timing.compile:.2g} s, "
        f"solve {s.timing.solve:.2g} s",
        **({} if s.cost is None else {"cost": f"{s.cost:.9g} 1/s"}),
        **({} if s.bound is None else {"no trajectory costs less than": f"{s.bound.value:.9g} 1/s"}),
    }
    return Table("Settings of this motion", ("what", "value"), tuple(rows.items()))


def versions() -> Table:
    """The versions of everything that computed.

    Returns:
        Names and versions.

    Source:
        None (importlib.metadata).
    """
    rows = {"armik_sym": __version__, "Python": platform.python_version(), "system": platform.system()}
    rows |= {name: metadata.version(name) for name in _PACKAGES}
    return Table("Versions", ("what", "version"), tuple(rows.items()))


def _range(low: float, high: float, unit: JointUnit) -> str:
    digits = 0 if high - low >= _WIDE else 1
    one, other = (f"{round(value, digits) + 0.0:.{digits}f}" for value in (low, high))
    return f"{one} to {other}{unit.symbol}"


def _degrees(value: float) -> str:
    degrees = float(np.rad2deg(value))
    return f"{degrees:.0f}°" if abs(degrees) >= 1000 else f"{degrees:.3g}°"


def _tidy(unit: JointUnit, value: float) -> str:
    """A difference without the noise of rounding."""
    return f"< 0.001{unit.symbol}" if unit.factor * value < 1e-3 else unit.text(value, 3)


def _most(s: Solution, values: Array, per: str = "") -> str:
    """The largest of one value per joint, in the unit of that joint."""
    units = joint_units(s.arm)
    j = int(np.argmax([unit.factor * value for unit, value in zip(units, values, strict=True)]))
    shown = units[j].factor * float(values[j])
    return f"{shown:.0f}{units[j].symbol}{per}" if shown >= 1000 else units[j].text(float(values[j]), 3, per)


def _small(value: float, unit: str) -> str:
    space = "" if unit == "°" else " "
    return f"< 0.000001{space}{unit}" if value < 1e-6 else f"{value:.3g}{space}{unit}"


def _off(checks: Mapping[str, ServoCheck], key: str) -> str:
    if key not in checks:
        return ""
    tracking = checks[key].tracking
    return f"{_millimetres(tracking.hand_peak)} ({_millimetres(tracking.hand_rms)})"


def _millimetres(metres: float) -> str:
    return f"{1000 * metres:.0f} mm" if metres >= 0.1 else f"{1000 * metres:.2g} mm"


def _value(value: object) -> str:
    return json.dumps(np.asarray(value).tolist()) if isinstance(value, np.ndarray | tuple) else str(value)
