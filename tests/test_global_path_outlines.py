"""The ways the global search hands on: as good as the optimum next to the generating motion."""

from __future__ import annotations

import numpy as np
import pytest
from random_trajectories import trajectory
from swivel_problems import swivel_problem_of
from test_global_path_corridor import way_of

from armik_sym.trajectory.global_path.change_shifts import with_shifted_changes
from armik_sym.trajectory.global_path.improve import improved
from armik_sym.trajectory.global_path.joined import joined
from armik_sym.trajectory.global_path.knots import knots
from armik_sym.trajectory.global_path.outlines import outlines
from armik_sym.trajectory.global_path.row_costs import part_of, row_costs
from armik_sym.trajectory.global_path.smoothed import smoothed
from armik_sym.trajectory.global_path.way_corridor import corridor_of, joint_guess
from armik_sym.trajectory.objective import objective
from armik_sym.trajectory.one_curve.smoothness import smoothness
from armik_sym.trajectory.options import TrajectoryOptions

# Without `improved` the optima of three of these are missed, without `joined` those of two.
HARD = (
    ("loops", 9),
    ("rests", 9),
    ("tight_limits", 6),
    ("wide_and_long", 3),
    ("wide_and_long", 19),
    ("ordinary", 1),
    ("through_shoulder_pole", 2),
    ("wrist_singularity", 4),
    ("near_straight_arm", 1),
)


@pytest.mark.parametrize(("family", "number"), HARD)
def test_the_best_way_is_as_good_as_the_generating_motion_smoothed(family: str, number: int) -> None:
    given = trajectory(family, number)
    problem = swivel_problem_of(given)
    found = outlines(problem)
    assert [each.value for each in found] == sorted(each.value for each in found)
    sample = found[0].way.sample
    smooth = smoothness(given.path.time[sample], problem.weights, problem.aim)
    ours = smoothed(problem, found[0].way, smooth)
    generating = smoothed(problem, way_of(problem, given, sample), smooth)
    assert ours.value <= 1.002 * generating.value
    assert corridor_of(problem, found[0].way).missed.max() < 0.02
    guess = joint_guess(problem, found[0].way)
    assert guess.shape == given.q.shape
    np.testing.assert_array_equal(guess[sample], found[0].way.q)


@pytest.mark.parametrize(("family", "number"), [("loops", 9), ("wide_and_long", 3), ("ordinary", 1)])
def test_c_and_numpy_find_the_same_ways(family: str, number: int) -> None:
    values = []
    for backend in ("c", "vm"):
        given = trajectory(family, number)
        problem = swivel_problem_of(given, backend)  # type: ignore[arg-type]
        values.append([each.value for each in outlines(problem, most=2)])
    assert values[0][0] == pytest.approx(values[1][0], rel=1e-4)


def test_a_known_first_posture_is_kept() -> None:
    given = trajectory("ordinary", 5)
    problem = swivel_problem_of(given, first=given.q[0])
    for each in outlines(problem):
        assert np.abs(each.way.q[0] - given.q[0]).max() < 1e-9


def test_nothing_is_made_worse_and_a_shifted_change_is_put_back() -> None:
    given = trajectory("through_shoulder_pole", 1)
    problem = swivel_problem_of(given)
    sample = np.union1d(knots(given.path, 0.6), given.at + np.arange(-4, 5))
    smooth = smoothness(given.path.time[sample], problem.weights, problem.aim)
    way = way_of(problem, given, sample)
    right = smoothed(problem, way, smooth)
    change = int(np.flatnonzero(np.diff(way.branch))[0])
    wrong_branch = way.branch.copy()
    wrong_branch[change + 1 : change + 3] = way.branch[change]
    wrong = smoothed(problem, type(way)(sample, wrong_branch, way.psi, way.q, 0.0), smooth)
    assert wrong.value > 1.001 * right.value
    repaired = with_shifted_changes(problem, wrong, smooth)
    assert repaired.value < right.value * (1 + 1e-4)
    better = improved(problem, wrong, smooth)
    assert better.value <= repaired.value
    assert joined(problem, [wrong, right, repaired], smooth).value <= min(right.value, repaired.value)


@pytest.mark.parametrize("n", [2, 3, 9])
def test_row_costs_add_up_to_the_objective(n: int) -> None:
    given = trajectory("ordinary", 0)
    time, q, aim = given.path.time[:n], given.q[:n], given.arm.rom.middle
    o = TrajectoryOptions()
    smooth = smoothness(time, (o.speed_weight, o.acceleration_weight, o.posture_weight), aim)
    rows = row_costs(q, smooth)
    assert rows.shape == (n,)
    assert rows.sum() == pytest.approx(objective(given.arm, time, q, o), rel=1e-10)
    np.testing.assert_allclose(row_costs(np.stack([q, 2 * q]), smooth)[0], rows)
    if n == 9:
        part = part_of(smooth, slice(2, 7))
        stretch = row_costs(q[2:7], part)
        np.testing.assert_allclose(stretch[2:4], rows[4:6])
