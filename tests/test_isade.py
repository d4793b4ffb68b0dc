"""ISADE and Pro-ISADE: on the path, inside window and limits, repeatable, and the same in C and NumPy."""

from __future__ import annotations

import dataclasses
import functools
import subprocess

import numpy as np
import pytest
from compiled_helpers import CC, needs_cc
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import ARMS, postures

import armik_sym as ak
from armik_sym.compiled.backend import build_or_none
from armik_sym.errors import OptionError
from armik_sym.pointwise.differential_evolution import (
    IsadeOptions,
    PathJob,
    ProIsadeOptions,
    run,
    run_isade,
    run_many,
)
from armik_sym.pointwise.differential_evolution.compiled_search import isade_settings
from armik_sym.pointwise.differential_evolution.generation import (
    factors_by_rank,
    mean_factor,
    partners,
    scale_factors,
)
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_functions, pointwise_source
from armik_sym.pointwise.random_stream import random_bits
from armik_sym.symbolic import Orientation

FILES = (
    "real_math.h", "random_stream.h", "isade_settings.h", "isade_cost.h", "isade_generation.h", "isade.h"
)  # fmt: skip
NUMPY = PointwiseLibrary(None, 0.0)
WINDOW = np.pi / 100
SEEDS = st.integers(0, 10**6)
BOTH = pytest.mark.parametrize("library_of", ["compiled", "numpy"])


def c_source(arm):
    functions = pointwise_functions(arm)
    used = {name: functions[name] for name in ("position", "pose")}
    return pointwise_source(used, arm.dof, loops=FILES)


@functools.cache
def compiled(name):
    library = build_or_none(c_source(ARMS[name]), "auto")
    if library is None:
        pytest.skip("no C compiler")
    return PointwiseLibrary(library, 0.0)


def library(kind, name):
    return compiled(name) if kind == "compiled" else NUMPY


NAME = "ehmcs_5dof"
ARM = ARMS[NAME]


def targets_of(arm, q, orientation=Orientation.NONE):
    kin = ak.compile(arm)
    rotation = kin.rotation(q).reshape(-1, 9)
    if orientation is Orientation.NONE:
        rotation = np.broadcast_to(np.eye(3).ravel(), rotation.shape)
    return HandTargets(orientation, np.ascontiguousarray(np.hstack([kin.position(q), rotation])))


def gentle(arm, n, seed=0, step=0.01):
    """Postures along a straight line in joint space, each joint moving up to `step` per sample."""
    rng = np.random.default_rng(seed)
    first = postures(arm, 1, seed, stretch=0.6)[0]
    return first + np.arange(n)[:, None] * rng.uniform(-step, step, arm.dof)


def inside(arm, q):
    return bool(np.all(q >= arm.rom.lower) and np.all(q <= arm.rom.upper))


def same(a, b):
    return np.array_equal(a.q, b.q) and np.array_equal(a.iterations, b.iterations)


@pytest.mark.parametrize("task", ak.task_names())
def test_reaches_every_point_of_the_tasks(task):
    q = np.ascontiguousarray(ak.load_task(task).measured.q[:, :5])
    out = run_isade(ARM, targets_of(ARM, q), ProIsadeOptions(), start=q[0], library=library("compiled", NAME))
    assert out.reached.all()
    error = np.linalg.norm(ak.compile(ARM).position(out.q) - targets_of(ARM, q).pose[:, :3], axis=1)
    assert error.max() < 1e-8
    assert out.iterations.max() <= 150
    assert 18 <= out.iterations.mean() <= 63
    assert inside(ARM, out.q)
    np.testing.assert_allclose(out.q[0], q[0], atol=1e-6)


@BOTH
@pytest.mark.parametrize("dof", [4, 5, 7])
def test_position_is_reached_with_four_five_and_seven_joints(dof, library_of):
    name = {4: "ehmcs_4dof", 5: "ehmcs_5dof", 7: "ehmcs"}[dof]
    arm = ARMS[name]
    q = gentle(arm, 5)
    out = run_isade(arm, targets_of(arm, q), ProIsadeOptions(), start=q[0], library=library(library_of, name))
    assert out.reached.all()
    assert np.abs(np.diff(out.q, axis=0)).max() <= WINDOW


@pytest.mark.parametrize("options", [ProIsadeOptions(), ProIsadeOptions(rotation_measure="cosines")])
def test_rotation_is_reached(options):
    arm, name = ARMS["ehmcs"], "ehmcs"
    q = gentle(arm, 8, seed=3)
    targets = targets_of(arm, q, Orientation.FULL)
    options = dataclasses.replace(options, iter_max=600)
    out = run_isade(arm, targets, options, start=q[0], library=library("compiled", name))
    assert out.reached.all()
    R = ak.compile(arm).rotation(out.q).reshape(-1, 9)
    tracked = slice(None) if options.rotation_measure == "chordal" else slice(None, None, 4)
    assert np.abs(R - targets.pose[:, 3:])[:, tracked].max() < 1e-7


@settings(max_examples=25)
@given(seed=SEEDS, repair=st.sampled_from(["clip", "reflect", "random", "midpoint"]), cut=st.booleans())
def test_window_and_limits_are_never_left(seed, repair, cut):
    arm = ARM
    q = gentle(arm, 6, seed, step=0.06)
    q = np.clip(q, arm.rom.lower, arm.rom.upper)
    if cut:  # a limit runs right through the windows
        arm = arm.with_rom(np.minimum(q[0], arm.rom.lower), np.maximum(q[0] + 0.01, q[0]))
    options = ProIsadeOptions(repair=repair, iter_max=20)
    out = run_isade(
        arm, targets_of(ARM, q), options, start=q[0], seed=seed, library=library("compiled", NAME)
    )
    assert inside(arm, out.q)
    assert np.abs(np.diff(out.q, axis=0)).max() <= WINDOW


def test_a_fast_path_is_left_behind_unless_the_window_moves():
    q = gentle(ARM, 10, seed=5, step=0.0)
    q[:, 3] = 0.5 + 0.05 * np.arange(10)  # the elbow alone sets the distance from the shoulder
    behind, follows = (
        run_isade(
            ARM,
            targets_of(ARM, q),
            ProIsadeOptions(moving_window=moving),
            start=q[0],
            library=library("compiled", NAME),
        )
        for moving in (False, True)
    )
    assert not behind.reached[1:].any()
    assert np.abs(np.diff(behind.q, axis=0)).max() <= WINDOW
    assert follows.reached.all()
    assert follows.iterations.max() <= 150


def test_isade_jumps_where_pro_isade_does_not():
    q = gentle(ARM, 12, seed=1)
    steps = []
    for options in (IsadeOptions(), ProIsadeOptions()):
        out = run_isade(ARM, targets_of(ARM, q), options, start=q[0], library=library("compiled", NAME))
        assert out.reached.mean() > 0.8
        assert inside(ARM, out.q)
        steps.append(np.abs(np.diff(out.q, axis=0)).max())
    assert steps[0] > 10 * WINDOW > 10 * steps[1] / 1.01


@BOTH
def test_a_start_off_the_path_is_left_by_the_shortest_way(library_of):
    q = gentle(ARM, 2, seed=2)
    start = np.clip(q[0] + 0.05, ARM.rom.lower, ARM.rom.upper)
    out = run_isade(
        ARM, targets_of(ARM, q), ProIsadeOptions(), start=start, library=library(library_of, NAME)
    )
    assert out.reached.all()
    # The motion across the path is the least: within a fifth of the pseudo-inverse step.
    J = ak.compile(ARM).jacobian(out.q[0])[:3]
    least = np.linalg.norm(np.linalg.pinv(J) @ J @ (out.q[0] - start))
    assert np.linalg.norm(out.q[0] - start) < 1.2 * least


@BOTH
def test_without_a_start_the_search_begins_in_the_middle(library_of):
    q = gentle(ARM, 2, seed=4)
    out = run_isade(ARM, targets_of(ARM, q), ProIsadeOptions(), library=library(library_of, NAME))
    assert out.reached.all()


@BOTH
@pytest.mark.parametrize("options", [ProIsadeOptions(iter_max=30), IsadeOptions(iter_max=30)])
def test_what_cannot_be_reached_is_not_reached_and_ends(options, library_of):
    q = gentle(ARM, 3)
    pose = targets_of(ARM, q).pose.copy()
    pose[:, 0] += 5.0
    out = run_isade(
        ARM, HandTargets(Orientation.NONE, pose), options, start=q[0], library=library(library_of, NAME)
    )
    assert not out.reached.any()
    assert np.isfinite(out.q).all()
    assert inside(ARM, out.q)
    assert out.iterations.tolist() == [60, 30, 30]


@BOTH
@pytest.mark.parametrize("nonsense", [np.nan, np.inf, 1e200])
def test_targets_that_make_no_sense_are_not_reached(nonsense, library_of):
    q = gentle(ARM, 3)
    pose = targets_of(ARM, q).pose.copy()
    pose[1] = nonsense
    out = run_isade(
        ARM,
        HandTargets(Orientation.NONE, pose),
        ProIsadeOptions(),
        start=q[0],
        library=library(library_of, NAME),
    )
    assert out.reached.tolist() == [True, False, True]
    assert inside(ARM, out.q)


def test_joints_that_cannot_move():
    q = gentle(ARM, 3)
    arm = ARM.with_rom(q[0], q[0])
    out = run_isade(arm, targets_of(ARM, q), ProIsadeOptions(), start=q[0], library=library("compiled", NAME))
    assert out.reached.tolist() == [True, False, False]
    assert np.array_equal(out.q, np.broadcast_to(q[0], out.q.shape))


@BOTH
def test_one_seed_one_answer_whatever_the_block(library_of, monkeypatch):
    q = gentle(ARM, 7)
    answers = []
    for block in (32, 3, 1):
        monkeypatch.setattr(run, "BLOCK", block)
        done = []
        answers.append(
            run_isade(
                ARM,
                targets_of(ARM, q),
                ProIsadeOptions(iter_max=20),
                start=q[0],
                seed=11,
                library=library(library_of, NAME),
                progress=lambda p, done=done: done.append(p.iteration),
            )
        )
        assert done[-1] == 7
    assert all(same(answers[0], other) for other in answers[1:])
    other = run_isade(
        ARM,
        targets_of(ARM, q),
        ProIsadeOptions(iter_max=20),
        start=q[0],
        seed=12,
        library=library(library_of, NAME),
    )
    assert not np.array_equal(answers[0].q, other.q)


@pytest.mark.parametrize(
    ("choice", "samples"), [({}, 32), ({"population": 3000}, 1), ({"iter_max": 10**4, "population": 20}, 9)]
)
def test_a_call_into_c_is_short_whatever_the_options(choice, samples):
    q = np.repeat(gentle(ARM, 1), 40, axis=0)  # reached at once: how long it might take counts
    ends = []
    run_isade(
        ARM,
        targets_of(ARM, q),
        ProIsadeOptions(stop=1.0, **choice),
        start=q[0],
        library=library("compiled", NAME),
        progress=lambda p: ends.append(p.iteration),
    )
    assert ends[0] == samples
    assert np.diff([0, *ends]).max() == samples


@BOTH
def test_the_window_holds_to_the_last_bit(library_of):
    q = gentle(ARM, 30, seed=5, step=0.0)
    q[:, 3] = 0.5 + 0.05 * np.arange(30)  # too fast, so the elbow runs into the ends of its windows
    for window in (WINDOW, 0.01, 1e-3):
        options = ProIsadeOptions(iter_max=20, window=window)
        out = run_isade(ARM, targets_of(ARM, q), options, start=q[0], library=library(library_of, NAME))
        assert window * (1 - 1e-12) <= np.abs(np.diff(out.q, axis=0)).max() <= window


@BOTH
def test_any_number_of_threads_gives_the_same(library_of):
    q = gentle(ARM, 4)
    jobs = [PathJob(targets_of(ARM, q), q[0], seed) for seed in range(6)]
    options = ProIsadeOptions(iter_max=15)
    one, two, eight = (
        run_many(ARM, jobs, options, library=library(library_of, NAME), threads=n) for n in (1, 2, 8)
    )
    alone = [
        run_isade(
            ARM, job.targets, options, start=job.start, seed=job.seed, library=library(library_of, NAME)
        )
        for job in jobs
    ]
    assert all(
        same(a, b) and same(a, c) and same(a, d) for a, b, c, d in zip(one, two, eight, alone, strict=True)
    )
    assert not np.array_equal(one[0].q, one[1].q)
    with pytest.raises(OptionError, match="threads"):
        run_many(ARM, jobs, options, library=NUMPY, threads=0)


CASES = [
    ({}, Orientation.NONE),
    ({"repair": "reflect"}, Orientation.NONE),
    ({"repair": "random", "sign": "original"}, Orientation.FULL),
    ({"repair": "midpoint", "population": 5}, Orientation.NONE),
    ({"rotation_measure": "cosines", "n_iter": 2.0, "tau": 0.5}, Orientation.FULL),
    ({"travel_weight": 0.0, "stall": 50.0}, Orientation.NONE),
]


@pytest.mark.parametrize(("choice", "orientation"), CASES)
@pytest.mark.parametrize("family", [ProIsadeOptions, IsadeOptions])
@pytest.mark.parametrize("with_start", [True, False])
def test_c_and_numpy_agree_generation_by_generation(choice, orientation, family, with_start):
    for name in (NAME, "ehmcs"):
        arm = ARMS[name]
        q = gentle(arm, 2, seed=8)
        targets, start = targets_of(arm, q, orientation), q[0] if with_start else None
        for iter_max in (1, 2, 3, 5):
            options = family(iter_max=iter_max, **choice)
            c, numpy = (
                run_isade(arm, targets, options, start=start, seed=21, library=found)
                for found in (library("compiled", name), NUMPY)
            )
            np.testing.assert_allclose(c.q, numpy.q, rtol=0, atol=1e-12)
            assert np.array_equal(c.iterations, numpy.iterations)
            assert c.evaluations == numpy.evaluations


RUNS = 1_000


def test_c_and_numpy_agree_in_distribution():
    q = gentle(ARM, 2, seed=8)
    q[0] = q[1]
    options = ProIsadeOptions(population=20, stop=3e-3)
    start = q[1] - 0.01  # a thousand different runs of one sample that is a few generations away
    counts = np.array(
        [
            [
                out.iterations[0]
                for out in run_many(
                    ARM,
                    [PathJob(targets_of(ARM, q[:1]), start, seed) for seed in range(offset, offset + RUNS)],
                    options,
                    library=found,
                )
            ]
            for offset, found in ((0, library("compiled", NAME)), (RUNS, NUMPY))
        ]
    )
    spread = counts.std(axis=1).mean()
    assert spread > 0
    assert abs(np.diff(counts.mean(axis=1))[0]) < 4 * spread * np.sqrt(2 / RUNS)


@given(population=st.integers(5, 60), key=st.integers(0, 2**64 - 1))
def test_partners_differ_from_each_other_and_from_the_individual(population, key):
    words = random_bits(key, np.arange(2 * population)).reshape(population, 2)
    rows = np.column_stack([np.arange(population), partners(words, population)])
    assert rows.min() >= 0
    assert rows.max() < population
    assert all(len(set(row)) == 5 for row in rows.tolist())


def test_partners_are_drawn_evenly():
    n, repeats = 6, 4000
    count = np.zeros((4, n))
    for k in range(repeats):
        rows = partners(random_bits(k, np.arange(2 * n)).reshape(n, 2), n)
        for j in range(4):
            count[j, rows[2, j]] += 1
    assert (count[:, 2] == 0).all()
    others = np.delete(count, 2, axis=1)
    assert np.abs(others - repeats / 5).max() < 5 * np.sqrt(repeats / 5)


def test_scale_factors_as_printed_and_as_asked_for():
    by_rank = factors_by_rank(50, 4.0)
    assert np.all(np.diff(by_rank) < 0)
    assert by_rank[24] == pytest.approx(0.5)
    cost = np.arange(50.0)[::-1]
    printed, original = ProIsadeOptions(), ProIsadeOptions(sign="original")
    assert mean_factor(printed, 150) == printed.f_min
    assert mean_factor(printed, 75) == pytest.approx(0.45)
    for iteration, grows in ((1, 150), (40, 90)):
        early, late = (scale_factors(printed, cost, by_rank, t) for t in (iteration, grows))
        assert np.all(late > early)
        early, late = (scale_factors(original, cost, by_rank, t) for t in (iteration, grows))
        assert np.all(late < early)
        assert np.all(late > 0)
    best = scale_factors(printed, cost, by_rank, 10)
    assert np.argmax(best) == 49
    equal = scale_factors(printed, np.ones(50), by_rank, 10)
    assert np.ptp(equal) == 0


def test_the_sign_of_eq_14_decides_how_long_it_takes():
    q = gentle(ARM, 12)
    printed, original = (
        run_isade(
            ARM,
            targets_of(ARM, q),
            ProIsadeOptions(sign=sign, iter_max=400),
            start=q[0],
            library=library("compiled", NAME),
        ).iterations[1:]
        for sign in ("printed", "original")
    )
    assert 1.5 * np.mean(printed) < np.mean(original)


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ({"population": 4}, "population is 4, expected a whole number ≥ 5"),
        ({"population": 50.0}, "population"),
        ({"population": 10**7}, "population"),
        ({"iter_max": 0}, "iter_max"),
        ({"iter_max": 10**9}, "iter_max"),
        ({"iter_max": 10**5}, "iter_max is 100000 with population 150: expected population · iter_max"),
        ({"iter_max": 100, "population": 10**4}, "iter_max is 100 with population 10000"),
        ({"stop": 0.0}, "stop"),
        ({"stop": float("nan")}, "stop"),
        ({"tau": 1.5}, "tau"),
        ({"tau": True}, "tau"),
        ({"f_min": 0.9, "f_max": 0.1}, "f_min"),
        ({"alpha": float("inf")}, "alpha"),
        ({"travel_weight": -1.0}, "travel_weight is -1.0, expected a finite number ≥ 0"),
        ({"window": 0.0}, "window"),
        ({"window": float("inf")}, "window"),
        ({"repair": "wrap"}, "repair is 'wrap': valid are clip, reflect, random, midpoint"),
        ({"sign": "minus"}, "sign"),
        ({"rotation_measure": "quaternion"}, "rotation_measure"),
        ({"position_tolerance": -1.0}, "position_tolerance"),
    ],
)
def test_options_that_make_no_sense_are_refused(choice, words):
    with pytest.raises(OptionError, match=words):
        ProIsadeOptions(**choice)


def test_defaults_are_those_of_table_5():
    options = ProIsadeOptions()
    assert (options.iter_max, options.stop, options.tau) == (150, 1e-8, 0.1)
    assert options.window == pytest.approx(np.pi / 100)
    assert np.isinf(isade_settings(IsadeOptions(), "position").window)
    assert options.position_tolerance >= options.stop


MAIN = """
#include <stdio.h>
#include <stdlib.h>
int main(void) {
  static const int cases[3][3] = {{5, 0, 0}, {13, 1, 2}, {40, 2, 3}}; /* population, measure, repair */
  real targets[36], lengths[N_LENGTHS + 1];
  for (int j = 0; j < N_LENGTHS; ++j) lengths[j] = 0.3;
  for (int c = 0; c < 3; ++c) {
    const struct isade_settings settings = {cases[c][0], 25, cases[c][1], cases[c][2], c % 2, 4, 0.2, 0.8, 1,
                                            -1, 0.1, 0.01, 1, 0.3, 1e-8, 0.5, 0.03};
    /* The exact workspace: one number more would be found. */
    real *reals = malloc((size_t)armik_isade_reals(settings.population) * sizeof *reals);
    uint64_t *words = malloc((size_t)armik_isade_words(settings.population) * sizeof *words);
    real lower[DOF], upper[DOF], previous[DOF], q[3 * DOF], error[3];
    int generations[3], evaluations[3];
    for (int j = 0; j < DOF; ++j) lower[j] = -(upper[j] = 0.5), previous[j] = 0.1;
    for (int k = 0; k < 3; ++k) {
      armik_pose(previous, lengths, targets + 12 * k);
      targets[12 * k] += 0.001 * k;
    }
    for (int k = 0; k < 2; ++k) /* in two blocks */
      armik_isade_path(&settings, 42, k, k + 1, targets + 12 * k, lengths, lower, upper, previous,
                       reals, words, q + k * DOF, error + k, generations + k, evaluations + k);
    free(reals);
    free(words);
    for (int k = 0; k < 3 * DOF; ++k)
      if (!(q[k] >= -0.5 && q[k] <= 0.5)) return 3;
    if (!(error[0] < 1e-8) || generations[2] < 1 || evaluations[2] < settings.population) return 4;
  }
  return 0;
}
"""
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")


@needs_cc
@pytest.mark.parametrize(
    "flags", [("-O2",), ("-O3", "-march=native"), SANITIZED, (*SANITIZED, "-O1", "-march=native")]
)
def test_c_is_clean_under_warnings_and_sanitizers(tmp_path, flags):
    file, program = tmp_path / "main.c", tmp_path / "main"
    file.write_text(c_source(ARM) + MAIN)
    warnings = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wshadow")
    done = subprocess.run(
        [str(CC), *warnings, *flags, "-o", str(program), str(file), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode and "source" not in done.stderr and "main.c:" not in done.stderr:
        pytest.skip(f"compiler lacks {flags}: {done.stderr[:200]}")
    assert done.returncode == 0, done.stderr
    ran = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
