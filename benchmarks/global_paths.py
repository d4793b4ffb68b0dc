"""The default whole-trajectory method from cold on the random feasible trajectories of the tests.

    python benchmarks/global_paths.py [--families NAME …] [--limit N] [--only-full-space] [--json FILE]

Beside it: the full-space problem from cold, and the full-space problem started at the very motion that made
the path, whose cost all others are divided by. Exits with 1 if the default method misses a bar: all solved,
margins ≥ 0, errors ≤ 1e-9 m and rad, costs at most 1.001 × that of the full-space problem.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parent.parent / "tests"))

from random_trajectories import FAMILIES, RandomTrajectory, trajectories
from reference_cost import cost, full_space_from

import armik_sym as ak
from armik_sym.errors import ArmikError, UnknownNameError
from armik_sym.solution import Solution

WORST_RATIO, LARGEST_ERROR = 1.001, 1e-9


@dataclass(frozen=True)
class Row:
    """One method on one trajectory; costs as multiples of the reference, angles in [rad], time in [s].

    `ended` says why there is no solution, or what speaks against it.
    """

    family: str
    name: str
    arm: str
    samples: int
    method: str
    solved: bool
    ended: str
    ratio: float
    margin: float
    position_error: float
    rotation_error: float
    step: float
    seconds: float
    reference_converged: bool
    reference_cost: float

    @property
    def good(self) -> bool:
        """Whether every bar is met."""
        errors = max(self.position_error, self.rotation_error)
        return self.solved and self.margin >= 0 and errors <= LARGEST_ERROR and self.ratio <= WORST_RATIO


def by_default(arm: ak.Arm, path: ak.HandPath) -> Solution:
    """The method under test."""
    return ak.solve(arm, path)


def by_full_space(arm: ak.Arm, path: ak.HandPath) -> Solution:
    """The full-space problem from cold; the default where there is no choice of search."""
    try:
        return ak.solve(arm, path, search="full-space")
    except UnknownNameError:
        return ak.solve(arm, path)


METHODS: dict[str, Callable[[ak.Arm, ak.HandPath], Solution]] = {
    "default": by_default,
    "full space": by_full_space,
}


def measure(task: RandomTrajectory, methods: Iterable[str]) -> list[Row]:
    """Solve one trajectory with each method."""
    reference = full_space_from(task.arm, task.path, task.q)
    rows = []
    for method in methods:
        began = time.perf_counter()
        try:
            solution, failure = METHODS[method](task.arm, task.path), ""
        except ArmikError as error:
            solution, failure = None, f"{type(error).__name__}: {error}"
        spent = time.perf_counter() - began
        q = None if solution is None else solution.q
        rows.append(
            Row(
                family=task.family,
                name=task.name,
                arm=task.arm.name,
                samples=len(task.q),
                method=method,
                solved=solution is not None and solution.ok,
                ended=failure if solution is None else "; ".join(solution.reasons),
                ratio=np.nan if q is None else cost(task.arm, task.path, q) / reference.cost,
                margin=np.nan if solution is None else float(solution.rom_margin.min()),
                position_error=np.nan if solution is None else float(solution.position_error.max()),
                rotation_error=np.nan if solution is None else float(solution.rotation_error.max()),
                step=np.nan if solution is None else float(solution.max_step.max()),
                seconds=spent,
                reference_converged=reference.converged,
                reference_cost=reference.cost,
            )
        )
    return rows


HEADER = (
    "family                   method       solved  worst ratio   median  better  worse  margin [°]  "
    "pos [m]  rot [rad]  step [°]  s/path"
)


def line(family: str, method: str, rows: list[Row]) -> str:
    """One line of the table: one family, one method.

    `better` and `worse` count costs under 0.99 and over 1.001 of the reference.
    """
    solved = [row for row in rows if row.solved]
    seconds = np.median([row.seconds for row in rows])
    start = f"{family:24s} {method:11s} {len(solved):3d}/{len(rows):<3d}"
    if not solved:
        return f"{start} {'-':>12s} {'-':>8s} {'-':>7s} {'-':>6s} {'-':>11s} {'-':>8s} {'-':>10s} {'-':>9s}"
    ratio = np.array([row.ratio for row in solved])
    return (
        f"{start} {ratio.max():12.5f} {np.median(ratio):8.5f} {np.sum(ratio < 0.99):7d} "
        f"{np.sum(ratio > WORST_RATIO):6d} {np.rad2deg(min(row.margin for row in solved)):11.2g} "
        f"{max(row.position_error for row in solved):8.1e} {max(row.rotation_error for row in solved):10.1e} "
        f"{np.rad2deg(max(row.step for row in solved)):9.1f} {seconds:7.2f}"
    )


def main(arguments: argparse.Namespace) -> int:
    """Print the table, then every failure."""
    methods = ["full space"] if arguments.only_full_space else list(METHODS)
    rows: list[Row] = []
    print(HEADER, flush=True)
    for family in arguments.families:
        mine = [row for task in trajectories([family], arguments.limit) for row in measure(task, methods)]
        rows += mine
        for method in methods:
            print(line(family, method, [row for row in mine if row.method == method]), flush=True)
    for method in methods:
        print(line("all", method, [row for row in rows if row.method == method]))
    unconverged = {row.name for row in rows if not row.reference_converged}
    print(f"references that did not converge (the generating motion's own cost counts): {len(unconverged)}")
    judged = [row for row in rows if row.method == methods[0]]
    missed = [row for row in judged if not row.good]
    for row in missed:
        print(f"MISSED {row.name} ({row.arm}, {row.samples} samples): ratio {row.ratio:.5f} {row.ended}")
    print(f"{methods[0]}: {len(judged) - len(missed)} of {len(judged)} meet every bar")
    if arguments.json:
        arguments.json.write_text(json.dumps([dataclasses.asdict(row) for row in rows], indent=1))
    return 1 if missed else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--families", nargs="+", choices=list(FAMILIES), default=list(FAMILIES))
    parser.add_argument("--limit", type=int, default=20, help="trajectories per family")
    parser.add_argument(
        "--only-full-space", action="store_true", help="only the full-space problem from cold"
    )
    parser.add_argument("--json", type=Path, help="write every row to this file")
    sys.exit(main(parser.parse_args()))
