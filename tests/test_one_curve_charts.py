"""Coordinates beside the poles: their bounds are the bounds over ψ, and every point is a posture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curve_problems import CHARTS, FIRST, MIDDLE, Curves, curves_of
from hypothesis import example, given, settings
from hypothesis import strategies as st
from random_trajectories import singular_angles, wider
from spherical_arms import ARMS, odd, pose_error

from armik_sym.arm import Arm, DHConvention
from armik_sym.symbolic.dense_function import evaluate_rows
from armik_sym.trajectory.one_curve.charts import Charts, choose_charts
from armik_sym.trajectory.one_curve.stage import SHOULDER, SWIVEL, WRIST, curve_functions

FREE_WRIST = wider(ARMS["human"], MIDDLE[WRIST], -115, 110)
POLES = {
    "shoulder of human": (ARMS["human"], SHOULDER),
    "shoulder of ehmcs": (ARMS["ehmcs"], SHOULDER),
    "shoulder of alfaiz": (ARMS["alfaiz"], SHOULDER),
    "wrist of human": (FREE_WRIST, WRIST),
    "wrist of odd": (odd(DHConvention.STANDARD), WRIST),
}
DISTANCES = (0.0, 1e-6, 1e-4, 1e-2)


def beside_pole(arm: Arm, group: int, distance: float, n: int = 120, seed: int = 0) -> Curves:
    """Postures inside the range of motion, that far from a pole."""
    rng = np.random.default_rng(seed)
    q = arm.rom.middle + 0.8 * arm.rom.width * rng.uniform(-0.5, 0.5, (n, 7))
    q[:, MIDDLE[group]] = rng.choice(singular_angles(arm, MIDDLE[group]), n) + distance * rng.choice(
        [-1, 1], n
    )
    return curves_of(arm, q[arm.rom.margin(q).min(axis=1) >= 0])


def values(name: str, chart: np.ndarray, x: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Angles (`angles`), or angles, slopes and curvatures (`second`), each sample in its own chart."""
    out = np.empty((len(x), 7 if name == "angles" else 21))
    for k in CHARTS:
        mine = np.flatnonzero(chart == k)
        if mine.size:
            out[mine] = evaluate_rows(curve_functions()[f"{name}_{k}"], x[mine, None], rows[mine])
    return out


def chosen(
    curves: Curves, wanted: np.ndarray | None = None, psi: np.ndarray | None = None, free: bool = False
) -> tuple[np.ndarray, np.ndarray, Charts]:
    """Bounds over ψ, and the coordinates chosen there."""
    lower, upper = curves.bounds()
    if free:
        lower, upper = np.full(len(lower), -np.inf), np.full(len(upper), np.inf)
    psi = np.clip(curves.psi if psi is None else psi, lower, upper)
    second = values("second", np.zeros(len(psi)), psi, curves.rows)
    wanted = curves.q if wanted is None else wanted
    charts = choose_charts(
        curves.rows, psi, lower, upper, second[:, :7], second[:, 7:14], wanted, curves.arm.rom
    )
    return lower, upper, charts


def along(charts: Charts, share: float) -> np.ndarray:
    """Coordinates that far from their lower to their upper bound; whole circles from -π to π."""
    lower, upper = np.maximum(charts.lower, -np.pi), np.minimum(charts.upper, np.pi)
    whole = np.isinf(charts.lower)
    lower, upper = np.where(whole, lower, charts.lower), np.where(whole, upper, charts.upper)
    return lower + share * (upper - lower)


@pytest.mark.parametrize("pole", POLES)
@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("off", [0.0, 0.1])
def test_every_point_between_the_bounds_is_a_feasible_posture(pole, distance, off):
    """Also where the posture wanted is not on the curve."""
    arm, group = POLES[pole]
    curves = beside_pole(arm, group, distance)
    noise = off * np.random.default_rng(1).uniform(-1, 1, curves.q.shape)
    lower, upper, charts = chosen(curves, curves.q + noise)
    assert (charts.chart == group).sum() > 0.5 * len(curves.q)
    assert np.all(charts.lower <= charts.upper)
    assert np.all((charts.lower <= charts.x) & (charts.x <= charts.upper))
    limited = arm.rom.width <= 2 * np.pi + 1e-9
    for share in np.linspace(0, 1, 9):
        x = along(charts, share)
        psi, q = charts.swivel_angles(x), values("angles", charts.chart, x, charts.rows)
        # A curve that only touches a pole, but for rounding, has its interval's end there: √eps.
        assert np.all((psi >= lower - 1e-6) & (psi <= upper + 1e-6))
        if distance:
            assert np.all((psi >= lower - 1e-9) & (psi <= upper + 1e-9))
        assert pose_error(arm, q, curves.position, curves.rotation) <= 1e-9
        assert arm.rom.margin(q)[:, limited].min() >= -1e-9


@pytest.mark.parametrize("pole", POLES)
@pytest.mark.parametrize("distance", DISTANCES)
def test_the_posture_wanted_is_found_again(pole, distance):
    arm, group = POLES[pole]
    curves = beside_pole(arm, group, distance)
    _, _, charts = chosen(curves)
    q = values("angles", charts.chart, charts.x, charts.rows)
    error = np.abs(q - curves.q).max(axis=1)
    by_psi = charts.chart == SWIVEL
    assert error[~by_psi].max() <= 2e-7
    if distance:
        assert error.max() <= 1e-9 / distance**0.5
    assert np.abs(charts.swivel_angles(charts.x) - curves.psi).max() <= (1e-9 if distance else 1e-6)
    # Swivel angles of other points come back as well.
    x = along(charts, 0.3)
    psi = charts.swivel_angles(x)
    again = values("angles", np.zeros(len(psi)), psi, curves.rows)
    away = np.abs(np.sin(again[:, [1, 5]] + curves.rows[:, 56:58])).min(axis=1) > 1e-3
    other = values("angles", charts.chart, x, charts.rows)
    turns = (again - other)[away] / (2 * np.pi)
    assert np.abs(turns - np.rint(turns)).max(initial=0) <= 1e-9


@pytest.mark.parametrize("pole", [name for name in POLES if "odd" not in name])
def test_bounds_of_the_coordinate_are_the_ends_of_the_interval_or_of_the_monotone_stretch(pole):
    """Against a dense scan of the first angle over ψ."""
    arm, group = POLES[pole]
    curves = beside_pole(arm, group, 1e-2, 60, 5)
    _, _, charts = chosen(curves, free=True)
    checked = 0
    for i in np.flatnonzero(charts.chart == group):
        psi = curves.psi[i] + np.linspace(-np.pi, np.pi, 40_001)
        C = charts.rows[i, 27 * (group - 1) : 27 * group].reshape(3, 3, 3)
        v = C[0, :2, 2] + np.outer(np.cos(psi), C[1, :2, 2]) + np.outer(np.sin(psi), C[2, :2, 2])
        angle = np.unwrap(np.arctan2(v[:, 1], v[:, 0]))
        slope = np.gradient(angle)
        middle = len(psi) // 2
        angle += charts.x[i] - angle[middle]
        turning = np.flatnonzero(np.diff(np.sign(slope)))
        before, after = turning[turning < middle], turning[turning >= middle]
        if not before.size or not after.size:
            assert not turning.size  # it turns all around the pole
            assert charts.upper[i] - charts.lower[i] > 1.5 * np.pi
            continue
        first, last = psi[before[-1]] + 1e-4, psi[after[0]] + 1e-4
        inset = 0.02 * (last - first)
        ends = np.sort(
            np.interp([min(first + inset, psi[middle]), max(last - inset, psi[middle])], psi, angle)
        )
        assert [charts.lower[i], charts.upper[i]] == pytest.approx(ends, abs=2e-3)
        assert charts.cut[:, i].all()
        checked += 1
    assert checked > 20


def test_a_curve_around_the_pole_has_no_turning_point():
    """There the first angle turns with ψ all the way: bounds are nearly a turn apart, and nothing jumps."""
    arm = ARMS["ehmcs"].with_rom(np.full(7, -3.1), np.full(7, 3.1))
    curves = beside_pole(arm, SHOULDER, 0.05, 200, 7)
    _, _, charts = chosen(curves, free=True)
    around = (charts.chart == SHOULDER) & (charts.upper - charts.lower > 1.8 * np.pi)
    assert around.sum() > 10
    x = np.array([along(charts, share) for share in np.linspace(0, 1, 200)])
    q = np.array([values("angles", charts.chart, each, charts.rows) for each in x])[:, around]
    psi = np.array([charts.swivel_angles(each) for each in x])[:, around]
    jump = np.abs(np.diff(np.unwrap(psi, axis=0), axis=0)).max()
    assert jump < 2.0
    assert np.all(np.abs(np.ptp(np.unwrap(psi, axis=0), axis=0) / (1.92 * np.pi) - 1) < 0.05)
    for each, at in zip(q, psi, strict=True):
        assert pose_error(arm, each, curves.position[around], curves.rotation[around]) <= 1e-12
        assert np.isfinite(at).all()


@pytest.mark.parametrize("pole", POLES)
def test_at_the_pole_bounds_are_the_limits_of_both_outer_joints_or_the_direction_of_the_curve(pole):
    """No room is given away: beyond each bound something ends."""
    arm, group = POLES[pole]
    curves = beside_pole(arm, group, 0.0)
    _, _, charts = chosen(curves)
    third = FIRST[group] + 2
    chart = charts.chart == group
    for x, cut in ((charts.lower, charts.cut[0]), (charts.upper, charts.cut[1])):
        q = values("angles", charts.chart, x, charts.rows)
        margin = arm.rom.margin(q)[:, [FIRST[group], third]].min(axis=1)
        assert np.all((np.abs(margin) <= 1e-9) | cut | ~chart)
    assert np.all(charts.upper - charts.lower <= np.pi + 1e-6)


def test_a_coordinate_cut_short_is_noticed_and_one_at_a_limit_is_not():
    curves = beside_pole(ARMS["human"], SHOULDER, 1e-2)
    _, _, charts = chosen(curves, free=True)
    special = charts.chart == SHOULDER
    assert not charts.stopped(along(charts, 0.5))
    assert charts.stopped(along(charts, 1.0))
    closed = replace(charts, cut=np.zeros_like(charts.cut))
    assert not closed.stopped(along(charts, 1.0))
    one = along(charts, 0.5)
    first = np.flatnonzero(special)[0]
    one[first] = charts.upper[first]
    assert charts.stopped(one)


def test_far_from_poles_the_swivel_angle_is_the_coordinate():
    rng = np.random.default_rng(3)
    q = ARMS["ehmcs"].rom.random_postures(rng, 300)
    q = q[(np.abs(np.cos(q[:, 1])) < 0.5) & (np.abs(np.cos(q[:, 5])) < 0.9)]
    curves = curves_of(ARMS["ehmcs"], q)
    lower, upper, charts = chosen(curves)
    slope = values("second", np.zeros(len(q)), curves.psi, curves.rows)[:, [7, 11]]
    gentle = np.abs(slope).max(axis=1) < 2
    assert gentle.sum() > 15
    assert np.all(charts.chart[gentle] == SWIVEL)
    assert np.array_equal(charts.lower[gentle], lower[gentle])
    assert np.array_equal(charts.upper[gentle], upper[gentle])
    assert np.array_equal(charts.x[gentle], np.clip(curves.psi, lower, upper)[gentle])


@settings(max_examples=50)
@example(5401, -7.0, "shoulder of human", 0.0, 0.0)
@example(168, -6.82663600581242, "shoulder of human", -0.5, 0.5)
@given(
    seed=st.integers(0, 10_000),
    exponent=st.floats(-7, -1),
    pole=st.sampled_from(sorted(POLES)),
    shift=st.floats(-0.5, 0.5),
    off=st.floats(0, 1.0),
)
def test_whatever_is_wanted_every_coordinate_is_sound(seed, exponent, pole, shift, off):
    """Swivel angles off the posture, wanted angles off the curve: bounds hold, poses are kept."""
    arm, group = POLES[pole]
    curves = beside_pole(arm, group, 10.0**exponent, 8, seed)
    if not len(curves.q):
        return
    noise = off * np.random.default_rng(seed).uniform(-1, 1, curves.q.shape)
    lower, upper, charts = chosen(curves, curves.q + noise, curves.psi + shift)
    limited = arm.rom.width <= 2 * np.pi + 1e-9
    assert np.isfinite(charts.x).all()
    for x in (charts.x, *(along(charts, share) for share in (0.0, 0.37, 1.0))):
        psi, q = charts.swivel_angles(x), values("angles", charts.chart, x, charts.rows)
        assert np.all((psi >= lower - 1e-8) & (psi <= upper + 1e-8))
        assert pose_error(arm, q, curves.position, curves.rotation) <= 1e-9
        # Where ψ is the coordinate, rounding of the pose (some 1e-15 of an interval's end) is seen in the
        # angles as many times larger as they turn faster than ψ there: up to 1e8 times, beside a pole.
        slope = values("second", np.zeros(len(psi)), psi, curves.rows)[:, 7:14]
        room = 1e-9 + 1e-14 * np.abs(slope).max(axis=1)
        assert np.all(arm.rom.margin(q)[:, limited] >= -room[:, None])
