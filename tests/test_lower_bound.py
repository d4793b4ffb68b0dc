"""The certified lower bound: never above a feasible trajectory, and near the best one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lower_bound_instances import intervals_along, motion, objective, posture_at, random_feasible
from spherical_arms import ARMS, poses

import armik_sym as ak
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.errors import OptionError, ShapeError
from armik_sym.motion.tasks import load_task, task_names
from armik_sym.solution.lower_bound import LowerBound
from armik_sym.swivel.closed_form import position_curve
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals, intervals_of_curves
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.trajectory.lower_bound import lower_bound

DEFAULT = (1.0, 0.01, 1e-3)
WEIGHTS = [DEFAULT, (1.0, 0.0, 0.0), (0.0, 0.01, 1e-3), (0.0, 0.0, 1.0), (0.2, 0.1, 3.0), (1.0, 0.01, 0.0)]


def bound(
    intervals: FeasibleIntervals,
    time: np.ndarray,
    q: np.ndarray,
    weights: tuple[float, float, float] = DEFAULT,
    **more: object,
) -> LowerBound:
    speed, acceleration, posture = weights
    options = {"gap": 0.05, "most_pairs": 300_000, **more}
    return lower_bound(
        intervals,
        time,
        q,
        speed_weight=speed,
        acceleration_weight=acceleration,
        posture_weight=posture,
        **options,
    )


@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(list(ARMS)), st.integers(0, 10_000), st.sampled_from(WEIGHTS), st.sampled_from([5, 20])
)
def test_no_feasible_trajectory_is_below(
    name: str, seed: int, weights: tuple[float, float, float], n: int
) -> None:
    """From whatever trajectory it is computed, smooth or not: the others cost at least as much."""
    rng = np.random.default_rng(seed)
    arm = ARMS[name]
    time, q = motion(arm, rng, n, rng.uniform(0.2, 2.0))
    intervals = intervals_along(arm, q)
    trajectories = [q, *(random_feasible(intervals, q, rng, jump) for jump in (0.0, 0.0, 0.0, 0.1, 1.0))]
    for each in trajectories:
        p, R = poses(arm, each)
        assert np.abs(p - poses(arm, q)[0]).max() < 1e-9
        assert np.abs(R - poses(arm, q)[1]).max() < 1e-9
        assert arm.rom.margin(each).min() > -1e-9
    rest = arm.rom.middle
    costs = [objective(time, each, rest, *weights) for each in trajectories]
    for reference in (0, 1, 5):
        found = bound(intervals, time, trajectories[reference], weights, most_pairs=50_000)
        assert 0 <= found.value <= min(costs)
        assert found.objective == pytest.approx(costs[reference], rel=1e-9)
        assert 0 <= found.gap <= 1


@pytest.mark.parametrize("name", ["ehmcs", "human", "odd_modified"])
def test_optima_are_not_below_and_near(name: str) -> None:
    rng = np.random.default_rng(14)
    arm = ARMS[name]
    time, q = motion(arm, rng, 40, 1.0)
    intervals = intervals_along(arm, q)
    solved = ak.solve(arm, ak.HandPath(time, *poses(arm, q)), start=q[0]).q
    best = min(objective(time, each, arm.rom.middle, *DEFAULT) for each in (q, solved))
    for reference in (q, solved):
        assert bound(intervals, time, reference).value <= best * (1 + 1e-9)
    assert bound(intervals, time, solved).gap <= 0.05


def grid_optimum(
    intervals: FeasibleIntervals, time: np.ndarray, weights: tuple[float, float, float], count: int
) -> tuple[float, np.ndarray]:
    """The best trajectory over a grid of swivel angles on all branches, by dynamic programming over pairs."""
    arm = intervals.curves[0].spherical.arm
    rest = arm.rom.middle
    layers = []
    for k in range(len(time)):
        rows = np.flatnonzero(intervals.sample == k)
        layers.append(
            np.array(
                [
                    posture_at(intervals, k, int(intervals.branch[i]), psi)
                    for i in rows
                    for psi in np.linspace(intervals.start[i], intervals.end[i], count)
                ]
            )
        )
    speed, acceleration, posture = weights
    h = np.diff(time)
    durations = 0.5 * (np.append(h, 0) + np.append(0, h))

    def node(k: int) -> np.ndarray:
        return 0.5 * posture * durations[k] * np.square(layers[k] - rest).sum(axis=1)

    def edge(k: int) -> np.ndarray:
        return 0.5 * speed / h[k] * np.square(layers[k + 1][None] - layers[k][:, None]).sum(axis=2)

    cost, back = node(0)[:, None] + edge(0) + node(1), []
    for k in range(2, len(time)):
        v = (layers[k][None] - layers[k - 1][:, None]) / h[k - 1]
        u = (layers[k - 1][None] - layers[k - 2][:, None]) / h[k - 2]
        s = 0.5 * (h[k - 2] + h[k - 1])
        uv = np.einsum("abi,bci->abc", u, v)
        bend = np.square(u).sum(axis=2)[:, :, None] + np.square(v).sum(axis=2)[None] - 2 * uv
        total = cost[:, :, None] + 0.5 * acceleration / s * bend
        back.append(total.argmin(axis=0))
        cost = total.min(axis=0) + edge(k - 1) + node(k)
    b, c = np.unravel_index(np.argmin(cost), cost.shape)
    way = [int(c), int(b)]
    for choice in reversed(back):
        way.append(int(choice[way[-1], way[-2]]))
    return float(cost.min()), np.array([layer[i] for layer, i in zip(layers, reversed(way), strict=True)])


@pytest.mark.parametrize(("name", "seed"), [("ehmcs", 1), ("human", 5), ("odd_standard", 3)])
@pytest.mark.parametrize("weights", [DEFAULT, (1.0, 0.0, 1e-3)])
def test_against_brute_force_over_all_branches(
    name: str, seed: int, weights: tuple[float, float, float]
) -> None:
    arm = ARMS[name]
    time, q = motion(arm, np.random.default_rng(seed), 8, 2.0)
    intervals = intervals_along(arm, q)
    best, way = grid_optimum(intervals, time, weights, 40)
    assert best == pytest.approx(objective(time, way, arm.rom.middle, *weights), rel=1e-9)
    speed, acceleration, posture = weights
    solved = ak.solve(
        arm,
        ak.HandPath(time, *poses(arm, q)),
        speed_weight=speed,
        acceleration_weight=acceleration,
        posture_weight=posture,
    ).q
    cost = objective(time, solved, arm.rom.middle, *weights)
    for reference in (way, solved):
        found = bound(intervals, time, reference, weights, gap=0.01, most_pairs=3_000_000)
        assert found.value <= min(best, cost)
    assert found.value >= 0.97 * min(best, cost)


@pytest.mark.parametrize("name", task_names())
def test_gap_of_the_bundled_tasks(name: str) -> None:
    task = load_task(name)
    arm = ehmcs()
    spherical = recognise(arm)
    position, rotation = task.path.position, task.path.rotation
    assert rotation is not None
    reference = transported_reference(spherical, wrist_directions(spherical, position, rotation))
    intervals = feasible_intervals(spherical, position, rotation, reference)
    solution = ak.solve(arm, task.path)
    found = lower_bound(intervals, task.path.time, solution.q, gap=0.02)
    assert found.gap <= 0.02
    assert found.suspect is None
    assert found.value <= objective(task.path.time, solution.q, arm.rom.middle, *DEFAULT)
    assert found.value <= objective(task.path.time, task.measured.q, arm.rom.middle, *DEFAULT) * 1.01
    assert f"{found.value:.6g}" in found.certified


def test_more_work_never_lowers_the_bound() -> None:
    arm = human()
    time, q = motion(arm, np.random.default_rng(21), 40, 1.0)
    intervals = intervals_along(arm, q)
    q = ak.solve(arm, ak.HandPath(time, *poses(arm, q)), start=q[0]).q
    values = [
        bound(intervals, time, q, gap=0.01, most_pairs=pairs).value
        for pairs in (1, 10_000, 10**5, 10**6, 10**7)
    ]
    assert values == sorted(values)
    assert values[-1] > values[0]
    finer = [bound(intervals, time, q, gap=gap, most_pairs=10**7).gap for gap in (0.2, 0.05, 0.01)]
    assert all(found <= gap for found, gap in zip(finer, (0.2, 0.05, 0.01), strict=True))


def test_a_poor_trajectory_is_found_out() -> None:
    """Where one far better exists, the gap says so, and the suspect leads nearer to it."""
    arm = ehmcs()
    rng = np.random.default_rng(4)
    time, q = motion(arm, rng, 40, 1.0)
    intervals = intervals_along(arm, q)
    poor = random_feasible(intervals, q, rng, 0.0)
    solved = ak.solve(arm, ak.HandPath(time, *poses(arm, q)), start=q[0]).q
    costs = [objective(time, each, arm.rom.middle, *DEFAULT) for each in (poor, solved)]
    assert costs[1] < 0.8 * costs[0]
    found = bound(intervals, time, poor)
    assert found.value <= costs[1]
    assert found.gap > 0.2
    assert found.suspect is not None
    assert found.suspect.shape == q.shape
    assert arm.rom.margin(found.suspect).min() >= 0
    assert np.abs(found.suspect - solved).mean() < np.abs(poor - solved).mean()


def test_a_known_first_posture_raises_the_bound() -> None:
    arm = ehmcs()
    rng = np.random.default_rng(6)
    time, q = motion(arm, rng, 30, 2.0)
    intervals = intervals_along(arm, q)
    free = ak.solve(arm, ak.HandPath(time, *poses(arm, q))).q
    away = random_feasible(intervals, free, rng, 0.0)
    tied = ak.solve(arm, ak.HandPath(time, *poses(arm, q)), start=away[0], max_speed=None).q
    known = bound(intervals, time, tied, known_first=True)
    cost = objective(time, tied, arm.rom.middle, *DEFAULT)
    assert known.value <= cost * (1 + 1e-9)
    assert bound(intervals, time, tied).value <= objective(time, free, arm.rom.middle, *DEFAULT) * (1 + 1e-9)
    assert known.gap <= 0.05
    assert "begins with the same posture" in known.certified
    assert "begins with" not in bound(intervals, time, tied).certified
    moved = random_feasible(intervals, tied, rng, 0.0)
    moved[0] = tied[0]
    assert known.value <= objective(time, moved, arm.rom.middle, *DEFAULT)


def test_other_costs_count_in_the_gap_only() -> None:
    arm = ehmcs()
    time, q = motion(arm, np.random.default_rng(8), 20, 1.0)
    intervals = intervals_along(arm, q)
    plain = bound(intervals, time, q)
    more = bound(intervals, time, q, other_cost=1.5)
    assert more.value == plain.value
    assert more.objective == pytest.approx(plain.objective + 1.5)


def test_a_preferred_posture_takes_the_place_of_mid_range() -> None:
    arm = ehmcs()
    rng = np.random.default_rng(9)
    time, q = motion(arm, rng, 12, 1.0)
    intervals = intervals_along(arm, q)
    preferred = arm.rom.random_postures(rng, 1)[0]
    found = bound(intervals, time, q, (1.0, 0.01, 2.0), preferred=preferred)
    assert found.objective == pytest.approx(objective(time, q, preferred, 1.0, 0.01, 2.0))
    for _ in range(5):
        other = random_feasible(intervals, q, rng, 0.0)
        assert found.value <= objective(time, other, preferred, 1.0, 0.01, 2.0)


def test_wide_joints_locked_joints_and_resting_arms() -> None:
    rng = np.random.default_rng(10)
    wide = alfaiz().with_rom(1.3 * alfaiz().rom.lower, 1.3 * alfaiz().rom.upper)
    time, q = motion(wide, rng, 6, 0.5)
    q[:, 0] += np.linspace(0, 1.0, 6)
    q = wide.rom.clip(q)
    turned = q.copy()
    turned[:, 4] += np.where(q[:, 4] < 0, 2 * np.pi, -2 * np.pi)
    intervals = intervals_along(wide, q)
    costs = [objective(time, q, wide.rom.middle, *DEFAULT)]
    if wide.rom.margin(turned).min() >= 0:
        costs.append(objective(time, turned, wide.rom.middle, *DEFAULT))
    assert bound(intervals, time, q).value <= min(costs)

    arm = human()
    time, q = motion(arm, rng, 10, 0.5)
    q[:, 2] = 0.2
    rom = arm.rom
    locked = arm.with_rom(*(np.where(np.arange(7) == 2, 0.2, limit) for limit in (rom.lower, rom.upper)))
    found = bound(intervals_along(locked, q), time, q)
    assert found.value <= found.objective

    still = np.tile(arm.rom.middle, (5, 1))
    resting = bound(intervals_along(arm, still), np.arange(5.0), still)
    assert (resting.value, resting.objective, resting.gap) == (0, 0, 0)


def test_a_path_next_to_the_pole_of_the_shoulder() -> None:
    """Postures at the pole have no bound of their rates; the samples around them still give one."""
    arm = alfaiz().with_rom(0.8 * alfaiz().rom.lower, 0.8 * alfaiz().rom.upper)
    n = 40
    time = np.linspace(0, 1, n)
    q = np.tile([0.3, 0.0, 0.2, 1.2, 0.1, 0.9, 0.1], (n, 1))
    offset = recognise(arm).shoulder.offset
    q[:, 1] = np.linspace(-0.4, 0.6, n) - offset
    q[:, 3] += 0.4 * np.sin(3 * time)
    q = arm.rom.clip(q)
    intervals = intervals_along(arm, q)
    found = bound(intervals, time, q, most_pairs=2_000_000)
    costs = [objective(time, q, arm.rom.middle, *DEFAULT)]
    rng = np.random.default_rng(0)
    costs += [
        objective(time, random_feasible(intervals, q, rng, 0.0), arm.rom.middle, *DEFAULT) for _ in range(5)
    ]
    assert 0 < found.value <= min(costs)


def test_samples_near_in_time_and_samples_out_of_reach() -> None:
    arm = ehmcs()
    rng = np.random.default_rng(12)
    time, q = motion(arm, rng, 15, 1.0)
    time[7] = time[6] + 1e-9
    found = bound(intervals_along(arm, q), time, q)
    assert 0 <= found.value <= found.objective
    time = np.linspace(0, 1, 15)
    position, rotation = poses(arm, q)
    position[5] += 3.0
    intervals = feasible_intervals(recognise(arm), position, rotation)
    assert intervals.empty[5].all()
    holed = bound(intervals, time, q)
    assert 0 <= holed.value <= objective(time, q, arm.rom.middle, *DEFAULT)


def test_what_makes_no_sense_is_refused() -> None:
    arm = ehmcs()
    time, q = motion(arm, np.random.default_rng(13), 5, 1.0)
    intervals = intervals_along(arm, q)
    with pytest.raises(ShapeError, match="two samples"):
        lower_bound(intervals, time[:4], q)
    with pytest.raises(ShapeError):
        lower_bound(intervals, time, q[:, :6])
    for bad in ({"gap": 0.0}, {"most_pairs": -1}, {"speed_weight": -1.0}, {"other_cost": np.nan}):
        with pytest.raises(OptionError, match=next(iter(bad))):
            lower_bound(intervals, time, q, **bad)
    with pytest.raises(OptionError, match="increase"):
        lower_bound(intervals, time[::-1], q)
    with pytest.raises(OptionError, match="finite"):
        lower_bound(intervals, time, np.full_like(q, np.nan))
    spherical = recognise(arm)
    position, _ = poses(arm, q)
    curves = [position_curve(spherical, position, q[:, 4:], side) for side in (1, -1)]
    with pytest.raises(OptionError, match="positions"):
        lower_bound(intervals_of_curves((curves[0], curves[1])), time, q)
    with pytest.raises(ShapeError, match="preferred"):
        lower_bound(intervals, time, q, preferred=[0.0, 1.0])
