"""The verdict: each violation alone makes a solution not ok, and is told with joint, value and limit."""

from __future__ import annotations

import numpy as np
import pytest
from sample_arms import ARMS
from scipy.spatial.transform import Rotation
from smooth_motions import path_of, smooth_angles
from solutions import of_motion

from armik_sym.motion.hand_path import HandPath
from armik_sym.solution import Solution

ARM = ARMS["human"]
N = 9


@pytest.fixture
def q():
    return smooth_angles(ARM, N, 0)


def only_reason(solution):
    assert not solution.ok
    assert len(solution.reasons) == 1, solution.reasons
    return solution.reasons[0]


def test_a_sound_solution_is_ok(q):
    assert of_motion(ARM, q).reasons == ()
    assert of_motion(ARM, q).ok is True


@pytest.mark.parametrize("side", ["lower", "upper"])
def test_limits_have_no_tolerance(q, side):
    outwards = {"lower": -1, "upper": 1}[side]
    q[3, 2] = getattr(ARM.rom, side)[2]
    assert of_motion(ARM, q).ok
    q[3, 2] += outwards * 1e-12
    reason = only_reason(of_motion(ARM, q))
    assert reason.startswith("shoulder_internal_rotation leaves its range of motion by 5.7")
    assert reason.endswith("°")


def test_position_error(q):
    path = path_of(ARM, q)
    position = path.position.copy()
    position[4, 1] += 0.0025
    reason = only_reason(of_motion(ARM, q, path=HandPath(path.time, position, path.rotation)))
    assert reason == "position error 2.5 mm at sample 4 (allowed 1e-06 mm)"


def test_rotation_error(q):
    path = path_of(ARM, q)
    rotation = path.rotation.copy()
    rotation[6] = rotation[6] @ Rotation.from_euler("x", 3, degrees=True).as_matrix()
    reason = only_reason(of_motion(ARM, q, path=HandPath(path.time, path.position, rotation)))
    assert reason.startswith("rotation error 3° at sample 6 (allowed ")


@pytest.mark.parametrize(
    ("what", "word"), [("max_speed", "moves at"), ("max_acceleration", "accelerates at")]
)
def test_rates_have_no_tolerance(q, what, word):
    peak = getattr(of_motion(ARM, q), what)
    assert of_motion(ARM, q, **{what: peak}).ok
    limits = peak.copy()
    limits[4] = np.nextafter(limits[4], 0)
    reason = only_reason(of_motion(ARM, q, **{what: limits}))
    assert reason.startswith(f"forearm_pronation {word} {np.rad2deg(peak[4]):.4g}°/s")
    assert "allowed" in reason


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_angles_that_are_not_finite(q, bad):
    q[5, 1] = bad
    path = path_of(ARM, smooth_angles(ARM, N, 0))
    with np.errstate(invalid="ignore"):
        reason = only_reason(of_motion(ARM, q, path=path))
    assert reason == "sample 5 has joint angles that are not finite"


def test_every_violation_is_told(q):
    path = path_of(ARM, q)
    q[2] = ARM.rom.upper + 0.1
    solution = of_motion(ARM, q, path=path, max_speed=1e-3, max_acceleration=1e-3)
    text = "\n".join(solution.reasons)
    for word in ("position error", "rotation error", "moves at", "accelerates at"):
        assert word in text
    assert text.count("leaves its range of motion") == ARM.dof


def test_the_verdict_does_not_trust_the_solver(q):
    path = path_of(ARM, q)
    wrong = of_motion(ARM, q + 0.01, path=path, status="Solve_Succeeded")
    assert not wrong.ok
    right = of_motion(ARM, q, path=path, status="Infeasible_Problem_Detected")
    assert right.ok
    assert isinstance(right, Solution)
