"""Solutions judge themselves: every number against an independent computation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation
from smooth_motions import path_of, smooth_angles, uneven_time
from solutions import of_motion

from armik_sym.errors import ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution import Solution, Timing
from armik_sym.symbolic import Orientation

ARM = ARMS["human"]


def test_a_solution_keeps_its_own_read_only_copy_of_the_angles():
    q = smooth_angles(ARM, 5, 0)
    given_q = q.copy()
    solution = of_motion(ARM, given_q)
    given_q[:] = 0
    assert np.array_equal(solution.q, q)
    with pytest.raises(ValueError, match="read-only"):
        solution.q[0, 0] = 1.0


@pytest.mark.parametrize("shape", [(5,), (4, 7), (5, 6), (1, 7)])
def test_angles_that_fit_neither_path_nor_arm_are_refused(shape):
    path = path_of(ARM, smooth_angles(ARM, 5, 0))
    need = of_motion(ARM, smooth_angles(ARM, 5, 0)).requirements
    with pytest.raises(ShapeError, match=r"expected \(5, 7\)"):
        Solution(ARM, path, np.zeros(shape), "none", Orientation.FULL, need)


@given(seed=st.integers(0, 10**6))
def test_margin_is_the_distance_to_the_nearer_limit(seed):
    q = postures(ARM, 6, seed, stretch=1.2)
    solution = of_motion(ARM, q)
    expected = np.minimum(q - ARM.rom.lower, ARM.rom.upper - q).min(axis=0)
    assert np.array_equal(solution.rom_margin, expected)
    inside = np.all(q >= ARM.rom.lower) and np.all(q <= ARM.rom.upper)
    assert solution.ok == inside


def test_rates_of_a_known_motion():
    time = np.array([0.0, 0.5, 1.5, 2.0, 4.0])
    q = np.zeros((5, 7))
    q[:, 1] = 0.1 * time**2
    q[:, 3] = 0.2 + 0.3 * time
    solution = of_motion(ARM, q, time=time)
    assert solution.max_step == pytest.approx([0, 1.2, 0, 0.6, 0, 0, 0])
    assert solution.max_speed == pytest.approx([0, 0.6, 0, 0.3, 0, 0, 0])
    assert solution.max_acceleration == pytest.approx([0, 0.2, 0, 0, 0, 0, 0], abs=1e-12)
    steps = np.diff(q, axis=0)
    assert solution.arc_length == pytest.approx(sum(np.hypot(s[1], s[3]) for s in steps))


def test_two_samples_have_speed_but_no_acceleration():
    q = np.vstack([np.zeros(7), np.full(7, 0.1)])
    solution = of_motion(ARM, q, time=np.array([0.0, 0.5]))
    assert solution.max_speed == pytest.approx(np.full(7, 0.2))
    assert np.array_equal(solution.max_acceleration, np.zeros(7))
    assert solution.ok


def test_time_is_the_paths():
    time = uneven_time(9, 2)
    assert np.array_equal(of_motion(ARM, smooth_angles(ARM, 9, 0), time=time).time, time)


@given(seed=st.integers(0, 10**6), shift=st.floats(0, 0.5), turn=st.floats(0, 3.1))
def test_errors_of_a_shifted_and_turned_path(seed, shift, turn):
    rng = np.random.default_rng(seed)
    q = postures(ARM, 4, seed)
    path = path_of(ARM, q)
    direction, axis = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    turned = path.rotation @ Rotation.from_rotvec(turn * axis).as_matrix()
    solution = of_motion(ARM, q, path=HandPath(path.time, path.position + shift * direction, turned))
    np.testing.assert_allclose(solution.position_error, shift, atol=1e-14)
    np.testing.assert_allclose(solution.rotation_error, turn, atol=1e-12)


def test_timing_adds_up():
    assert Timing(1.0, 2.0, 3.5).total == 6.5
    assert of_motion(ARM, np.zeros((2, 7))).timing.total == 0


def test_plot_is_a_figure(monkeypatch):
    import matplotlib as mpl

    mpl.use("Agg", force=True)
    import matplotlib.pyplot as plt

    figure = of_motion(ARM, smooth_angles(ARM, 9, 0)).plot()
    assert len(figure.axes) >= 3
    plt.close(figure)
