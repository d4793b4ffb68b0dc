"""Comparisons as comma-separated tables: sample by sample, and one line per method and quantity."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armik_sym._version import __version__
from armik_sym.comparison.comparison import Comparison
from armik_sym.comparison.text import rows
from armik_sym.errors import MotionFileError

Array = NDArray[np.float64]

_HEADING = ["method", "quantity", "unit", "mean_abs", "rms", "max_abs", "time_of_max_s", "bias", "samples"]


def write_samples(comparison: Comparison, path: Path) -> Path:
    """Write solved, measured and difference of every sample.

    Args:
        comparison: The comparison.
        path: The file, ending in .csv.

    Returns:
        The path written; cells of missing samples are empty.

    Raises:
        MotionFileError: If the ending is another one or the file cannot be written.

    Source:
        None (file format of this package, see `docs/recordings.md`).
    """
    columns = _columns(comparison)
    solution = comparison.solution
    record = {
        "program": f"armik_sym {__version__}",
        "arm": solution.arm.name,
        "method": solution.method,
        "notes": [*comparison.notes],
    }
    values = np.column_stack(list(columns.values()))
    cells = [["" if not np.isfinite(value) else repr(float(value)) for value in row] for row in values]
    return _write(path, [list(columns), *cells], f"# {json.dumps(record)}\n")


def write_summary(comparisons: Mapping[str, Comparison], path: Path) -> Path:
    """Write the summaries of several comparisons, in degrees and millimetres.

    Args:
        comparisons: Comparisons by the name of their method.
        path: The file, ending in .csv.

    Returns:
        The path written.

    Raises:
        MotionFileError: If the ending is another one or the file cannot be written.

    Source:
        None (file format of this package, see `docs/recordings.md`).
    """
    lines: list[list[Any]] = [_HEADING]
    for method, comparison in comparisons.items():
        for name, unit, factor, d in rows(comparison):
            scaled = [repr(factor * value) for value in (d.mean, d.rms, d.max)]
            lines.append([method, name, unit, *scaled, repr(d.at), repr(factor * d.bias), d.samples])
    return _write(path, lines)


def _columns(c: Comparison) -> dict[str, Array]:
    columns = {"time [s]": c.time}
    for i, (name, unit) in enumerate(zip(c.joint_names, c.units, strict=True)):
        for what, values in (("solved", c.q), ("measured", c.measured), ("difference", c.joint_difference)):
            columns[f"{name}_{what} [{unit.name}]"] = unit.factor * values[:, i]
    if c.swivel_difference is not None:
        columns["swivel_difference [deg]"] = np.rad2deg(c.swivel_difference)
    for what, place in (("solved", c.elbow), ("measured", c.measured_elbow)):
        if place is not None:
            columns |= {f"elbow_{axis}_{what} [mm]": 1000 * place[:, k] for k, axis in enumerate("xyz")}
    if c.elbow_difference is not None:
        columns["elbow_difference [mm]"] = 1000 * c.elbow_difference
    return columns


def _write(path: Path, lines: list[list[Any]], head: str = "") -> Path:
    if path.suffix.lower() != ".csv":
        raise MotionFileError(
            f"{path}: cannot write {path.suffix or 'a file without ending'!r}: valid is .csv"
        )
    try:
        with path.open("w", encoding="utf-8", newline="") as file:
            file.write(head)
            csv.writer(file, lineterminator="\n").writerows(lines)
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be written: {error.strerror or error}") from error
    return path
