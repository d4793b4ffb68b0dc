"""From a rough curve to the optimum: limits hold exactly, nothing leads further down, ψ and angles agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from curve_problems import BACKENDS, WEIGHTS, Curves, curves_of, library
from random_trajectories import trajectory
from smooth_motions import objective as plain
from smooth_motions import smooth_angles
from spherical_arms import ARMS, pose_error

from armik_sym.arm import Arm
from armik_sym.trajectory.one_curve import polish as module
from armik_sym.trajectory.one_curve.go_down import Down, go_down
from armik_sym.trajectory.one_curve.limits import Limits
from armik_sym.trajectory.one_curve.parameters import curve_parameters, wide_joints
from armik_sym.trajectory.one_curve.polish import Polished, polish
from armik_sym.trajectory.one_curve.problem import OneCurveProblem
from armik_sym.trajectory.one_curve.smoothness import Smoothness, smoothness


def settled(
    arm: Arm, q: np.ndarray, time: np.ndarray, backend: str = "c", aim: np.ndarray | None = None
) -> tuple[Curves, Down, Smoothness]:
    """The optimum without limits on rates, between the ends of the intervals the motion runs in."""
    curves = curves_of(arm, q, time_varying=True)
    psi = np.unwrap(curves.psi)
    lower, upper = curves.bounds(psi)
    smooth = smoothness(time, WEIGHTS, arm.rom.middle if aim is None else aim)
    rows = curve_parameters(curves.intervals, np.arange(len(q)), curves.branch, q)
    return curves, go_down(library(backend), rows, smooth, psi, lower, upper, q, arm.rom), smooth


def limits(curves: Curves, speed: float = np.inf, acceleration: float = np.inf) -> Limits:
    rates = np.full(7, speed), np.full(7, acceleration)
    return Limits(*rates, curves.arm.rom, wide_joints(curves.intervals))


def polished(curves: Curves, down: Down, smooth: Smoothness, time: np.ndarray, **rates: float) -> Polished:
    return polish(down, smooth, time, limits(curves, **rates), max_iterations=300)


def left_over(down: Down, x: np.ndarray) -> float:
    """Largest entry of the gradient that does not push out of the bounds, in a problem scaled for IPOPT."""
    at, charts = down.objective.derivatives(x), down.charts
    out = ((x <= charts.lower + 1e-7) & (at.gradient > 0)) | ((x >= charts.upper - 1e-7) & (at.gradient < 0))
    return float(np.abs(np.where(out, 0, at.gradient)).max())


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("name", ["ehmcs", "human"])
def test_the_optimum_without_limits(name, backend):
    arm, n = ARMS[name], 60
    q, time = smooth_angles(arm, n, 3), 0.05 * np.arange(n)
    curves, down, smooth = settled(arm, q, time, backend)
    found = polished(curves, down, smooth, time)
    assert found.result.converged
    assert found.broken == ()
    assert arm.rom.margin(found.q).min() >= -1e-9
    assert pose_error(arm, found.q, curves.position, curves.rotation) <= 1e-9
    assert left_over(down, found.result.x) <= 1e-5
    assert found.value == pytest.approx(plain(time, found.q, arm.rom.middle, WEIGHTS), rel=1e-9)
    assert found.value <= plain(time, q, arm.rom.middle, WEIGHTS)
    assert found.value <= down.value / smooth.scale * (1 + 1e-9)
    # ψ leads to the same angles.
    again = down.objective.value(down.charts.x)[1]
    assert again.shape == found.q.shape
    psi_only = curves_of(arm, found.q, time_varying=True).psi
    assert np.abs(np.sin(0.5 * (psi_only - found.psi))).max() <= 1e-7


@pytest.mark.parametrize("n", [2, 3, 4])
def test_paths_of_few_samples(n):
    arm = ARMS["ehmcs"]
    q, time = smooth_angles(arm, 30, 5)[:: 30 // n][:n], 0.4 * np.arange(n)
    curves, down, smooth = settled(arm, q, time)
    found = polished(curves, down, smooth, time)
    assert found.result.converged
    assert left_over(down, found.result.x) <= 1e-5
    assert pose_error(arm, found.q, curves.position, curves.rotation) <= 1e-9


def fastest(q: np.ndarray, time: np.ndarray, kind: str) -> float:
    """Largest speed or acceleration, by divided differences."""
    rate = np.diff(q, axis=0) / np.diff(time)[:, None]
    if kind == "acceleration":
        rate = np.diff(rate, axis=0) / (0.5 * (time[2:] - time[:-2]))[:, None]
    return float(np.abs(rate).max())


@pytest.mark.parametrize(("kind", "seed"), [("speed", 8), ("acceleration", 8), ("speed", 5)])
def test_limits_on_rates_hold_exactly_and_cost_something(kind, seed):
    arm, n = ARMS["ehmcs"], 80
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.03, 0.06, n))
    q = smooth_angles(arm, n, seed)
    # Drawn to a posture far away, the optimum swings more than the motion does.
    curves, down, smooth = settled(arm, q, time, aim=arm.rom.upper)
    free = polished(curves, down, smooth, time)
    limit = 0.98 * fastest(free.q, time, kind)
    found = polished(curves, down, smooth, time, **{kind: limit})
    assert found.result.converged
    assert found.broken == ()
    assert fastest(found.q, time, kind) <= limit  # not by a single bit more
    assert fastest(found.q, time, kind) >= 0.999 * limit  # and hardly more than asked for is given away
    assert free.value < found.value < 1.2 * free.value
    assert pose_error(arm, found.q, curves.position, curves.rotation) <= 1e-9


def test_a_limit_that_cannot_be_kept_is_reported():
    arm, n = ARMS["ehmcs"], 30
    q, time = smooth_angles(arm, n, 3), 0.05 * np.arange(n)
    curves, down, smooth = settled(arm, q, time)
    found = polished(curves, down, smooth, time, speed=0.01)
    assert not found.result.converged
    assert "speed" in found.broken


@pytest.mark.parametrize("family", ["through_shoulder_pole", "wrist_singularity"])
@pytest.mark.parametrize("number", [0, 3])
def test_motions_through_poles(family, number):
    """Where a motion passes a pole the first angle is the coordinate, and nothing jumps there."""
    case = trajectory(family, number)
    time = case.path.time
    curves, down, smooth = settled(case.arm, case.q, time)
    assert down.charts.chart.any()
    found = polished(curves, down, smooth, time)
    assert found.result.converged
    narrow = ~wide_joints(curves.intervals)
    assert case.arm.rom.margin(found.q)[:, narrow].min() >= -1e-9
    assert pose_error(case.arm, found.q, curves.position, curves.rotation) <= 1e-9
    assert found.value <= plain(time, case.q, case.arm.rom.middle, WEIGHTS) * (1 + 1e-6)
    assert np.abs(np.diff(found.q, axis=0)).max() <= 2 * np.abs(np.diff(case.q, axis=0)).max() + 0.1


def test_no_room_at_all():
    """Every sample held: the motion comes back as it is, and nobody asks IPOPT."""
    arm, n = ARMS["ehmcs"], 20
    q, time = smooth_angles(arm, n, 3), 0.05 * np.arange(n)
    curves, down, smooth = settled(arm, q, time)
    charts = replace(down.charts, lower=down.x, upper=down.x)
    found = polished(curves, replace(down, charts=charts), smooth, time)
    assert found.result.converged
    assert found.iterations == down.iterations
    assert np.array_equal(found.q, down.objective.value(down.x)[1])


@pytest.mark.parametrize("error", [KeyboardInterrupt, ZeroDivisionError])
def test_an_error_inside_ipopt_comes_out_as_it_was(error, monkeypatch, capfd):
    def wrong(self, inputs, outputs):
        raise error("boom")

    monkeypatch.setattr(OneCurveProblem, "_evaluate_gradient", wrong)
    arm, n = ARMS["ehmcs"], 20
    q, time = smooth_angles(arm, n, 3), 0.05 * np.arange(n)
    curves, down, smooth = settled(arm, q, time)
    with pytest.raises(error, match="boom"):
        polished(curves, down, smooth, time)
    assert capfd.readouterr() == ("", "")


def test_the_iterations_are_reported_and_a_report_that_stops_is_heard():
    arm, n = ARMS["ehmcs"], 40
    q, time = smooth_angles(arm, n, 3), 0.05 * np.arange(n)
    curves, down, smooth = settled(arm, q, time)
    told: list[int] = []
    polish(
        down,
        smooth,
        time,
        limits(curves),
        max_iterations=50,
        report=lambda iteration, violation: told.append(iteration),
    )
    assert told == list(range(len(told)))
    assert told

    def stop(iteration: int, violation: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        polish(down, smooth, time, limits(curves), max_iterations=50, report=stop)
    assert module.polish is polish
