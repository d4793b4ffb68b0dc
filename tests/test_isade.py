"""ISADE and Pro-ISADE: on the path, inside window and limits, and repeatable."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from isade_helpers import (
    ARM,
    BOTH,
    NAME,
    NUMPY,
    SEEDS,
    WINDOW,
    gentle,
    inside,
    library,
    same,
    targets_of,
)
from sample_arms import ARMS

import armik_sym as ak
from armik_sym.errors import OptionError
from armik_sym.pointwise.differential_evolution import (
    IsadeOptions,
    PathJob,
    ProIsadeOptions,
    run,
    run_isade,
    run_many,
)
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.symbolic import Orientation


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
