"""Attempts: rate limits only where needed, one guess after another, a soft detour at last."""

from __future__ import annotations

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles

from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.symbolic import Orientation
from armik_sym.trajectory import attempts as module
from armik_sym.trajectory.attempts import attempt, attempts
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.task import Task

ARM = ARMS["ehmcs"]
INF = np.full(ARM.dof, np.inf)


@pytest.fixture
def runs(monkeypatch):
    """The problems run: which kind, from where."""
    seen = []
    run = module._run

    def note(task, q, *, soft, rates, report):
        outcome = run(task, q, soft=soft, rates=rates, report=report)
        seen.append((soft, rates, outcome.result.converged))
        return outcome

    monkeypatch.setattr(module, "_run", note)
    return seen


def task_for(speed=INF, **options):
    q = smooth_angles(ARM, 10, 2)
    path = path_of(ARM, q)
    stage = compile_stage(ARM, Orientation.NONE)
    chosen = TrajectoryOptions(**options)
    return Task(ARM, path, Orientation.NONE, chosen, speed, INF, None, stage), q


def guess_of(q, name="guess"):
    return Guess(q, np.zeros(len(q)), name)


def test_limits_that_do_not_bind_cost_no_second_run(runs):
    task, q = task_for(speed=np.full(7, 50.0))
    outcome = attempt(task, q, soft=False, progress=None)
    assert outcome.result.converged
    assert runs == [(False, False, True)]
    assert outcome.unlimited is None


def test_limits_that_bind_come_in_a_second_run(runs):
    task, q = task_for()
    free = attempt(task, q, soft=False, progress=None)
    peak = np.abs(np.diff(free.q, axis=0) / np.diff(task.path.time)[:, None]).max()
    task, _ = task_for(speed=np.full(7, 0.9 * peak))
    limited = attempt(task, q, soft=False, progress=None)
    assert runs[1:] == [(False, False, True), (False, True, True)]
    assert limited.result.converged
    assert limited.unlimited is None
    assert limited.iterations > limited.result.iterations
    assert not task.exceeds_rates(limited.q)
    assert limited.result.objective > free.result.objective


def test_limits_that_cannot_be_kept_hand_back_the_motion_without_them(runs):
    task, q = task_for(speed=np.full(7, 0.05), max_iterations=40)
    outcome = attempt(task, q, soft=False, progress=None)
    assert not outcome.result.converged
    assert task.exceeds_rates(outcome.unlimited)
    assert runs == [(False, False, True), (False, True, False)]


@pytest.mark.parametrize("soft", [False, True])
def test_one_guess_after_another_only_as_asked_for(runs, soft):
    task, q = task_for()
    taken = []

    def guesses():
        for name in "ab":
            taken.append(name)
            yield guess_of(q, name)

    tries = attempts(task, guesses(), soft=soft, progress=None)
    assert not taken
    assert next(tries).result.converged
    assert taken == ["a"]
    assert runs == [(soft, False, True)]
    rest = list(tries)
    assert taken == ["a", "b"]
    # After the last guess, exact tracking goes by way of a soft solution.
    assert len(rest) == (1 if soft else 2)
    assert [run[0] for run in runs] == ([True, True] if soft else [False, False, True, False])
    assert np.all([outcome.result.converged for outcome in rest])


def test_no_guess_no_attempt(runs):
    task, _ = task_for()
    assert list(attempts(task, iter(()), soft=False, progress=None)) == []
    assert runs == []


def test_progress_names_the_stage():
    task, q = task_for()
    seen = []
    attempt(task, q, soft=True, progress=seen.append)
    assert {report.stage for report in seen} == {"soft tracking"}
    assert [report.iteration for report in seen] == list(range(len(seen)))
    assert len(seen) > 1
