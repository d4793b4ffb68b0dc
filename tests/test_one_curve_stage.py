"""Joint angles along the curve: the pose is kept, coordinates agree, derivatives match 40-digit ones."""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest
from curve_problems import CHARTS, FIRST, MIDDLE, Curves, curves_of, unlimited, with_root
from hypothesis import given, settings
from hypothesis import strategies as st
from spherical_arms import ARMS, anywhere, apart, pose_error

from armik_sym.swivel.geometry import ELBOW_ZERO, pose_geometry
from armik_sym.swivel.postures_at import postures_at
from armik_sym.symbolic.dense_function import evaluate_rows
from armik_sym.trajectory.one_curve.parameters import curve_parameters
from armik_sym.trajectory.one_curve.stage import (
    BRANCH,
    OFFSET,
    PARTS,
    REFERENCE,
    SHOULDER,
    SIZE,
    SWIVEL,
    WRIST,
    curve_functions,
)

NEAR = (1e-2, 1e-4, 1e-6, 1e-8)
ROUNDING = 1e-12


def angles(chart: int, x: np.ndarray, rows: np.ndarray) -> np.ndarray:
    return evaluate_rows(curve_functions()[f"angles_{chart}"], np.asarray(x)[:, None], rows)


def second(chart: int, x: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Angles, slopes, curvatures, shape (n, 3, 7)."""
    values = evaluate_rows(curve_functions()[f"second_{chart}"], np.asarray(x)[:, None], rows)
    return values.reshape(-1, 3, 7)


def near_pole(name: str, group: int, distance: float, n: int = 40, seed: int = 0) -> np.ndarray:
    """Postures anywhere, but the middle joint of one group that far from a pole, on either side."""
    q = 0.6 * anywhere(n, seed)
    rng = np.random.default_rng(seed + 1)
    spherical = curves_of(ARMS[name], q[:1]).spherical
    offset = (spherical.shoulder, spherical.wrist)[group - 1].offset
    pole = np.pi * rng.integers(0, 2, n) - offset
    q[:, MIDDLE[group]] = (pole + np.pi) % (2 * np.pi) - np.pi + distance * rng.choice([-1, 1], n)
    return q


def straight(name: str, bend: float, n: int = 40, seed: int = 0) -> np.ndarray:
    """Postures with an elbow that is nearly straight."""
    q = 0.6 * anywhere(n, seed)
    zero = pose_geometry(curves_of(ARMS[name], q[:1]).spherical)[ELBOW_ZERO[0]]
    q[:, 3] = (bend - zero + np.pi) % (2 * np.pi) - np.pi
    return q


def at_coordinate(curves: Curves, chart: int) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of the postures, and rows with the root that leads to them."""
    if chart == SWIVEL:
        return curves.psi, curves.rows
    x = curves.q[:, FIRST[chart]]
    both = [with_root(curves.rows, root) for root in (1.0, -1.0)]
    away = [apart(angles(chart, x, rows), curves.q).max(axis=1) for rows in both]
    return x, np.where((away[0] < away[1])[:, None], *both)


def exists(curves: Curves, chart: int, least: float) -> np.ndarray:
    """Where the coordinate moves along the curve: its slope over ψ is no smaller than that."""
    if chart == SWIVEL:
        return np.ones(len(curves.q), dtype=bool)
    return np.abs(second(SWIVEL, curves.psi, curves.rows)[:, 1, FIRST[chart]]) >= least


# What is exact: the same curve with 40 digits, by another way.


def exact(row: np.ndarray, chart: int, psi: float) -> Callable[[mp.mpf], list[mp.mpf]]:
    """All angles as a function of the coordinate, textbook formulas; roots by iteration."""
    C = [[mp.matrix(3, 3) for _ in range(3)] for _ in range(2)]
    for i, value in enumerate(row[slice(*PARTS)]):
        C[i // 27][i // 9 % 3][i % 9 // 3, i % 3] = mp.mpf(float(value))

    def rotation(group: int, at: mp.mpf) -> mp.matrix:
        return C[group][0] + C[group][1] * mp.cos(at) + C[group][2] * mp.sin(at)

    def of(x: mp.mpf) -> list[mp.mpf]:
        at = x
        if chart != SWIVEL:
            v = lambda p: rotation(chart - 1, p)  # noqa: E731
            at = mp.findroot(lambda p: mp.sin(x) * v(p)[0, 2] - mp.cos(x) * v(p)[1, 2], mp.mpf(psi))
        out = []
        for group in range(2):
            Q, side = rotation(group, at), int(row[BRANCH[0] + group])
            if chart == group + 1:
                c, s = mp.cos(x), mp.sin(x)
                Q = mp.matrix([[c, s, 0], [-s, c, 0], [0, 0, 1]]) * Q
                three = [x, mp.atan2(Q[0, 2], Q[2, 2]), mp.atan2(Q[1, 0], Q[1, 1])]
            else:
                three = [
                    mp.atan2(side * Q[1, 2], side * Q[0, 2]),
                    mp.atan2(side * mp.sqrt(Q[0, 2] ** 2 + Q[1, 2] ** 2), Q[2, 2]),
                    mp.atan2(side * Q[2, 1], -side * Q[2, 0]),
                ]
            out += three if group else [*three, mp.mpf(0)]
        return out

    return of


def exact_derivatives(row: np.ndarray, chart: int, x: float, psi: float, scale: float) -> np.ndarray:
    """Slopes and curvatures by differences with a step of 10⁻¹² of the scale, in 50 digits."""
    with mp.workdps(50):
        of, step = exact(row, chart, psi), mp.mpf(10) ** -12 * mp.mpf(scale)
        before, at, after = (of(mp.mpf(x) + k * step) for k in (-1, 0, 1))
        near = lambda a, b: mp.atan2(mp.sin(a - b), mp.cos(a - b))  # noqa: E731
        left = [near(a, b) for a, b in zip(before, at, strict=True)]
        right = [near(a, b) for a, b in zip(after, at, strict=True)]
        pairs = list(zip(left, right, strict=True))
        slope = [float((b - a) / (2 * step)) for a, b in pairs]
        curvature = [float((a + b) / step**2) for a, b in pairs]
    return np.array([slope, curvature])


# The pose is kept.


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("chart", CHARTS)
def test_every_posture_of_the_curve_reaches_the_pose(name, chart):
    curves = curves_of(unlimited(name), anywhere(300, 1))
    x, rows = at_coordinate(curves, chart)
    assert apart(angles(chart, x, rows), curves.q).max() <= 1e-9
    # Anywhere else along the curve, where the coordinate still has a swivel angle.
    fit, far = exists(curves, chart, 0.3), 3.0 if chart == SWIVEL else 0.01
    assert fit.sum() > 100
    x = x + np.random.default_rng(2).uniform(-far, far, len(x))
    q = angles(chart, x, rows)[fit]
    assert pose_error(curves.arm, q, curves.position[fit], curves.rotation[fit]) <= ROUNDING
    if chart != SWIVEL:
        assert np.array_equal(q[:, FIRST[chart]], x[fit])


@pytest.mark.parametrize("distance", NEAR)
@pytest.mark.parametrize("group", [SHOULDER, WRIST])
def test_the_pose_is_kept_beside_a_pole_in_every_coordinate(group, distance):
    for name in ("human", "odd_standard"):
        curves = curves_of(unlimited(name), near_pole(name, group, distance))
        for chart in CHARTS:
            x, rows = at_coordinate(curves, chart)
            q = angles(chart, x, rows)
            assert pose_error(curves.arm, q, curves.position, curves.rotation) <= ROUNDING
            if chart in (SWIVEL, group):
                assert apart(q, curves.q).max() <= 1e-13 / distance + 1e-9


@pytest.mark.parametrize("bend", [0.0, 1e-8, 1e-4, -1e-4])
def test_the_pose_is_kept_at_the_straight_arm(bend):
    # Shoulder, wrist and elbow on a line: the pose itself leaves √eps of the bend open.
    for name in ("ehmcs", "odd_modified"):
        curves = curves_of(unlimited(name), straight(name, bend))
        for chart in CHARTS:
            x, rows = at_coordinate(curves, chart)
            fit = exists(curves, chart, 0.05)
            q = angles(chart, x, rows)[fit]
            if len(q):
                assert pose_error(curves.arm, q, curves.position[fit], curves.rotation[fit]) <= ROUNDING
            assert chart != SWIVEL or fit.all()


@pytest.mark.parametrize("name", ARMS)
def test_swivel_chart_gives_the_postures_of_the_intervals(name):
    """Also the same of all angles 2π apart, wherever the range of motion tells them apart."""
    q = ARMS[name].rom.random_postures(np.random.default_rng(3), 300)
    curves = curves_of(ARMS[name], q)
    rng, k = np.random.default_rng(4), len(curves.intervals.sample)
    row = rng.choice(k, min(k, 400), replace=False)
    sample, branch = curves.intervals.sample[row], curves.intervals.branch[row]
    start, end = curves.intervals.start[row], curves.intervals.end[row]
    psi = start + rng.uniform(0, 1, len(row)) * (end - start)
    found = postures_at(curves.intervals.curves, sample, branch, psi)
    rows = curve_parameters(curves.intervals, sample, branch, found.q)
    assert np.abs(angles(SWIVEL, psi, rows) - found.q).max() <= 1e-9


def test_angles_stay_within_half_a_turn_of_their_reference():
    curves = curves_of(unlimited("human"), anywhere(200, 5))
    rows = curves.rows.copy()
    turns = 2 * np.pi * np.random.default_rng(6).integers(-2, 3, (len(rows), 7))
    rows[:, slice(*REFERENCE)] += turns
    q, moved = angles(SWIVEL, curves.psi, curves.rows), angles(SWIVEL, curves.psi, rows)
    assert np.abs(moved - q - turns).max() <= 1e-12
    offset = np.zeros((len(rows), 7))
    offset[:, [1, 5]] = rows[:, slice(*OFFSET)]
    assert np.abs(moved - rows[:, slice(*REFERENCE)]).max() <= np.pi + 1e-12
    assert rows.shape[1] == SIZE


# Derivatives.


def worst(curves: Curves, chart: int, scale: float, rows_checked: int = 4) -> float:
    """Largest error of slopes and curvatures, relative to the natural size 1/scale and 1/scale²."""
    x, rows = at_coordinate(curves, chart)
    values = second(chart, x, rows)
    assert np.array_equal(values[:, 0], angles(chart, x, rows))
    errors = []
    for k in range(rows_checked):
        right = exact_derivatives(rows[k], chart, x[k], curves.psi[k], scale)
        size = np.maximum(np.array([[1 / scale], [1 / scale**2]]), np.abs(right).max(axis=1, keepdims=True))
        errors.append((np.abs(values[k, 1:] - right) / size).max())
    return max(errors)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("chart", CHARTS)
def test_derivatives_anywhere(name, chart):
    q = anywhere(12, 7)
    q[:, [1, 5]] *= 0.3
    assert worst(curves_of(unlimited(name), q), chart, 0.1) <= 1e-9


@pytest.mark.parametrize("distance", NEAR)
@pytest.mark.parametrize("group", [SHOULDER, WRIST])
def test_derivatives_beside_a_pole(group, distance):
    """Over ψ they grow like 1/distance and 1/distance²; over the joint angle they do not."""
    curves = curves_of(unlimited("human"), near_pole("human", group, distance, 6, 8))
    assert worst(curves, SWIVEL, distance) <= 1e-14 / distance + 1e-9
    assert worst(curves, group, 0.1) <= 1e-9


@pytest.mark.parametrize("group", [SHOULDER, WRIST])
def test_at_the_pole_the_joint_angle_is_as_good_a_coordinate_as_anywhere(group):
    """Outer angles turn against each other, or together, and everything else stands still."""
    curves = curves_of(unlimited("human"), near_pole("human", group, 0.0, 20, 9))
    x, rows = at_coordinate(curves, group)
    slope, curvature = second(group, x, rows)[:, 1:].swapaxes(0, 1)
    first = FIRST[group]
    assert np.abs(slope[:, first] - 1).max() <= 1e-12
    assert np.abs(np.abs(slope[:, first + 2]) - 1).max() <= 1e-6
    still = [j for j in range(7) if j not in (first, first + 1, first + 2)]
    assert np.abs(slope[:, still]).max() <= 1e-6
    assert np.isfinite(curvature).all()


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    exponent=st.floats(-8, 0),
    group=st.sampled_from([SHOULDER, WRIST]),
    name=st.sampled_from(sorted(ARMS)),
)
def test_every_coordinate_keeps_the_pose_and_the_slopes_agree(seed, exponent, group, name):
    """dq/dα = (dq/dψ)/(dα/dψ) wherever both coordinates exist."""
    distance = 10.0**exponent
    curves = curves_of(unlimited(name), near_pole(name, group, distance, 3, seed))
    x, rows = at_coordinate(curves, group)
    by_angle, by_psi = second(group, x, rows), second(SWIVEL, curves.psi, curves.rows)
    for values in (by_angle, by_psi):
        assert pose_error(curves.arm, values[:, 0], curves.position, curves.rotation) <= ROUNDING
    steepness = by_psi[:, 1, FIRST[group]]
    fit = np.abs(steepness) > 0.05 / distance  # elsewhere the curve turns round there: no coordinate
    expected = by_psi[fit, 1] / steepness[fit, None]
    assert np.abs(by_angle[fit, 1] - expected).max(initial=0) <= 1e-5
