"""Whole-trajectory solves of 100 to 100,000 samples: time, where it goes, iterations, memory, start-up.

    python benchmarks/trajectory.py

Each length runs in a process of its own, pinned to one core, with an empty cache (cold) and with a filled
one (warm). "warm" solves are repeated in the process and the fastest counts; a second path of another length
must compile nothing. Times are told as they are and, per pose, as multiples of one generated forward
kinematics + Jacobian of the same process, evaluated one posture at a time ("plain") and in vector lanes
("lanes"): machines differ, and so does the same machine from hour to hour.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LENGTHS = (100, 1_000, 10_000, 100_000)
FULL_SPACE = (100, 1_000, 10_000)
RATE = 100.0  # samples per second

AIM_1000 = 0.060  # [s], map, global path and polish of 1,000 poses
AIM_MULTIPLE = 350  # generated FK + J per pose
AIM_GROWTH = 12  # for ten times 1,000 poses
AIM_MEMORY = 2.0  # [GB]
AIM_COLD = 10.0  # [s], a process with an empty cache, to its first answer
AIM_COMMAND = 2.0  # [s], `armik solve` of 500 samples with a filled cache


def smooth_path(n: int, seed: int):
    """A smooth hand path of n samples at 100 Hz from random joint motions inside the range of motion."""
    import numpy as np

    import armik_sym as ak
    from armik_sym.arm.product_of_transforms import hand_pose

    arm = ak.catalog.ehmcs()
    rng = np.random.default_rng(seed)
    t = np.arange(n) / RATE
    waves = np.zeros((n, arm.dof))
    for harmonic in range(1, 4):
        phase = rng.uniform(0, 2 * np.pi, arm.dof)
        frequency = harmonic * 0.15 * rng.uniform(0.8, 1.2, arm.dof)
        waves += np.sin(2 * np.pi * frequency * t[:, None] + phase) / harmonic
    q = arm.rom.middle + 0.2 * np.minimum(arm.rom.width, 2.0) * waves
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    return arm, ak.HandPath(t, position, rotation)


def kinematics_times(arm) -> tuple[float, float]:
    """One generated forward kinematics + Jacobian in seconds: one posture at a time, and in vector lanes."""
    import ctypes

    import numpy as np
    from kinematics import c_timers

    import armik_sym as ak
    from armik_sym.compiled.compiler import find_compiler

    kinematics = ak.compile(arm)
    q = arm.rom.random_postures(np.random.default_rng(0), 256)
    out = np.zeros((len(q), 54))
    compiler = find_compiler()
    lanes = plain = np.inf
    with tempfile.TemporaryDirectory() as folder:
        timers = c_timers(arm, compiler, Path(folder)) if compiler else None
        for _ in range(200):
            began = time.perf_counter()
            kinematics.pose_and_jacobian(q)
            lanes = min(lanes, time.perf_counter() - began)
            if timers:
                addresses = (ctypes.c_void_p(array.ctypes.data) for array in (q, out))
                plain = min(plain, timers.time_plain_pose_and_jacobian(ctypes.c_ssize_t(len(q)), *addresses))
    return (plain if timers else lanes) / len(q), lanes / len(q)


def measure(n: int, search: str, repeats: int) -> None:
    """Solve one path, again and again, then another of another length; print one line of JSON."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    started = time.perf_counter()
    import armik_sym as ak

    ak.solve  # noqa: B018 - public names load when first used
    imported = time.perf_counter() - started
    arm, path = smooth_path(n, seed=1)
    began = time.perf_counter()
    first = ak.solve(arm, path, search=search)
    first_answer = time.perf_counter() - began
    best = first_answer
    for _ in range(repeats):
        began = time.perf_counter()
        ak.solve(arm, path, search=search)
        best = min(best, time.perf_counter() - began)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    arm, other = smooth_path(n * 3 // 2 if n <= 10_000 else 1_000, seed=2)
    second = ak.solve(arm, other, search=search)
    plain, lanes = kinematics_times(arm)
    print(
        json.dumps(
            {
                "import": imported,
                "compile": first.timing.compile,
                "first": first_answer,
                "best": best,
                "iterations": first.iterations,
                "cost": first.cost,
                "ok": first.ok and second.ok,
                "memory_GB": peak,
                "second_compile": second.timing.compile,
                "plain": plain,
                "lanes": lanes,
                **(parts(arm, path) if search == "auto" else {}),
            }
        )
    )


def parts(arm, path) -> dict[str, float]:
    """Where the time goes: the map, the global search, the polish; the fastest of three."""
    import numpy as np

    from armik_sym.swivel.map import swivel_map
    from armik_sym.symbolic import Orientation
    from armik_sym.trajectory.by_swivel import outlines, polished, settled
    from armik_sym.trajectory.options import TrajectoryOptions
    from armik_sym.trajectory.request import Request
    from armik_sym.trajectory.swivel_method import swivel_problem

    limits = np.full(arm.dof, 10.0), np.full(arm.dof, np.inf)
    request = Request(arm, path, Orientation.FULL, TrajectoryOptions(), *limits, None, 0, "auto", None)
    times = []
    for _ in range(3):
        clock = [time.perf_counter()]
        problem = swivel_problem(request, swivel_map(arm, path), None)
        clock.append(time.perf_counter())
        found = outlines(problem)
        clock.append(time.perf_counter())
        polished(problem, settled(problem, found[0]))
        clock.append(time.perf_counter())
        times.append(np.diff(clock))
    return dict(zip(("map", "search", "polish"), np.min(times, axis=0).tolist(), strict=True))


def run(n: int, cache: str, search: str = "auto", repeats: int = 0) -> dict[str, float]:
    """One measurement in a process of its own; `process` is its wall time without the second path."""
    environment = {**os.environ, "ARMIK_CACHE_DIR": cache}
    arguments = ["--measure", str(n), "--search", search, "--repeats", str(repeats)]
    done = subprocess.run(
        [sys.executable, __file__, *arguments],
        capture_output=True, text=True, check=True, env=environment,
    )  # fmt: skip
    return dict(json.loads(done.stdout.splitlines()[-1]))


def command_time(cache: str) -> float:
    """Wall time of `armik solve` for a file of 500 samples, the second time."""
    from armik_sym.motion.path_csv import write_path

    arm, path = smooth_path(500, seed=1)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "path.csv"
        write_path(file, path)
        command = [sys.executable, "-m", "armik_sym", "solve", str(file), "--arm", arm.name]
        times = []
        for _ in range(3):
            began = time.perf_counter()
            subprocess.run(
                [*command, "--out", folder],
                check=True,
                capture_output=True,
                env={**os.environ, "ARMIK_CACHE_DIR": cache},
            )
            times.append(time.perf_counter() - began)
    return min(times[1:])


def main(lengths: tuple[int, ...]) -> int:
    """Print the tables."""
    verdicts: list[tuple[str, bool]] = []
    print(
        "swivel map     first answer [s]            warm [ms]                               "
        " FK + J          memory\n"
        "  samples    cold (compile)   warm    map  search  polish  ak.solve  µs/pose  "
        "plain lanes  steps    [GB]"
    )
    best: dict[int, float] = {}
    with tempfile.TemporaryDirectory() as cache:
        for n in lengths:
            with tempfile.TemporaryDirectory() as empty:
                cold = run(n, empty)
            run(100, cache)
            warm = run(n, cache, repeats=max(1, min(20, 20_000 // n)))
            best[n] = warm["best"]
            multiple, lanes = (warm["best"] / n / warm[name] for name in ("plain", "lanes"))
            print(
                f"{n:9d}  {cold['import'] + cold['first']:6.2f} ({cold['compile']:5.2f}) "
                f"{warm['import'] + warm['first']:8.2f}  "
                f"{1e3 * warm['map']:5.0f}  {1e3 * warm['search']:6.0f}  {1e3 * warm['polish']:6.0f}  "
                f"{1e3 * warm['best']:8.0f}  {1e6 * warm['best'] / n:7.1f}  {multiple:5.0f} {lanes:5.0f}  "
                f"{warm['iterations']:5.0f}  {warm['memory_GB']:6.2f}"
            )
            good = bool(cold["ok"] and warm["ok"])
            verdicts.append((f"{n} samples: solution ok, nothing compiled for another length",
                             good and warm["second_compile"] == 0))  # fmt: skip
            verdicts.append((f"{n} samples: at most {AIM_MEMORY:g} GB", warm["memory_GB"] <= AIM_MEMORY))
            if n == 1_000:
                verdicts.append((f"1,000 poses in at most {1e3 * AIM_1000:g} ms", warm["best"] <= AIM_1000))
                verdicts.append((f"at most {AIM_MULTIPLE} FK + J per pose", multiple <= AIM_MULTIPLE))
                first = cold["import"] + cold["first"]
                verdicts.append((f"first answer, cache empty, within {AIM_COLD:g} s", first <= AIM_COLD))
        print("\nfull space (every joint angle a variable), the same paths, warm")
        for n in (n for n in FULL_SPACE if n in lengths):
            run(100, cache, "full-space")
            m = run(n, cache, "full-space")
            print(
                f"{n:9d}  {1e3 * m['first']:8.0f} ms  {m['first'] / best[n]:6.1f} x the swivel map's  "
                f"{m['iterations']:4.0f} iterations  {m['memory_GB']:.2f} GB"
            )
        seconds = command_time(cache)
        print(f"\n`armik solve` of 500 samples, cache filled: {seconds:.2f} s wall")
        verdicts.append((f"`armik solve` of 500 samples within {AIM_COMMAND:g} s", seconds <= AIM_COMMAND))
    for (a, ta), (b, tb) in itertools.pairwise(best.items()):
        print(f"{b} samples take {tb / ta:.1f} x the time of {a}")
    if 10_000 in best:
        limit = AIM_GROWTH * AIM_1000
        verdicts.append((f"10,000 poses in at most {1e3 * limit:g} ms, {AIM_GROWTH} x the aim for 1,000",
                         best[10_000] <= limit))  # fmt: skip
    print()
    for words, good in verdicts:
        print(f"{'as it should be' if good else 'NOT as it should be'}: {words}")
    return 0 if all(good for _, good in verdicts) else 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--measure", type=int, help="internal: measure one length in this process")
    parser.add_argument("--search", default="auto", help="internal: which search is measured")
    parser.add_argument("--repeats", type=int, default=0, help="internal: further solves of the same path")
    parser.add_argument("--lengths", type=int, nargs="+", default=list(LENGTHS))
    arguments = parser.parse_args()
    if arguments.measure:
        measure(arguments.measure, arguments.search, arguments.repeats)
    else:
        sys.exit(main(tuple(arguments.lengths)))
