"""The shortest way through a graph of postures: shortest indeed, and along the path."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles, uneven_time

from armik_sym.compiled.kinematics import compile
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.damped_least_squares import PoseSolver
from armik_sym.trajectory.pose_error import SampleError
from armik_sym.trajectory.posture_graph import _random_postures, _shortest_way, graph_guess

ARM = ARMS["ehmcs"]


def case(n, orientation=Orientation.FULL, seed=1):
    q = smooth_angles(ARM, n, seed)
    path = path_of(ARM, q, uneven_time(n, seed))
    return path, q, PoseSolver(compile(ARM), SampleError(ARM, path, orientation))


@pytest.mark.parametrize("seed", range(5))
def test_the_way_is_the_cheapest_of_all(seed):
    rng = np.random.default_rng(seed)
    time = uneven_time(5, seed)
    layers = [
        SimpleNamespace(
            postures=list(rng.normal(size=(size, 2))), errors=list(rng.choice([0, 0, 0.01], size))
        )
        for size in rng.integers(1, 5, 5)
    ]

    def cost(choice):
        q = np.array([layer.postures[i] for layer, i in zip(layers, choice, strict=True)])
        way = (np.square(np.diff(q, axis=0)).sum(axis=1) / np.diff(time)).sum()
        return way + 1e4 * sum(layer.errors[i] ** 2 for layer, i in zip(layers, choice, strict=True))

    best = min(itertools.product(*(range(len(layer.postures)) for layer in layers)), key=cost)
    expected = np.array([layer.postures[i] for layer, i in zip(layers, best, strict=True)])
    assert np.array_equal(_shortest_way(layers, time), expected)


@pytest.mark.parametrize("known", [False, True])
def test_a_guess_goes_through_postures_on_the_path(known):
    path, q, solver = case(10)
    guess = graph_guess(solver, path.time, ARM.rom, q[0] if known else None, seed=0)
    assert guess.q.shape == q.shape
    assert np.all(guess.q >= ARM.rom.lower)
    assert np.all(guess.q <= ARM.rom.upper)
    assert guess.errors.max() < 1e-4
    assert np.abs(compile(ARM).position(guess.q) - path.position).max() < 1e-4
    if known:
        assert np.abs(guess.q[0] - q[0]).max() < 1e-9


def test_between_its_layers_a_guess_is_linear_in_time():
    path, _, solver = case(79, Orientation.NONE)
    guess = graph_guess(solver, path.time, ARM.rom, None, seed=0)
    on = np.unique(np.linspace(0, 78, 40).astype(int))
    assert np.array_equal(on, np.arange(0, 79, 2))
    between = np.arange(1, 78, 2)
    share = (
        (path.time[between] - path.time[between - 1]) / (path.time[between + 1] - path.time[between - 1])
    )[:, None]
    expected = (1 - share) * guess.q[between - 1] + share * guess.q[between + 1]
    np.testing.assert_allclose(guess.q[between], expected, atol=1e-12)


def test_joints_that_move_nothing_stay_in_the_middle():
    _, _, solver = case(3, Orientation.NONE)
    found = np.array(_random_postures(solver, ARM.rom, np.random.default_rng(0), 20))
    assert np.all(found[:, 4:] == ARM.rom.middle[4:])
    assert np.ptp(found[:, :4], axis=0).min() > 0.1


def test_same_seed_same_guess():
    path, _, solver = case(4)
    first, second = (graph_guess(solver, path.time, ARM.rom, None, seed=2).q for _ in range(2))
    assert np.array_equal(first, second)
