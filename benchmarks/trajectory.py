"""Whole-trajectory solves of 100, 1,000 and 10,000 samples: time, iterations, memory.

    python benchmarks/trajectory.py

Each length runs in its own process with an empty cache (cold), then again (warm: the cache is filled),
and within the warm process a second path of another length follows, which must compile nothing.
Timings are of this machine and this moment: compare the ratios.
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

LENGTHS = (100, 1_000, 10_000)


def smooth_path(n: int, seed: int):
    """A smooth hand path of n samples at 100 Hz from random joint motions inside the range of motion."""
    import numpy as np

    import armik_sym as ak
    from armik_sym.arm.product_of_transforms import hand_pose

    arm = ak.catalog.ehmcs()
    rng = np.random.default_rng(seed)
    t = np.arange(n) / 100.0
    waves = np.zeros((n, arm.dof))
    for harmonic in range(1, 4):
        phase = rng.uniform(0, 2 * np.pi, arm.dof)
        frequency = harmonic * 0.15 * rng.uniform(0.8, 1.2, arm.dof)
        waves += np.sin(2 * np.pi * frequency * t[:, None] + phase) / harmonic
    q = arm.rom.middle + 0.2 * np.minimum(arm.rom.width, 2.0) * waves
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    return arm, ak.HandPath(t, position, rotation)


def measure(n: int) -> None:
    """Solve one path, then another of another length; print what was measured as one line of JSON."""
    started = time.perf_counter()
    import armik_sym as ak

    ak.solve  # noqa: B018 - public names load when first used
    imported = time.perf_counter() - started
    arm, path = smooth_path(n, seed=1)
    first = ak.solve(arm, path)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    arm, path = smooth_path(n * 3 // 2, seed=2)
    second = ak.solve(arm, path)
    print(
        json.dumps(
            {
                "import": imported,
                "build": first.timing.build,
                "compile": first.timing.compile,
                "solve": first.timing.solve,
                "iterations": first.iterations,
                "ok": first.ok and second.ok,
                "memory_GB": peak,
                "second_compile": second.timing.compile,
            }
        )
    )


def run(n: int, cache: str) -> dict[str, float]:
    """One measurement in a process of its own."""
    environment = {**os.environ, "ARMIK_CACHE_DIR": cache}
    done = subprocess.run(
        [sys.executable, __file__, "--measure", str(n)],
        capture_output=True, text=True, check=True, env=environment,
    )  # fmt: skip
    return dict(json.loads(done.stdout.splitlines()[-1]))


def main(lengths: tuple[int, ...]) -> int:
    """Print the table."""
    print(
        "  samples  cache  import [s]  build [s]  compile [s]  solve [s]  µs/sample  iterations  memory [GB]"
    )
    solve_times: list[float] = []
    good = True
    for n in lengths:
        with tempfile.TemporaryDirectory() as cache:
            Path(cache).chmod(0o700)
            for label in ("cold", "warm"):
                m = run(n, cache)
                print(
                    f"{n:9d}  {label:5s}  {m['import']:10.2f}  {m['build']:9.3f}  {m['compile']:11.2f}  "
                    f"{m['solve']:9.3f}  {1e6 * m['solve'] / n:9.0f}  {m['iterations']:10.0f}  "
                    f"{m['memory_GB']:11.2f}"
                )
                good = good and bool(m["ok"]) and m["second_compile"] == 0 and m["memory_GB"] < 2
            solve_times.append(m["solve"])
    for (a, ta), (b, tb) in itertools.pairwise(zip(lengths, solve_times, strict=True)):
        print(f"solve time grows {tb / ta:.1f} × from {a} to {b} samples (aim: at most 12 × per 10 ×)")
        good = good and tb / ta <= 12 * (b / a) / 10
    print(
        "all solutions ok, nothing compiled for the second path, time and memory as they should be"
        if good
        else "NOT all as it should be"
    )
    return 0 if good else 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--measure", type=int, help="internal: measure one length in this process")
    parser.add_argument("--lengths", type=int, nargs="+", default=list(LENGTHS))
    arguments = parser.parse_args()
    if arguments.measure:
        measure(arguments.measure)
    else:
        sys.exit(main(tuple(arguments.lengths)))
