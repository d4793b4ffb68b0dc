"""The swivel slider of the page: the elbow moves, the hand stays, limits block."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from page_scripts import WITH_SWIVEL, ask, needs_node, needs_zig, postures, rows
from spherical_arms import anywhere, apart, pose_error, poses

from armik_sym.arm import Arm
from armik_sym.report.wasm import page_kinematics
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.intervals import feasible_intervals
from armik_sym.swivel.spherical_arm import SphericalArm, recognise

pytestmark = [needs_node, needs_zig]

nearly = st.sampled_from([0.0, 1e-17, 1e-15, 3e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.5])


def hand_stays(arm: Arm, q: np.ndarray, psi: np.ndarray, reference: list[float] | None = None) -> None:
    """By the page's own numbers and by NumPy."""
    page = page_kinematics(arm, q, kind="wasm")
    found = postures(page, psi, q, reference)
    assert np.isfinite(found).all()
    assert pose_error(arm, found, *poses(arm, q)) < 1e-9
    before, after = np.split(np.array(rows(page, "joints", np.vstack([q, found]))), 2)
    for place in ("shoulder", "wrist", "hand"):
        k = page.landmarks[place]
        assert np.abs(after[:, k] - before[:, k]).max() < 1e-9


def at_singularities(spherical: SphericalArm, q: np.ndarray, off: np.ndarray) -> np.ndarray:
    """Postures whose elbow is straight, or whose shoulder or wrist has two axes in line, but for `off`."""
    along = spherical.reference
    X = np.column_stack([along, np.cross(spherical.hinge, along), spherical.hinge])
    forearm = (spherical.wrist.centre - spherical.elbow) @ X
    zero = np.array([spherical.shoulder.offset, np.arctan2(forearm[1], forearm[0]), spherical.wrist.offset])
    near = q.copy()
    near[:, [1, 3, 5]] = np.where(np.isnan(off), q[:, [1, 3, 5]], off - zero)
    return near


@pytest.mark.parametrize("name", WITH_SWIVEL)
def test_hand_stays_at_random_postures(name):
    rng = np.random.default_rng(7)
    hand_stays(WITH_SWIVEL[name], anywhere(300, 8), rng.uniform(-10, 10, 300))
    hand_stays(WITH_SWIVEL[name], anywhere(100, 9), rng.uniform(-4, 4, 100), [0.6, 0.0, -0.8])


@settings(max_examples=8, deadline=None)
@given(
    st.sampled_from(list(WITH_SWIVEL)),
    st.lists(st.tuples(nearly, nearly, nearly, st.integers(0, 127)), min_size=20, max_size=60),
    st.integers(0, 10**6),
)
def test_hand_stays_near_singularities(name, cases, seed):
    arm, spherical = WITH_SWIVEL[name], recognise(WITH_SWIVEL[name])
    off = np.array([case[:3] for case in cases])
    kind = np.array([case[3] for case in cases])[:, None]
    off = np.where(kind >> [0, 1, 2] & 1, off, np.nan)  # which of the three are singular
    off = off + np.pi * (kind >> [3, 4, 5] & 1)  # aligned or half a turn further
    rng = np.random.default_rng(seed)
    q = at_singularities(spherical, anywhere(len(cases), seed), off)
    own = swivel_of_postures(spherical, q).psi
    hand_stays(arm, q, np.where(kind[:, 0] >> 6, own, rng.uniform(-4, 4, len(cases))))


@pytest.mark.parametrize("name", WITH_SWIVEL)
def test_slider_begins_at_the_posture_and_turns_the_elbow_by_its_angle(name):
    arm = WITH_SWIVEL[name]
    q = np.random.default_rng(10).uniform(arm.rom.lower, arm.rom.upper, (200, 7))
    sines = np.abs(swivel_of_postures(recognise(arm), q).sines).min(axis=1)
    q = q[sines > 1e-3]
    page = page_kinematics(arm, q, kind="wasm")
    own = np.array(rows(page, "swivel", q))
    same, turned = np.split(postures(page, np.append(own, own + 1.25), np.vstack([q, q])), 2)
    np.testing.assert_allclose(same, q, rtol=0, atol=1e-9)
    assert apart(np.array(rows(page, "swivel", turned)), own + 1.25).max() < 1e-9
    elbow, shoulder = page.landmarks["elbow"], page.landmarks["shoulder"]
    before, after = np.split(np.array(rows(page, "joints", np.vstack([q, turned]))), 2)
    moved = np.linalg.norm(after[:, elbow] - before[:, elbow], axis=1)
    to_wrist = before[:, page.landmarks["wrist"]] - before[:, shoulder]
    axis = to_wrist / np.linalg.norm(to_wrist, axis=1, keepdims=True)
    radius = np.linalg.norm(np.cross(axis, before[:, elbow] - before[:, shoulder]), axis=1)
    np.testing.assert_allclose(moved, 2 * radius * np.sin(1.25 / 2), rtol=0, atol=1e-9)


def test_joints_that_turn_further_than_a_turn_keep_their_turn():
    arm = WITH_SWIVEL["ehmcs"]
    arm = arm.with_rom(arm.rom.lower, np.where(np.arange(7) == 4, 9.0, arm.rom.upper))
    q = np.tile(arm.rom.middle, (3, 1))
    q[:, [1, 3, 5]] = 0.6, 1.0, 0.4
    q[:, 4] = [0.3, 0.3 + 2 * np.pi, 0.9 + 2 * np.pi]
    page = page_kinematics(arm, q, kind="wasm")
    psi = np.array(rows(page, "swivel", q)) + 0.2
    found = postures(page, psi, q)
    assert np.abs(found[:, 4] - q[:, 4]).max() < 1.0
    np.testing.assert_allclose(found[1] - found[0], [0, 0, 0, 0, 2 * np.pi, 0, 0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", WITH_SWIVEL)
def test_slider_is_blocked_exactly_outside_the_feasible_intervals(name):
    arm, spherical = WITH_SWIVEL[name], recognise(WITH_SWIVEL[name])
    q = np.random.default_rng(11).uniform(arm.rom.lower, arm.rom.upper, (12, 7))
    where = swivel_of_postures(spherical, q)
    intervals = feasible_intervals(spherical, *poses(arm, q))
    branch = intervals.branch_of(np.column_stack([where.elbow, where.shoulder, where.wrist]))
    answers = ask(page_kinematics(arm, q, kind="wasm"), [("blockedAlong", row, 360) for row in q.tolist()])
    free = 0
    for i, answer in enumerate(answers):
        psi = np.array([place["psi"] for place in answer])
        ends = intervals.of(i, int(branch[i]))
        inside = np.zeros(len(psi), dtype=bool)
        for start, end in ends:
            inside |= (psi - start) % (2 * np.pi) <= end - start
        sure = np.array([apart(ends.ravel(), at).min() > 1e-7 for at in psi])
        blocked = np.array([bool(place["blocked"]) for place in answer])
        np.testing.assert_array_equal(blocked[sure], ~inside[sure])
        free += int(inside.sum())
    assert 0 < free < 12 * 360


def test_blocked_names_the_joint_its_limit_and_what_is_missing():
    arm = WITH_SWIVEL["ehmcs"]
    q = arm.rom.middle.copy()
    q[2], q[4] = arm.rom.upper[2] + 0.25, arm.rom.lower[4] - 0.5
    (blocked,) = ask(page_kinematics(arm, q[None], kind="wasm"), [("blocked", q.tolist())])
    assert [(b["joint"], b["name"], b["limit"]) for b in blocked] == [
        (4, arm.joint_names[4], "lower"),
        (2, arm.joint_names[2], "upper"),
    ]
    np.testing.assert_allclose([b["missing"] for b in blocked], [0.5, 0.25], rtol=0, atol=1e-12)
