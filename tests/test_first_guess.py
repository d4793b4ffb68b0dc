"""Guesses from cold: inside the range of motion, on the path, the most promising first."""

from __future__ import annotations

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles, uneven_time

from armik_sym.compiled.kinematics import compile
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.damped_least_squares import PoseSolver
from armik_sym.trajectory.first_guess import first_near, first_postures, follow, guesses
from armik_sym.trajectory.pose_error import SampleError

ARM = ARMS["human"]
ROM = ARM.rom


def case(n=12, seed=1, time=None):
    q = smooth_angles(ARM, n, seed)
    path = path_of(ARM, q, uneven_time(n, seed) if time is None else time)
    return path, q, PoseSolver(compile(ARM), SampleError(ARM, path, Orientation.FULL))


def inside(q):
    return np.all(q >= ROM.lower) and np.all(q <= ROM.upper)


@pytest.mark.parametrize("known", [False, True])
def test_every_guess_is_a_whole_trajectory_inside_the_range_of_motion(known):
    path, q, solver = case()
    found = list(guesses(solver, path.time, ROM, q[0] if known else None, seed=0))
    assert len(found) >= 4
    for guess in found:
        assert guess.q.shape == q.shape
        assert guess.errors.shape == (len(path),)
        assert inside(guess.q)
    assert found[0].origin.startswith("followed from first posture 1")
    assert any("graph" in guess.origin for guess in found)
    held = found[-1]
    assert np.all(held.q == held.q[0])
    if known:
        for guess in found:
            assert np.abs(guess.q[0] - q[0]).max() < 1e-9


def test_the_errors_of_a_guess_are_those_of_its_angles():
    path, q, solver = case()
    postures, errors = follow(solver, path.time, q[0])
    for k in range(len(path)):
        e, _ = SampleError(ARM, path, Orientation.FULL)(k, *compile(ARM).pose_and_jacobian(postures[k]))
        assert errors[k] == pytest.approx(np.linalg.norm(e), abs=1e-12)


def test_guesses_are_made_only_when_asked_for(monkeypatch):
    path, q, solver = case()
    visited = []
    reach = solver.reach
    monkeypatch.setattr(solver, "reach", lambda k, *more: (visited.append(k), reach(k, *more))[1])
    made = guesses(solver, path.time, ROM, q[0], seed=0)
    assert not visited
    next(made)
    assert visited == list(range(len(path)))


def test_a_long_path_is_followed_by_some_of_its_samples():
    path, q, solver = case(n=700, time=np.linspace(0, 4, 700))
    postures, errors = follow(solver, path.time, q[0])
    assert postures.shape == q.shape
    assert inside(postures)
    assert errors.max() < 1e-6
    shift = compile(ARM).position(postures) - path.position
    assert np.linalg.norm(shift, axis=1).max() < 1e-3
    assert 0 < np.count_nonzero(np.linalg.norm(shift, axis=1) < 1e-9) < 700


def test_first_postures_are_distinct_on_the_path_and_ranked():
    path, _, solver = case()
    found = first_postures(solver, len(path), ROM, seed=0)
    assert 1 <= len(found) <= 3
    scores = []
    for i, q in enumerate(found):
        assert inside(q)
        assert all(np.abs(q - other).max() > 0.05 for other in found[:i])
        postures, errors = solver.follow(np.arange(len(path)), q, iterations=25)
        scores.append(10 * np.maximum(errors - 1e-6, 0).sum() + np.abs(np.diff(postures, axis=0)).max())
    assert scores == sorted(scores)
    assert solver.reach(0, found[0]).error < 1e-7


def test_same_seed_same_guesses():
    path, _, solver = case()
    first, second = (next(guesses(solver, path.time, ROM, None, seed=3)).q for _ in range(2))
    assert np.array_equal(first, second)


def test_the_posture_a_start_leads_to():
    _, q, solver = case()
    assert np.abs(first_near(solver, ROM, q[0], 0) - q[0]).max() < 1e-9
    near = first_near(solver, ROM, ROM.clip(q[0] + 0.05), 0)
    assert solver.reach(0, near).error < 1e-7
    assert np.abs(near - q[0]).max() < 0.5


def test_a_start_that_gets_stuck_is_led_round():
    stuck = 0
    for seed in range(12):
        _, _, solver = case(n=2, seed=seed)
        for corner in (ROM.lower, ROM.upper):
            direct = solver.reach(0, corner)
            led = first_near(solver, ROM, corner, 0)
            assert inside(led)
            assert solver.reach(0, led).error < 1e-7
            stuck += direct.error > 1e-3
    assert stuck > 0
