"""Postures on the swivel curves in C, against NumPy and the pose itself."""

from __future__ import annotations

import numpy as np
import pytest
from compiled_helpers import needs_cc
from hypothesis import given, settings
from hypothesis import strategies as st
from spherical_arms import ARMS, BRANCHES, anywhere, apart, pose_error, poses

from armik_sym.arm import Arm
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.closed_form import SwivelCurve, pose_curve
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise

pytestmark = needs_cc

nearly = st.sampled_from([0.0, 1e-17, 1e-15, 3e-14, 1e-12, 1e-9, 1e-6, 1e-3])
SPHERICAL = {name: recognise(arm) for name, arm in ARMS.items()}


def curves_of(arm: Arm, q: np.ndarray) -> tuple[SwivelCurve, SwivelCurve]:
    spherical, pose = recognise(arm), poses(arm, q)
    return pose_curve(spherical, *pose, 1), pose_curve(spherical, *pose, -1)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("wished", [False, True])
def test_postures_at_any_places_are_those_of_numpy(name, wished):
    arm, rng = ARMS[name], np.random.default_rng(15)
    curves = curves_of(arm, anywhere(40, 16))
    k = 1001
    sample, branch = rng.integers(0, 40, k), rng.integers(0, 8, k)
    psi = rng.uniform(-7, 7, k)
    psi[5] = 3e5
    wish = rng.uniform(arm.rom.lower - 1, arm.rom.upper + 1, (k, 7)) if wished else None
    one, other = (postures_at(curves, sample, branch, psi, wish, backend=b) for b in ("c", "vm"))
    sine = np.minimum(one.shoulder_sine, one.wrist_sine)
    clear = sine > 1e-6
    assert clear.sum() > 990
    difference = np.abs(one.q - other.q)
    turned = np.abs(difference - 2 * np.pi) < 1e-9  # as far from the wish either way round
    assert turned.sum() < 3
    assert (np.where(turned, 0.0, difference).max(axis=1) * sine)[clear].max() < 1e-14
    np.testing.assert_allclose(one.shoulder_sine, other.shoulder_sine, rtol=0, atol=1e-14)
    np.testing.assert_allclose(one.wrist_sine, other.wrist_sine, rtol=0, atol=1e-14)
    signs = np.array(BRANCHES)[branch]
    for i in (0, 5, 500, 1000):
        curve = curves[0 if signs[i, 0] == 1 else 1].rows(sample[[i]])
        alone = curve.postures(psi[[i]], *signs[i, 1:], wish=None if wish is None else wish[[i]])
        np.testing.assert_array_equal(alone.q[0], one.q[i])


def test_postures_in_c_reach_the_pose_and_are_found_on_their_branch():
    arm, spherical, q = ARMS["odd_modified"], SPHERICAL["odd_modified"], anywhere(50, 17)
    position, rotation = poses(arm, q)
    curves = pose_curve(spherical, position, rotation, 1), pose_curve(spherical, position, rotation, -1)
    sample = np.repeat(np.arange(50), 8)
    branch = np.tile(np.arange(8), 50)
    psi = np.random.default_rng(18).uniform(-np.pi, np.pi, 400)
    found = postures_at(curves, sample, branch, psi, backend="c").q
    assert pose_error(arm, found, position[sample], rotation[sample]) < 1e-12
    at = swivel_of_postures(spherical, found)
    clear = np.abs(at.sines).min(axis=1) > 1e-6
    signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
    np.testing.assert_array_equal(signs[clear], np.array(BRANCHES)[branch][clear])


@settings(max_examples=80, deadline=None)
@given(
    st.sampled_from(list(ARMS)),
    st.tuples(nearly, nearly, nearly),
    st.tuples(st.booleans(), st.booleans(), st.booleans()),
    st.booleans(),
    st.integers(0, 10**6),
)
def test_singular_poses_are_reached_exactly_in_c(name, off, half_turns, wished, seed):
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = anywhere(1, seed)
    zero = float(np.arctan2(*_forearm(spherical)[[1, 0]]))
    q[0, [1, 3, 5]] = np.array(off) + np.pi * np.array(half_turns)
    q[0, [1, 3, 5]] -= spherical.shoulder.offset, zero, spherical.wrist.offset
    position, rotation = poses(arm, q)
    own = swivel_of_postures(spherical, q)
    curves = pose_curve(spherical, position, rotation, 1), pose_curve(spherical, position, rotation, -1)
    for psi in (own.psi, np.array([seed % 7 - 3.0])):
        branch = np.arange(8)
        wish = q[0] if wished else None
        one, other = (
            postures_at(curves, np.zeros(8, int), branch, psi, wish, backend=b) for b in ("c", "vm")
        )
        for found in (one, other):
            assert np.isfinite(found.q).all()
            assert pose_error(arm, found.q, np.tile(position, (8, 1)), np.tile(rotation, (8, 1, 1))) < 1e-12
        if wished and own.psi is psi:
            mine = 4 * (own.elbow < 0) + 2 * (own.shoulder < 0) + (own.wrist < 0)
            if not half_turns[1] and min(off) == 0 and max(off) == 0:
                inside = (q >= arm.rom.lower) & (q <= arm.rom.upper)
                if inside.all():
                    assert apart(one.q[mine], q).max() < 1e-7


def _forearm(spherical):
    along = spherical.reference
    X = np.column_stack([along, np.cross(spherical.hinge, along), spherical.hinge])
    return (spherical.wrist.centre - spherical.elbow) @ X
