"""Writing a solution to a file."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from armik_sym._version import __version__
from armik_sym.arm.display_units import joint_units
from armik_sym.errors import MotionFileError
from armik_sym.motion.storage import write_storage
from armik_sym.motion.storage_table import angle_table

if TYPE_CHECKING:
    from armik_sym.solution.solution import Solution
    from armik_sym.solution.verdict import Requirements


def save(solution: Solution, path: Path) -> Path:
    """Write a solution as `.csv`, `.npz`, `.mot` or `.sto`; see `Solution.save`.

    Args:
        solution: The solution.
        path: The file.

    Returns:
        The path written.

    Raises:
        MotionFileError: If the ending is unknown or the file cannot be written.

    Source:
        None (file formats of this package); OpenSim documentation, "Storage (.sto) files".
    """
    writers: dict[str, Callable[[Solution, Path], None]] = {
        ".csv": _write_csv,
        ".mot": _write_storage,
        ".npz": _write_npz,
        ".sto": _write_storage,
    }
    writer = writers.get(path.suffix.lower())
    if writer is None:
        raise MotionFileError(
            f"{path}: cannot write {path.suffix or 'a file without ending'!r}: valid are {', '.join(writers)}"
        )
    try:
        with np.errstate(invalid="ignore"):  # angles that are not finite are saved as such
            writer(solution, path)
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be written: {error.strerror}") from error
    return path


def _record(solution: Solution) -> dict[str, object]:
    return {
        "program": f"armik_sym {__version__}",
        "note": solution.path.note,
        "arm": solution.arm.name,
        "arm_description": solution.arm.description,
        "lengths_m": dict(solution.arm.lengths),
        "joints": list(solution.arm.joint_names),
        "lower_limits": solution.arm.rom.lower.tolist(),
        "upper_limits": solution.arm.rom.upper.tolist(),
        "method": solution.method,
        "orientation": solution.orientation.value,
        "settings": {key: _plain(value) for key, value in solution.settings.items()},
        "seed": solution.seed,
        "start": None if solution.start is None else np.asarray(solution.start).tolist(),
        "requirements": _requirements(solution.requirements),
        "ok": solution.ok,
        "reasons": list(solution.reasons),
        "status": solution.status,
        "cost": solution.cost,
        "lower_bound": None if solution.bound is None else solution.bound.value,
    }


def _requirements(need: Requirements) -> dict[str, object]:
    """What the solution was judged by; null where there is no limit."""
    return {
        "position_tolerance": _finite(need.position_tolerance),
        "rotation_tolerance": _finite(need.rotation_tolerance),
        "start_tolerance": _finite(need.start_tolerance),
        "max_speed": [_finite(value) for value in need.max_speed.tolist()],
        "max_acceleration": [_finite(value) for value in need.max_acceleration.tolist()],
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _plain(value: object) -> object:
    """A setting as JSON can hold it."""
    return np.asarray(value).tolist() if isinstance(value, (np.ndarray, np.generic, list, tuple)) else value


def _write_csv(solution: Solution, path: Path) -> None:
    units = joint_units(solution.arm)
    names = zip(solution.arm.joint_names, units, strict=True)
    columns = ["time [s]", *(f"{name} [{unit.name}]" for name, unit in names)]
    columns += ["position_error [mm]", "rotation_error [deg]"]
    per_sample = [
        solution.time,
        solution.q * [unit.factor for unit in units],
        1000 * solution.position_error,
        np.rad2deg(solution.rotation_error),
    ]
    for name, told in _told_by_the_method(solution).items():
        columns.append(f"{name} [-]")
        per_sample.append(told.astype(np.float64))
    values = np.column_stack(per_sample)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(f"# {json.dumps(_record(solution))}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[repr(float(value)) for value in row] for row in values])


def _told_by_the_method(solution: Solution) -> dict[str, Any]:
    """What a pointwise method says of each sample: whether it was reached (1 or 0), and its iterations."""
    told = {"reached": solution.reached, "iterations": solution.sample_iterations}
    return {name: values for name, values in told.items() if values is not None}


def _write_storage(solution: Solution, path: Path) -> None:
    arm = solution.arm
    table = angle_table(solution.time, solution.q, arm.joint_names, arm.rotates.tolist())
    verdict = "ok" if solution.ok else "not ok"
    write_storage(
        path,
        table,
        f"Solved by armik_sym {__version__}, arm {arm.name}, method {solution.method}: {verdict}\n"
        "Rotations are in degrees, translations in metres, times in seconds.",
    )


def _write_npz(solution: Solution, path: Path) -> None:
    arrays: dict[str, Any] = {
        "time": solution.time,
        "q": solution.q,
        "joint_names": np.array(solution.arm.joint_names),
        "lower": solution.arm.rom.lower,
        "upper": solution.arm.rom.upper,
        "path_position": solution.path.position,
        "path_rotation": np.empty((0, 3, 3)) if solution.path.rotation is None else solution.path.rotation,
        "position_error": solution.position_error,
        "rotation_error": solution.rotation_error,
        "record": np.array(json.dumps(_record(solution))),
    }
    np.savez_compressed(path, **arrays, **_told_by_the_method(solution))
