"""ISADE and Pro-ISADE on the five tasks of Nguyen 2021: generations, misses, time per point and evaluation.

    python benchmarks/isade.py             the default options, with position and with pose
    python benchmarks/isade.py --choose    the experiment that chose them

Every time per cost evaluation is divided by that of one forward kinematics (position, generated C, plain
loop over different postures) measured just before and after, on the same core.
"""

from __future__ import annotations

import argparse
import ctypes
import dataclasses
import statistics
import time

import numpy as np

import armik_sym as ak
from armik_sym.arm import Arm
from armik_sym.compiled.backend import build_or_none
from armik_sym.pointwise.differential_evolution import IsadeOptions, PathJob, ProIsadeOptions, run_many
from armik_sym.pointwise.differential_evolution.compiled_search import CompiledSearch
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_functions, pointwise_source
from armik_sym.symbolic import Orientation

FILES = (
    "real_math.h", "random_stream.h", "isade_settings.h", "isade_cost.h", "isade_generation.h", "isade.h"
)  # fmt: skip
POSTURES = 2_000
PAPER = dict(zip(ak.task_names(), (27.7, 41.4, 26.7, 34.9, 31.2), strict=True))  # Table 6, generations

ONE_FK = """
EXPORT double one_fk(ptrdiff_t n, const real *q, const real *lengths) {
  real out[3], sum = 0;
  for (ptrdiff_t i = 0; i < n; ++i) {
    armik_position(q + i * DOF, lengths, out);
    sum += out[0] + out[1] + out[2];
  }
  return sum;
}
"""


@dataclasses.dataclass
class Row:
    """What one task (or all) took."""

    misses: int = 0
    generations: list[float] = dataclasses.field(default_factory=list)
    times: list[float] = dataclasses.field(default_factory=list)
    per_evaluation: list[float] = dataclasses.field(default_factory=list)
    ratios: list[float] = dataclasses.field(default_factory=list)
    largest_step: float = 0.0

    def add(self, other: Row) -> None:
        """Take in what another one saw."""
        self.misses += other.misses
        self.largest_step = max(self.largest_step, other.largest_step)
        for name in ("generations", "times", "per_evaluation", "ratios"):
            getattr(self, name).extend(getattr(other, name))

    def text(self) -> str:
        """The columns under HEAD."""
        return (
            f"{self.misses:6d} of {len(self.generations):6d} {statistics.mean(self.generations):8.1f} "
            f"{max(self.generations):5.0f} {1e3 * statistics.median(self.times):9.3f} "
            f"{1e9 * statistics.median(self.per_evaluation):9.1f} {statistics.median(self.ratios):9.2f} "
            f"{np.rad2deg(self.largest_step):9.2f}"
        )


HEAD = (
    f"{'':34} {'missed':>16} {'gen.':>8} {'max':>5} {'ms/point':>9} {'ns/eval.':>9} {'eval./FK':>9} "
    f"{'step [°]':>9}"
)


class Bench:
    """The five tasks on one arm."""

    def __init__(self, dof: int, orientation: Orientation) -> None:
        self.arm: Arm = ak.catalog.ehmcs(dof=dof)
        source = pointwise_source(pointwise_functions(self.arm), dof, loops=FILES)
        library = build_or_none(source + ONE_FK, "c")
        if library is None:
            raise SystemExit("needs a C compiler")
        self.library = PointwiseLibrary(library)
        kin = ak.compile(self.arm)
        self.motions = {
            name: np.ascontiguousarray(ak.load_task(name).measured.q[:, :dof]) for name in ak.task_names()
        }
        self.targets = {
            name: HandTargets(orientation, np.hstack([kin.position(q), kin.rotation(q).reshape(-1, 9)]))
            for name, q in self.motions.items()
        }
        rom = self.arm.rom
        self._postures = np.random.default_rng(0).uniform(rom.lower, rom.upper, (POSTURES, dof))

    def fk(self) -> float:
        """Seconds for one position."""
        call = self.library.library.handle.one_fk
        call.restype = ctypes.c_double
        call.argtypes = [ctypes.c_ssize_t, *[ctypes.c_void_p] * 2]
        lengths = self.arm.length_values
        seconds = []
        for _ in range(5):
            began = time.perf_counter()
            call(POSTURES, self._postures.ctypes.data, lengths.ctypes.data)
            seconds.append(time.perf_counter() - began)
        return statistics.median(seconds) / POSTURES

    def follow(self, task: str, options: IsadeOptions, seed: int) -> Row:
        """One path, timed point by point."""
        targets, motion = self.targets[task], self.motions[task]
        search = CompiledSearch(self.library.library, self.arm, options, options.measure_for(targets))
        row, previous = Row(), motion[0].copy()
        before, q = self.fk(), []
        for k in range(len(targets)):
            pose = targets.pose[k : k + 1]
            began = time.perf_counter()
            posture, error, generations, count = search.samples(k, pose, previous, seed)
            row.times.append(time.perf_counter() - began)
            row.misses += int(not error[0] < options.stop)
            row.generations.append(float(generations[0]))
            row.per_evaluation.append(row.times[-1] / int(count[0]))
            q.append(posture[0])
        fk = statistics.mean([before, self.fk()])
        row.ratios.append(statistics.median(row.per_evaluation) / fk)
        row.largest_step = float(np.abs(np.diff(q, axis=0)).max())
        return row

    def all_tasks(self, options: IsadeOptions, seeds: range) -> Row:
        """All tasks with several seeds."""
        total = Row()
        for task in self.motions:
            for seed in seeds:
                total.add(self.follow(task, options, seed))
        return total


def show_defaults(repeats: int) -> None:
    pro = ProIsadeOptions()
    cosines = dataclasses.replace(pro, rotation_measure="cosines")
    cases = (
        (5, Orientation.NONE, pro, "Pro-ISADE, position"),
        (
            5,
            Orientation.NONE,
            dataclasses.replace(pro, stall=0.0),
            "Pro-ISADE as published (stall = 0), position",
        ),
        (
            5,
            Orientation.NONE,
            dataclasses.replace(pro, moving_window=True),
            "Pro-ISADE, the window moves after a stall",
        ),
        (5, Orientation.NONE, IsadeOptions(), "ISADE, position"),
        (7, Orientation.FULL, pro, "Pro-ISADE, pose"),
        (7, Orientation.FULL, cosines, "Pro-ISADE, position and direction cosines"),
    )
    for dof, orientation, options, title in cases:
        bench = Bench(dof, orientation)
        population = options.population_for(options.measure_for(next(iter(bench.targets.values()))))
        print(f"\n{title}, {dof} joints, NP = {population}, {repeats} seeds")
        print(HEAD)
        for task in bench.motions:
            row = Row()
            for seed in range(repeats):
                row.add(bench.follow(task, options, seed))
            print(f"{task:20} (paper: {PAPER[task]:4.1f}) {row.text()}")
    show_threads(repeats)


def show_threads(repeats: int) -> None:
    bench = Bench(5, Orientation.NONE)
    jobs = [
        PathJob(targets, bench.motions[task][0], seed)
        for task, targets in bench.targets.items()
        for seed in range(4 * repeats)
    ]
    seconds = []
    for threads in (1, 2):
        began = time.perf_counter()
        run_many(bench.arm, jobs, ProIsadeOptions(), library=bench.library, threads=threads)
        seconds.append(time.perf_counter() - began)
    print(f"\n{len(jobs)} paths: {seconds[0]:.2f} s with 1 thread, {seconds[1]:.2f} s with 2")


def show_choice(repeats: int) -> None:
    """One option at a time around the defaults, then the population."""
    default, bench = ProIsadeOptions(), Bench(5, Orientation.NONE)
    alternatives: dict[str, tuple[object, ...]] = {
        "population": (20, 30, 40, 50, 60, 80, 100),
        "stall": (0.0, 0.05, 0.5, 1.0, 2.0, 4.0, 8.0),
        "repair": ("clip", "reflect", "random", "midpoint"),
        "alpha": (1.0, 2.0, 4.0, 6.0, 8.0, 12.0),
        "f_min": (0.0, 0.1, 0.2, 0.3, 0.4),
        "f_max": (0.4, 0.5, 0.6, 0.8, 1.0),
        "n_iter": (0.5, 1.0, 2.0, 3.0),
        "sign": ("printed", "original"),
    }
    print(f"Pro-ISADE, position, 5 joints, all five tasks, {repeats} seeds, one option changed at a time")
    print(HEAD)
    for name, values in alternatives.items():
        for value in values:
            options = dataclasses.replace(default, **{name: value})
            mark = "  default" if value == (getattr(default, name) or 50) else ""
            print(f"{name + ' = ' + str(value) + mark:34} {bench.all_tasks(options, range(repeats)).text()}")
    show_population_for_pose(max(1, repeats // 5))
    show_travel_weight(bench)


def show_population_for_pose(repeats: int) -> None:
    bench = Bench(7, Orientation.FULL)
    print(f"\nPro-ISADE, pose, 7 joints, all five tasks, {repeats} seeds")
    print(HEAD)
    for population in (50, 75, 100, 150, 200):
        for iter_max in (150, 600):
            options = ProIsadeOptions(population=population, iter_max=iter_max)
            title = f"population = {population}, iter_max = {iter_max}"
            print(f"{title:34} {bench.all_tasks(options, range(repeats)).text()}")


def show_travel_weight(bench: Bench, cases: int = 100) -> None:
    """A start off the path: how far is the answer, against the least possible to first order?"""
    print(f"\ntravel weight a: first sample, start up to 0.05 rad per joint off, {cases} random postures")
    kin, rom = ak.compile(bench.arm), bench.arm.rom
    rng = np.random.default_rng(0)
    middle, half = rom.middle, 0.35 * rom.width
    wanted = rng.uniform(middle - half, middle + half, (cases, bench.arm.dof))
    starts = wanted + rng.uniform(-0.05, 0.05, wanted.shape)
    pose = np.hstack([kin.position(wanted), np.zeros((cases, 9))])
    for a in (0.0, 0.001, 0.01, 0.03, 0.1, 1.0):
        options = ProIsadeOptions(travel_weight=a)
        jobs = [
            PathJob(HandTargets(Orientation.NONE, np.ascontiguousarray(p[None])), q, k)
            for k, (p, q) in enumerate(zip(pose, starts, strict=True))
        ]
        done = run_many(bench.arm, jobs, options, library=bench.library)
        reached = sum(int(out.reached[0]) for out in done)
        excess = []
        for out, start in zip(done, starts, strict=True):
            J = kin.jacobian(out.q[0])[:3]
            step = out.q[0] - start
            excess.append(np.linalg.norm(step) / np.linalg.norm(np.linalg.pinv(J) @ (J @ step)))
        print(
            f"a = {a:5.3f} m/rad: {reached} reached, travel / least travel: median {np.median(excess):.3f}, "
            f"90 % {np.quantile(excess, 0.9):.3f}, generations {np.mean([o.iterations[0] for o in done]):.0f}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--choose", action="store_true", help="the experiment that chose the defaults")
    parser.add_argument("--seeds", type=int, default=5, help="repetitions of every task")
    arguments = parser.parse_args()
    (show_choice if arguments.choose else show_defaults)(arguments.seeds)


if __name__ == "__main__":
    main()
