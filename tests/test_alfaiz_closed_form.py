"""The closed form of Al-Faiz over φ and over the swivel angle."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from alfaiz_poses import poses, turned
from hypothesis import given, settings
from hypothesis import strategies as st

from armik_sym.arm.catalog import alfaiz, ehmcs
from armik_sym.arm.dh import DHConvention
from armik_sym.errors import OptionError
from armik_sym.pointwise.alfaiz.closed_form import evaluate, postures_at
from armik_sym.symbolic.alfaiz_closed_form import closed_form_fits

SIDES = list(itertools.product((1, -1), repeat=3))
SPECIAL = (0.0, np.pi / 2, -np.pi / 2, np.pi, 1e-9, -1e-5, 0.3, np.pi / 2 + 1e-8, np.pi / 2 - 1e-12)


def random_postures(n: int = 2000, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (n, 7))


def split(pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return pose[:, :3], pose[:, 3:].reshape(-1, 3, 3)


def phi_of(q: np.ndarray, pose: np.ndarray) -> np.ndarray:
    return np.arctan2(-pose[:, 0], pose[:, 2]) - q[:, 0]


@pytest.mark.parametrize("lengths", [(0.30, 0.24), (0.24, 0.30), (0.3, 0.3)])
@pytest.mark.parametrize("sides", SIDES)
def test_every_branch_reaches_the_pose_exactly(sides, lengths):
    arm = alfaiz(*lengths)
    q = random_postures()
    pose = poses(arm, q)
    found, exists = postures_at(arm, *split(pose), phi_of(q, pose), sides)
    assert exists.all()
    np.testing.assert_allclose(poses(arm, found), pose, rtol=0, atol=1e-12)


def test_branches_differ_and_one_is_the_posture_the_pose_was_made_of():
    arm, q = alfaiz(), random_postures()
    pose = poses(arm, q)
    found = np.array([postures_at(arm, *split(pose), phi_of(q, pose), sides)[0] for sides in SIDES])
    nearest = np.abs(turned(found - q)).max(axis=2).min(axis=0)
    regular = (np.abs(np.cos(q[:, [2, 5]])) > 0.01).all(axis=1) & (np.abs(np.sin(q[:, 3])) > 0.01)
    assert regular.mean() > 0.95
    assert nearest[regular].max() < 1e-9
    for a, b in itertools.combinations(found[:, regular], 2):
        assert np.abs(turned(a - b)).max(axis=1).min() > 1e-3


def test_the_signs_are_those_of_elbow_and_cosines():
    arm, q = alfaiz(), random_postures(300)
    pose = poses(arm, q)
    for sides in SIDES:
        found, _ = postures_at(arm, *split(pose), phi_of(q, pose), sides)
        signs = np.sign([found[:, 3], np.cos(found[:, 2]), np.cos(found[:, 5])])
        np.testing.assert_array_equal(signs, np.tile(sides, (300, 1)).T)


def test_phi_without_a_solution_is_told():
    arm, q = alfaiz(), random_postures()
    pose = poses(arm, q)
    phi = np.random.default_rng(1).uniform(-np.pi, np.pi, len(q))
    found, exists = postures_at(arm, *split(pose), phi)
    r = np.hypot(pose[:, 0], pose[:, 2])
    along = 0.30 + 0.24 * np.cos(q[:, 3])
    np.testing.assert_array_equal(exists, r * np.abs(np.cos(phi)) <= along)
    assert 0.2 < exists.mean() < 0.9
    np.testing.assert_allclose(poses(arm, found)[exists], pose[exists], rtol=0, atol=1e-12)
    assert np.isfinite(found).all()


@settings(max_examples=60, deadline=None)
@given(st.lists(st.sampled_from(SPECIAL), min_size=7, max_size=7), st.sampled_from([(0.3, 0.24), (0.3, 0.3)]))
def test_singular_places_stay_finite_and_reach_the_pose(angles, lengths):
    """At an edge of φ rounding of φ itself costs half the digits; the swivel angle knows no edges."""
    arm, q = alfaiz(*lengths), np.array([angles])
    pose = poses(arm, q)
    found = np.array([postures_at(arm, *split(pose), phi_of(q, pose), sides)[0][0] for sides in SIDES])
    assert np.isfinite(found).all()
    assert np.abs(poses(arm, found) - pose).max(axis=1).min() < 5e-8
    for side in (1.0, -1.0):
        for psi in (0.0, 0.7, -2.0, np.pi):
            np.testing.assert_allclose(poses(arm, at_swivel(arm, pose[0], side, psi)), pose, atol=1e-12)


def at_swivel(arm, pose: np.ndarray, side: float, psi: float) -> np.ndarray:
    """The posture at a swivel angle, shape (1, 7)."""
    curve = evaluate("alfaiz_curve", pose, arm.length_values, side)[0]
    parts = curve[1:].reshape(2, 3, 9)
    R = parts[:, 0] + parts[:, 1] * np.cos(psi) + parts[:, 2] * np.sin(psi)
    sides = evaluate("alfaiz_sides", R, (1.0, 0.0)).reshape(2, 3, 2)
    shoulder, wrist = np.arctan2(sides[..., 0], sides[..., 1])
    return np.concatenate([-shoulder, curve[:1], wrist])[None]


def test_swivel_and_phi_describe_the_same_postures():
    arm = alfaiz()
    rng = np.random.default_rng(2)
    for q in random_postures(100, seed=3):
        pose = poses(arm, q[None])
        side = float(rng.choice([-1, 1]))
        posture = at_swivel(arm, pose[0], side, rng.uniform(-np.pi, np.pi))
        np.testing.assert_allclose(poses(arm, posture), pose, rtol=0, atol=1e-12)
        sides = (int(side), *np.sign(np.cos(posture[0, [2, 5]])).astype(int))
        by_phi, exists = postures_at(arm, *split(pose), phi_of(posture, pose), sides)
        assert exists.all()
        np.testing.assert_allclose(turned(by_phi - posture), 0, atol=1e-9)


def test_the_quotients_in_lanes_are_those_of_the_exact_form():
    arm = alfaiz()
    pose = poses(arm, random_postures(1, seed=4))
    curve = evaluate("alfaiz_curve", pose, arm.length_values, 1.0)[0]
    for psi in np.linspace(-3, 3, 20):
        quotients = evaluate("alfaiz_quotients", curve, (np.cos(psi), np.sin(psi))).reshape(2, 3, 2)
        cosines = quotients[..., 1].copy()
        cosines[:, 1] = np.sqrt(cosines[:, 1])
        shoulder, wrist = np.arctan2(quotients[..., 0], cosines)
        posture = at_swivel(arm, pose[0], 1.0, psi)[0]
        angles = np.concatenate([-shoulder, wrist])
        np.testing.assert_allclose(turned(angles - posture[[0, 1, 2, 4, 5, 6]]), 0, atol=1e-9)


def test_rates_are_derivatives():
    rng = np.random.default_rng(5)
    R, dR, pole = rng.normal(size=9), rng.normal(size=9), (1.0, 0.0)
    step = 1e-6

    def angles(t: float) -> np.ndarray:
        sides = evaluate("alfaiz_sides", R + t * dR, pole).reshape(3, 2)
        return np.arctan2(sides[:, 0], sides[:, 1])

    difference = (angles(step) - angles(-step)) / (2 * step)
    np.testing.assert_allclose(evaluate("alfaiz_rates", R, dR, pole)[0], difference, atol=1e-7)


def test_out_of_reach_the_arm_points_at_the_target():
    arm = alfaiz()
    far = np.array([[0.5, -0.7, 0.4]])
    found, exists = postures_at(arm, far, np.eye(3)[None], np.array([np.pi / 2]))
    assert not exists.any()
    hand = poses(arm, found)[0, :3]
    np.testing.assert_allclose(hand, 0.54 * far[0] / np.linalg.norm(far), atol=1e-12)


def test_the_closed_form_fits_its_own_rows_only():
    arm = alfaiz()
    assert closed_form_fits(arm)
    assert closed_form_fits(alfaiz(0.2, 0.4))
    assert not closed_form_fits(ehmcs())
    base = np.eye(4)
    base[0, 3] = 0.1
    rows = list(arm.chain.links)
    other_rows = [*rows[:3], replace(rows[3], a=0.0), rows[4], replace(rows[5], alpha=-np.pi / 2), rows[6]]
    for chain in (
        replace(arm.chain, base=base),
        replace(arm.chain, tool=base),
        replace(arm.chain, convention=DHConvention.STANDARD),
        replace(arm.chain, links=(*rows[:5], other_rows[5], rows[6])),
        replace(arm.chain, links=(*rows[:6], replace(rows[6], sign=-1))),
    ):
        assert not closed_form_fits(replace(arm, chain=chain))
    shortened = replace(arm.chain, links=(*rows[:3], other_rows[3], *rows[4:]))
    assert not closed_form_fits(replace(arm, chain=shortened, lengths={"forearm": 0.24}))


def test_other_arms_are_refused_by_name():
    with pytest.raises(OptionError, match="ehmcs"):
        postures_at(ehmcs(), np.zeros((1, 3)), np.eye(3)[None], np.zeros(1))
