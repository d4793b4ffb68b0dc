"""Closed form over the swivel angle: every branch, other arms, singularities, references, positions."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import BARE
from spherical_arms import (
    ARMS,
    BRANCHES,
    OF_THE_PAPERS,
    RIGHT_ANGLE,
    anywhere,
    apart,
    changed_row,
    pose_error,
    poses,
)
from swivel_backends import swivel_backend

from armik_sym.arm import DHConvention, JointType
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.compiled.c_source import c_function
from armik_sym.errors import ArmModelError, OptionError, ShapeError
from armik_sym.pointwise.alfaiz.closed_form import postures_at
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.closed_form import pose_curve, position_curve
from armik_sym.swivel.expressions import swivel_functions
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import recognise, why_not_spherical

SPHERICAL = {name: recognise(arm) for name, arm in ARMS.items()}


@pytest.fixture(autouse=True, scope="module", params=["auto", "vm"])
def backend(request: pytest.FixtureRequest) -> Iterator[None]:
    with swivel_backend(request.param):
        yield


@pytest.mark.parametrize("name", ARMS)
def test_every_branch_and_swivel_angle_reaches_the_pose(name: str) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    position, rotation = poses(arm, anywhere(500, 1))
    psi = np.random.default_rng(2).uniform(-np.pi, np.pi, 500)
    for e, s, w in BRANCHES:
        curve = pose_curve(spherical, position, rotation, e)
        q = curve.postures(psi, s, w).q
        assert pose_error(arm, q, position, rotation) < 1e-12
        assert curve.shortfall.max() < 1e-14
        at = swivel_of_postures(spherical, q)
        clear = np.abs(at.sines).min(axis=1) > 1e-6
        assert clear.sum() > 490
        np.testing.assert_array_equal(at.elbow[clear], e)
        np.testing.assert_array_equal(at.shoulder[clear], s)
        np.testing.assert_array_equal(at.wrist[clear], w)
        assert apart(at.psi, psi)[at.reference_sine > 1e-3].max() < 1e-9


@pytest.mark.parametrize("name", ARMS)
def test_postures_are_found_again_on_their_own_branch(name: str) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = anywhere(2000, 3)
    at = swivel_of_postures(spherical, q)
    position, rotation = poses(arm, q)
    found = 0
    for e in (1, -1):
        rows = np.flatnonzero((at.elbow == e) & (np.abs(at.sines).min(axis=1) > 1e-3))
        curve = pose_curve(spherical, position[rows], rotation[rows], e)
        again = curve.postures(at.psi[rows], at.shoulder[rows], at.wrist[rows])
        assert apart(again.q, q[rows]).max() < 1e-9
        assert not again.degenerate.any()
        found += len(rows)
    assert found > 1900


@pytest.mark.parametrize("name", ARMS)
def test_postures_inside_the_range_of_motion_come_back_inside_it(name: str) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = arm.rom.random_postures(np.random.default_rng(4), 500)
    at = swivel_of_postures(spherical, q)
    position, rotation = poses(arm, q)
    rows = np.abs(at.sines).min(axis=1) > 1e-3
    for e in (1, -1):
        mine = rows & (at.elbow == e)
        curve = pose_curve(spherical, position[mine], rotation[mine], e)
        again = curve.postures(at.psi[mine], at.shoulder[mine], at.wrist[mine]).q
        if mine.any():
            assert arm.rom.margin(again).min() > -1e-9


near_nothing = st.sampled_from([0.0, 1e-17, 1e-16, 1e-15, 3e-14, 1e-13, 2e-12, 1e-10, 1e-8, 1e-6, 1e-3])
signs = st.sampled_from([1, -1])


@settings(max_examples=60)
@given(
    st.sampled_from(list(ARMS)),
    st.tuples(near_nothing, near_nothing, near_nothing),
    st.tuples(signs, signs, signs),
    st.tuples(st.booleans(), st.booleans(), st.booleans()),
    st.integers(0, 10**6),
)
def test_singular_poses_are_reached_with_finite_angles(
    name: str,
    off: tuple[float, float, float],
    sides: tuple[int, int, int],
    half_turns: tuple[bool, bool, bool],
    seed: int,
) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = anywhere(1, seed)
    zero = np.arctan2(*(_forearm(spherical)[[1, 0]]))
    turns = np.pi * np.array(half_turns)
    q[0, [1, 3, 5]] = np.array(sides) * off + turns
    q[0, 1] -= spherical.shoulder.offset
    q[0, 3] -= zero
    q[0, 5] -= spherical.wrist.offset
    position, rotation = poses(arm, q)
    own = swivel_of_postures(spherical, q)
    for e, s, w in BRANCHES:
        curve = pose_curve(spherical, position, rotation, e)
        for psi in (own.psi, seed % 7 - 3.0):
            for wish in (None, q):
                again = curve.postures(psi, s, w, wish=wish)
                assert np.isfinite(again.q).all()
                assert pose_error(arm, again.q, position, rotation) < 1e-12


def _forearm(spherical: object) -> np.ndarray:
    along = spherical.reference
    X = np.column_stack([along, np.cross(spherical.hinge, along), spherical.hinge])
    return (spherical.wrist.centre - spherical.elbow) @ X


@pytest.mark.parametrize("name", OF_THE_PAPERS)
def test_the_wished_posture_is_kept_where_axes_are_parallel(name: str) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = arm.rom.random_postures(np.random.default_rng(5), 1)
    q[0, [1, 5]] = -spherical.shoulder.offset, -spherical.wrist.offset
    position, rotation = poses(arm, q)
    at = swivel_of_postures(spherical, q)
    curve = pose_curve(spherical, position, rotation, int(at.elbow[0]))
    again = curve.postures(at.psi, 1, 1, wish=q)
    assert again.degenerate[0]
    inside = np.clip(q, arm.rom.lower, arm.rom.upper)
    assert apart(again.q, q)[0, [0, 2, 4, 6]].max() < 1e-7
    np.testing.assert_array_less(np.abs(again.q - inside)[0, [0, 2, 3, 4, 6]], 1e-6)


def test_out_of_reach_the_arm_stretches_towards_the_target_and_says_so() -> None:
    spherical = SPHERICAL["alfaiz"]
    far, R = np.array([[1.0, 0.0, 0.0]]), np.eye(3)[None]
    curve = pose_curve(spherical, far, R)
    assert curve.shortfall[0] == pytest.approx(1.0 - 0.54, abs=1e-14)
    position, rotation = poses(alfaiz(), curve.postures(0.3).q)
    np.testing.assert_allclose(position, [[0.54, 0, 0]], atol=1e-14)
    np.testing.assert_allclose(rotation, R, atol=1e-14)


def test_elbow_points_along_the_reference_at_zero_and_turns_positively_about_the_line_to_the_wrist() -> None:
    arm, spherical = human(), SPHERICAL["human"]
    position, rotation = poses(arm, arm.rom.middle[None])
    r = np.array([0.0, 1.0, 0.0])
    curve = pose_curve(spherical, position, rotation, reference=r)
    w = wrist_directions(spherical, position, rotation)[0]
    for psi in (0.0, 0.7):
        q = curve.postures(psi).q
        elbow = _elbow_position(arm, q)
        g = r - w * (w @ r) / (w @ w)
        across = elbow - w * (w @ elbow) / (w @ w)
        angle = np.arctan2(np.cross(g, across) @ w / np.linalg.norm(w), g @ across)
        assert angle == pytest.approx(psi, abs=1e-12)


def _elbow_position(arm: object, q: np.ndarray) -> np.ndarray:
    return joint_frames(arm.chain, q, arm.lengths)[0, 3, :3, 3]


def test_transported_reference_has_no_jump_where_the_wrist_passes_the_reference_line() -> None:
    spherical = SPHERICAL["ehmcs"]
    t = np.linspace(-1, 1, 201)
    down = spherical.reference
    aside = np.array([0.0, 0.6, 0.8])
    directions = 0.4 * down + 0.3 * t[:, None] * aside
    r = transported_reference(spherical, directions)
    w = directions / np.linalg.norm(directions, axis=1)[:, None]
    np.testing.assert_allclose((r * w).sum(axis=1), 0, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(r, axis=1), 1, atol=1e-14)
    assert np.linalg.norm(np.diff(r, axis=0), axis=1).max() < 0.02
    fixed = down - w * (w @ down)[:, None]
    np.testing.assert_allclose(r[0], fixed[0] / np.linalg.norm(fixed[0]), atol=1e-14)
    position = directions + spherical.shoulder.centre
    curve = pose_curve(spherical, position, np.tile(np.eye(3), (201, 1, 1)), reference=r)
    assert curve.reference_sine.min() > 1 - 1e-12
    steps = np.abs(np.diff(curve.parts, axis=0)).max()
    assert steps < 0.05


@pytest.mark.parametrize("name", ["ehmcs", "human", "odd_standard"])
def test_positions_are_reached_with_the_wrist_held(name: str) -> None:
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = anywhere(200, 6)
    position, _ = poses(arm, q)
    at = swivel_of_postures(spherical, q, position_only=True)
    psi = np.random.default_rng(7).uniform(-3, 3, 200)
    for e in (1, -1):
        curve = position_curve(spherical, position, q[:, 4:], e)
        for s in (1, -1):
            reached, _ = poses(arm, curve.postures(psi, s).q)
            np.testing.assert_allclose(reached, position, atol=1e-12)
        mine = (at.elbow == e) & (np.abs(at.sines).min(axis=1) > 1e-3)
        again = curve.rows(mine).postures(at.psi[mine], at.shoulder[mine]).q
        assert apart(again, q[mine]).max() < 1e-9


@pytest.mark.parametrize("dof", [4, 5])
def test_positions_of_arms_without_a_wrist(dof: int) -> None:
    arm = ehmcs(dof)
    spherical = recognise(arm)
    assert "make 7" in spherical.why_no_wrist
    q = arm.rom.random_postures(np.random.default_rng(8), 50)
    position, rotation = poses(arm, q)
    curve = position_curve(spherical, position, q[:, 4:])
    np.testing.assert_allclose(poses(arm, curve.postures(0.4).q)[0], position, atol=1e-13)
    with pytest.raises(OptionError, match="no closed form for poses"):
        pose_curve(spherical, position, rotation)


def test_phi_of_al_faiz_belongs_to_a_swivel_angle() -> None:
    arm, spherical = alfaiz(), SPHERICAL["alfaiz"]
    q = anywhere(500, 9)
    at = swivel_of_postures(spherical, q)
    position, rotation = poses(arm, q)
    phi = np.arctan2(-position[:, 0], position[:, 2]) - q[:, 0]
    for e, s, w in BRANCHES:
        rows = (at.elbow == e) & (at.shoulder == s) & (at.wrist == w)
        rows &= np.abs(at.sines).min(axis=1) > 1e-2
        curve = pose_curve(spherical, position[rows], rotation[rows], e)
        mine = curve.postures(at.psi[rows], s, w).q
        theirs = np.stack(
            [
                postures_at(arm, position[rows], rotation[rows], phi[rows], (side4, side3, side6))[0]
                for side4 in (1, -1)
                for side3 in (1, -1)
                for side6 in (1, -1)
            ]
        )
        assert np.abs(apart(theirs, mine)).max(axis=2).min(axis=0).max() < 1e-6


def test_lengths_are_free() -> None:
    arm = human().with_lengths(upper_arm=0.33, forearm=0.21, hand=0.0)
    q = anywhere(50, 10)
    position, rotation = poses(arm, q)
    again = pose_curve(recognise(arm), position, rotation).postures(1.0).q
    assert pose_error(arm, again, position, rotation) < 1e-12


@pytest.mark.parametrize(
    ("arm", "words"),
    [
        (changed_row(ehmcs(), "shoulder_abduction", alpha=1.5), "make 94.*needs 90"),
        (changed_row(ehmcs(), "shoulder_flexion", d=0.007), "misses .* by 0.007 m: no spherical shoulder"),
        (changed_row(ehmcs(), "wrist_extension", a=0.02), "misses .* by 0.02 m: no spherical wrist"),
        (changed_row(ehmcs(), "forearm_pronation", joint=JointType.PRISMATIC, d=0.3), "shifts"),
        (changed_row(ehmcs(), "shoulder_internal_rotation", d=0.0), "no upper arm"),
        (changed_row(ehmcs(), "forearm_pronation", d=0.0), "no forearm"),
    ],
)
def test_other_arms_are_refused_with_the_reason(arm: object, words: str) -> None:
    assert re.search(words, why_not_spherical(arm) or "")


def test_recognition_answers_and_errors() -> None:
    assert all(why_not_spherical(arm) is None for arm in ARMS.values())
    assert {arm.chain.convention for arm in ARMS.values()} == set(DHConvention)
    with pytest.raises(ArmModelError, match="at least 4"):
        recognise(BARE)
    spherical = SPHERICAL["ehmcs"]
    np.testing.assert_array_equal(spherical.reference, [-1, 0, 0])
    assert abs(spherical.shoulder.offset) == RIGHT_ANGLE
    p, R = np.zeros((2, 3)), np.tile(np.eye(3), (2, 1, 1))
    with pytest.raises(ShapeError):
        pose_curve(spherical, p, R[0])
    with pytest.raises(OptionError, match="side"):
        pose_curve(spherical, p, R, 0)
    with pytest.raises(OptionError, match="no length"):
        pose_curve(spherical, p, R, reference=[0.0, 0, 0])
    with pytest.raises(ShapeError):
        pose_curve(spherical, p, R, reference=np.zeros((3, 3)))
    with pytest.raises(ShapeError):
        swivel_of_postures(spherical, np.zeros((2, 6)))
    with pytest.raises(ShapeError):
        position_curve(spherical, p, np.zeros(2))
    with pytest.raises(ShapeError):
        transported_reference(spherical, np.zeros(3))
    assert pose_curve(spherical, p[:0], R[:0]).postures(0.0).q.shape == (0, 7)


@pytest.mark.parametrize("name", list(swivel_functions()))
def test_expressions_become_c(name: str) -> None:
    assert name in c_function(swivel_functions()[name], name)
