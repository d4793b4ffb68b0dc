"""Frames computed beforehand: what a page shows that was made without a compiler for WebAssembly."""

from __future__ import annotations

import json

import numpy as np
import pytest
from page_scripts import ALL_ARMS, WITH_SWIVEL, ask, needs_node, postures, rows
from spherical_arms import anywhere, apart, pose_error, poses

from armik_sym.report.wasm import frames as module
from armik_sym.report.wasm import page_kinematics
from armik_sym.report.wasm.drawn_points import drawn_points
from armik_sym.report.wasm.frames import FEWEST_STEPS, MOST_STEPS, drawn_values, fixed_frames, turned_frames
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.closed_form import pose_curve
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise


def inside(name: str, n: int, seed: int = 5) -> np.ndarray:
    rom = ALL_ARMS[name].rom
    return np.random.default_rng(seed).uniform(rom.lower, rom.upper, (n, rom.dof))


@needs_node
@pytest.mark.parametrize("name", ALL_ARMS)
def test_frames_of_the_motion_are_those_of_python(name):
    arm, q = ALL_ARMS[name], inside(name, 20)
    page = page_kinematics(arm, q, kind="frames")
    assert page.kind == "frames"
    points, hands = rows(page, "joints", q), rows(page, "hand", q)
    drawn = drawn_values(arm, drawn_points(arm), q)
    np.testing.assert_array_equal(np.array(points).reshape(20, -1), drawn[:, : 3 * arm.dof + 3])
    position, rotation = poses(arm, q)
    np.testing.assert_allclose([hand["position"] for hand in hands], position, rtol=0, atol=1e-12)
    np.testing.assert_allclose([hand["rotation"] for hand in hands], rotation, rtol=0, atol=1e-12)


@needs_node
@pytest.mark.parametrize("name", WITH_SWIVEL)
def test_turned_frames_are_those_of_python_and_keep_the_hand(name):
    arm, spherical, q = WITH_SWIVEL[name], recognise(WITH_SWIVEL[name]), inside(name, 20)
    reference = np.tile([0.0, 0.6, 0.8], (20, 1))
    page = page_kinematics(arm, q, reference, kind="frames")
    step, *swivels = ask(page, [("step",), *(("swivel", row) for row in q.tolist())])
    assert step == pytest.approx(2 * np.pi / MOST_STEPS)
    own = swivel_of_postures(spherical, q, reference)
    assert apart(np.array(swivels), own.psi).max() < 1e-15
    turns = np.random.default_rng(6).integers(-100, 100, 20)
    psi = own.psi + turns * step
    found = postures(page, psi + 0.4 * step, q)  # the nearest step answers
    curves = tuple(pose_curve(spherical, *poses(arm, q), side, reference) for side in (1, -1))
    branch = 4 * (own.elbow < 0) + 2 * (own.shoulder < 0) + (own.wrist < 0)
    wanted = postures_at((curves[0], curves[1]), np.arange(20), branch, psi, q).q
    assert apart(found, wanted).max() < 1e-9
    assert pose_error(arm, found, *poses(arm, q)) < 1e-9
    assert apart(np.array(rows(page, "swivel", found)), psi).max() < 1e-9
    before, after = np.split(np.array(rows(page, "joints", np.vstack([q, found]))), 2)
    elbow = page.landmarks["elbow"]
    still = [k for k in range(8) if k != elbow]
    np.testing.assert_array_equal(after[:, still], before[:, still])
    by_python = drawn_values(arm, drawn_points(arm), found)[:, :24].reshape(20, 8, 3)
    np.testing.assert_allclose(after, by_python, rtol=0, atol=1e-9)
    assert np.abs(after[:, elbow] - before[:, elbow]).max() > 0.01


@needs_node
def test_a_posture_between_frames_gets_the_nearest():
    arm, q = WITH_SWIVEL["ehmcs"], inside("ehmcs", 5)
    page = page_kinematics(arm, q, kind="frames")
    shaken = q + np.random.default_rng(1).uniform(-1e-3, 1e-3, q.shape)
    np.testing.assert_array_equal(rows(page, "joints", shaken), rows(page, "joints", q))


def test_both_backends_make_the_same_frames():
    arm, q = WITH_SWIVEL["human"], inside("human", 10)
    one, other = (turned_frames(arm, drawn_points(arm), q, None, backend) for backend in ("auto", "vm"))
    np.testing.assert_array_equal(one.turned[:, 0, :7], q)
    np.testing.assert_allclose(one.psi, other.psi, rtol=0, atol=1e-12)
    assert apart(one.turned[..., :7], other.turned[..., :7]).max() < 1e-9
    np.testing.assert_allclose(one.turned[..., 7:], other.turned[..., 7:], rtol=0, atol=1e-12)


@pytest.mark.parametrize("n", [1, 200, 1500, 9000])
def test_frames_stay_within_their_budget(n):
    arm = WITH_SWIVEL["ehmcs"]
    q = np.repeat(inside("ehmcs", 1), n, axis=0)
    frames = turned_frames(arm, drawn_points(arm), q, np.tile([1.0, 0.0, 0.0], (n, 1)))
    assert FEWEST_STEPS <= frames.turned.shape[1] <= MOST_STEPS
    assert sum(part.nbytes for part in (frames.q, frames.drawn, frames.psi, frames.turned)) <= module._BUDGET
    assert len(frames.q) == n or (n == 9000 and 1000 < len(frames.q) < n)
    bare = fixed_frames(arm, drawn_points(arm), q)
    assert sum(part.nbytes for part in (bare.q, bare.drawn)) <= module._BUDGET
    assert len(bare.q) == n or n == 9000
    assert len(json.dumps(page_kinematics(arm, q, kind="frames").data)) < 3_000_000


@needs_node
def test_arms_without_a_closed_form_say_so_and_are_drawn_all_the_same():
    arm, q = ALL_ARMS["custom_modified"], inside("custom_modified", 3)
    page = page_kinematics(arm, q, kind="frames")
    able, why, swivel, step = ask(
        page, [("canSwivel",), ("whyNoSwivel",), ("posture", 0.0, q[0].tolist()), ("step",)]
    )
    assert (able, why, step) == (False, page.why_no_swivel, 0)
    assert "shifts" in why
    assert why in swivel["error"]


def test_far_away_postures_are_no_error():
    arm = WITH_SWIVEL["alfaiz"]
    page = page_kinematics(arm, 50 * anywhere(4, 2), kind="frames")
    json.dumps(page.data, allow_nan=False)
