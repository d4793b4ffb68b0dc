"""From ways at knots to corridors at all samples, and postures between knots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from random_trajectories import RandomTrajectory, trajectory
from spherical_arms import poses
from swivel_problems import swivel_problem_of

from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.trajectory.global_path.between import nearest_on_branch, reassigned, with_samples
from armik_sym.trajectory.global_path.corridor import corridor, interpolated
from armik_sym.trajectory.global_path.search import Way
from armik_sym.trajectory.swivel_problem import SwivelProblem

TURN = 2 * np.pi


def way_of(problem: SwivelProblem, given: RandomTrajectory, sample: np.ndarray) -> Way:
    """The generating motion as a way."""
    at = swivel_of_postures(problem.intervals.curves[0].spherical, given.q, problem.reference)
    signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
    branch = (signs[:, None] == problem.intervals.branches).all(axis=2).argmax(axis=1)
    return Way(sample, branch[sample], np.unwrap(at.psi[sample]), given.q[sample], 0.0)


def everything(given: RandomTrajectory) -> np.ndarray:
    return np.arange(len(given.path))


@pytest.mark.parametrize("backend", ["c", "vm"])
@pytest.mark.parametrize("family", ["ordinary", "wide_and_fast", "through_shoulder_pole"])
def test_corridor_of_a_feasible_motion_holds_it(family: str, backend: str) -> None:
    given = trajectory(family, 4)
    problem = swivel_problem_of(given, backend)  # type: ignore[arg-type]
    way = way_of(problem, given, everything(given))
    found = corridor(problem.intervals, way.branch, way.psi, way.q, problem.backend)
    assert found.missed.max() < 1e-6
    assert (found.lower <= way.psi + 1e-6).all()
    assert (found.upper >= way.psi - 1e-6).all()
    np.testing.assert_allclose(found.psi, way.psi, atol=1e-6)
    part = everything(given)[3::4]
    less = corridor(
        problem.intervals, way.branch[part], way.psi[part], way.q[part], problem.backend, samples=part
    )
    for name in ("psi", "lower", "upper", "missed", "branch"):
        np.testing.assert_array_equal(getattr(less, name), getattr(found, name)[part])


def test_corridor_says_how_far_an_angle_is_outside() -> None:
    given = trajectory("tight_limits", 0)
    problem = swivel_problem_of(given)
    way = way_of(problem, given, everything(given))
    inside = corridor(problem.intervals, way.branch, way.psi, way.q)
    rows = np.flatnonzero(inside.upper - inside.lower < 2.0)
    outside = way.psi.copy()
    outside[rows] = inside.upper[rows] + 0.05
    found = corridor(problem.intervals, way.branch, outside, way.q)
    same = rows[found.upper[rows] == inside.upper[rows]]
    assert same.size > 0.5 * len(given.path)
    np.testing.assert_allclose(found.missed[same], 0.05, atol=1e-9)
    np.testing.assert_array_equal(found.psi[same], inside.upper[same])
    empty = int(np.flatnonzero(problem.intervals.empty.all(axis=0))[0])
    assert np.isinf(corridor(problem.intervals, empty, way.psi, way.q).missed).all()


@pytest.mark.parametrize("number", [3, 7])
def test_whole_turns_of_a_joint_that_can_make_them_are_no_distance(number: int) -> None:
    given = trajectory("wide_and_long", number)
    arm, wide = given.arm, 6
    assert arm.name.startswith("odd")
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    upper[wide] = lower[wide] + TURN + 0.5
    given = replace(given, arm=arm.with_rom(lower, upper))
    problem = swivel_problem_of(given)
    way = way_of(problem, given, everything(given))
    rng = np.random.default_rng(number)
    psi = way.psi + rng.uniform(-1.5, 1.5, len(way.psi))
    turned = way.q + TURN * rng.integers(-2, 3, (len(way.q), 1)) * (np.arange(7) == wide)
    by = corridor(problem.intervals, way.branch, psi, way.q)
    found = corridor(problem.intervals, way.branch, psi, turned)
    np.testing.assert_allclose(found.psi, by.psi, atol=1e-12)
    args = problem.intervals, problem.reference, problem.backend
    for k in range(0, len(way.q), 5):
        there = nearest_on_branch(k, int(way.branch[k]), way.q[k], *args)
        np.testing.assert_allclose(
            nearest_on_branch(k, int(way.branch[k]), turned[k], *args), there, atol=1e-9
        )


def test_interpolation_meets_its_points_never_overshoots_and_stops_where_the_branch_changes() -> None:
    time = np.cumsum(np.random.default_rng(0).uniform(0.5, 1.5, 41))
    sample = np.array([0, 7, 15, 16, 30, 40])
    psi = np.array([0.0, 1.0, 1.2, 4.0, 4.1, 3.9])
    branch = np.array([0, 0, 0, 5, 5, 5])
    found = interpolated(time, sample, psi, branch)
    np.testing.assert_allclose(found[sample], psi)
    assert (np.diff(found[:16]) >= 0).all()
    assert found[:16].max() <= 1.2
    assert found[16:].min() >= 3.9 - 1e-12
    assert found[16:].max() <= 4.1 + 1e-12
    last_of_branch = interpolated(time, np.array([0, 10, 40]), np.array([0.0, 1.0, 9.0]), np.array([0, 0, 1]))
    assert (last_of_branch[10:40] == 1.0).all()


@pytest.mark.parametrize("family", ["ordinary", "through_shoulder_pole", "through_straight_arm"])
def test_samples_added_to_a_way_are_exact_postures_near_the_line(family: str) -> None:
    given = trajectory(family, 1)
    problem = swivel_problem_of(given)
    n = len(given.path)
    sample = np.unique(np.append(np.arange(0, n, 3), n - 1))
    way = way_of(problem, given, sample)
    further = np.setdiff1d(everything(given), sample)
    more, away = with_samples(
        way, further, given.path.time, problem.intervals, problem.reference, problem.backend
    )
    np.testing.assert_array_equal(more.sample, everything(given))
    np.testing.assert_array_equal(more.q[sample], way.q)
    assert away.max() < 0.1
    # The posture a swivel angle stands for is as near to the line as it is said to be, and has the pose.
    curves = problem.intervals.curves
    for k, off in list(zip(further, away, strict=True))[::5]:
        e, s, w = problem.intervals.branches[more.branch[k]]
        curve = curves[0] if e > 0 else curves[1]
        q = curve.rows(np.array([k])).postures(more.psi[k : k + 1], s, w).q
        assert np.abs(q - more.q[k]).max() == pytest.approx(off, abs=1e-6)
        assert np.abs(poses(given.arm, q)[0] - given.path.position[k]).max() < 1e-9


def test_a_sample_on_the_wrong_side_of_a_pole_is_put_right() -> None:
    given = trajectory("through_shoulder_pole", 1)
    problem = swivel_problem_of(given)
    way = way_of(problem, given, everything(given))
    changes = np.flatnonzero(np.diff(way.branch))
    assert changes.size
    row = int(changes[0]) + 1
    wrong = way.branch.copy()
    wrong[row] = way.branch[row - 1]
    q = way.q.copy()
    q[row, :3] += 0.05  # where it is held on the wrong branch
    found = reassigned(
        way.sample,
        q,
        wrong,
        np.zeros(0, dtype=np.int64),
        given.path.time,
        problem.intervals,
        problem.reference,
        problem.backend,
    )
    assert found.branch[row] == way.branch[row]
    psi, away = nearest_on_branch(
        row, int(way.branch[row]), way.q[row], problem.intervals, problem.reference, problem.backend
    )
    assert away < 0.03
    assert abs(np.angle(np.exp(1j * (found.psi[row] - psi)))) < 0.1
    # A motion that is right already stays.
    unchanged = reassigned(
        way.sample,
        way.q,
        way.branch,
        changes,
        given.path.time,
        problem.intervals,
        problem.reference,
        problem.backend,
    )
    assert (unchanged.branch != way.branch).sum() <= 1
