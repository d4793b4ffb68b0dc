"""Knots, nodes and neighbours: where the global search looks."""

from __future__ import annotations

import numpy as np
import pytest
from random_trajectories import trajectory
from spherical_arms import poses
from swivel_problems import swivel_problem_of

from armik_sym.motion.hand_path import HandPath
from armik_sym.swivel.intervals import FeasibleIntervals
from armik_sym.trajectory.global_path.graph import search_graph
from armik_sym.trajectory.global_path.knots import knots, straight_arm_knots
from armik_sym.trajectory.global_path.neighbours import neighbours
from armik_sym.trajectory.global_path.nodes import Nodes, spread_nodes
from armik_sym.trajectory.global_path.search import WaySearch

FAMILIES = ("ordinary", "wide_and_long", "through_shoulder_pole", "wrist_singularity", "through_straight_arm")
TURN = 2 * np.pi


def distance_outside(intervals: FeasibleIntervals, sample: int, branch: int, psi: float) -> float:
    """How far an angle is from the nearest interval of its sample and branch."""
    least = np.inf
    for start, end in intervals.of(sample, branch):
        for turn in (-TURN, 0.0, TURN):
            least = min(least, max(start + turn - psi, psi - end - turn, 0.0))
    return float(least)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("number", [0, 1])
def test_nodes_lie_in_their_intervals_and_keep_the_pose(family: str, number: int) -> None:
    given = trajectory(family, number)
    problem = swivel_problem_of(given)
    chosen = np.unique(np.append(knots(given.path, 0.6)[::4], given.at))
    nodes = spread_nodes(problem.intervals, chosen, 0.08)
    assert (nodes.sample == chosen[nodes.layer]).all()
    assert (np.diff(nodes.layer) >= 0).all()
    np.testing.assert_array_equal(nodes.first, np.searchsorted(nodes.layer, np.arange(len(chosen) + 1)))
    # Right beside a pole rounding of an end turns joints by its square root.
    assert given.arm.rom.margin(nodes.q).min() > -1e-6
    outside = [
        distance_outside(problem.intervals, s, b, p)
        for s, b, p in zip(nodes.sample[::7], nodes.branch[::7], nodes.psi[::7], strict=True)
    ]
    assert max(outside) < 1e-9
    position, rotation = poses(given.arm, nodes.q)
    assert np.abs(position - given.path.position[nodes.sample]).max() < 1e-9
    assert given.path.rotation is not None
    assert np.abs(rotation - given.path.rotation[nodes.sample]).max() < 1e-9
    # Every interval has its ends among the nodes.
    ends = [
        (s, e) for s, e in zip(problem.intervals.sample, problem.intervals.end, strict=True) if s in chosen
    ]
    for sample, end in ends[::5]:
        assert np.abs(nodes.psi[nodes.sample == sample] - end).min() < 1e-12


def test_no_gap_between_nodes_is_wide() -> None:
    given = trajectory("ordinary", 3)
    problem = swivel_problem_of(given)
    nodes: Nodes = spread_nodes(problem.intervals, knots(given.path, 0.6), 0.08)
    same = (np.diff(nodes.layer) == 0) & (np.diff(nodes.branch) == 0)
    near = np.diff(nodes.psi) < 0.0801  # neighbours on one interval, not the next one
    assert (same & near).sum() > 0.9 * same.sum()
    assert np.quantile(np.abs(np.diff(nodes.q, axis=0))[same & near].max(axis=1), 0.9) < 0.2


def test_a_known_first_posture_is_the_only_node_of_its_layer() -> None:
    given = trajectory("ordinary", 2)
    problem = swivel_problem_of(given, first=given.q[0])
    graph = search_graph(problem, knots(given.path, 0.6))
    assert graph.nodes.first[1] == 1
    np.testing.assert_array_equal(graph.nodes.q[0], given.q[0])
    assert len(graph.cost) == len(graph.nodes.q)


@pytest.mark.parametrize("n", [2, 3, 30, 400])
def test_knots_begin_and_end_with_the_path_and_are_spread(n: int) -> None:
    time = 0.01 * np.arange(n)
    position = np.column_stack([np.sin(time), np.cos(time), time])
    path = HandPath(time, position, np.tile(np.eye(3), (n, 1, 1)))
    found = knots(path, 0.6)
    assert found[0] == 0
    assert found[-1] == n - 1
    assert (np.diff(found) > 0).all()
    if n == 400:
        step = np.linalg.norm(np.diff(position[found], axis=0), axis=1) / 0.6
        assert step.max() < 0.15 * 1.3
        assert np.diff(time[found]).max() < 0.15 + 0.011
        assert len(found) < n / 4


def test_straight_arm_knots_surround_the_straightest_sample() -> None:
    given = trajectory("through_straight_arm", 0)
    problem = swivel_problem_of(given)
    found = straight_arm_knots(problem.intervals)
    assert set(range(given.at - 1, given.at + 2)) <= set(found.tolist())
    assert straight_arm_knots(swivel_problem_of(trajectory("ordinary", 0)).intervals).size == 0


@pytest.mark.parametrize("family", FAMILIES)
def test_neighbours_are_postures_of_their_knots_near_the_way(family: str) -> None:
    given = trajectory(family, 1)
    problem = swivel_problem_of(given)
    graph = search_graph(problem, np.union1d(knots(given.path, 0.6), straight_arm_knots(problem.intervals)))
    way = WaySearch(graph.nodes, graph.cost, graph.edges, problem.library).cheapest()
    assert way is not None
    near = neighbours(problem, way, 0.04, 8)
    layer = np.repeat(np.arange(len(way.sample)), np.diff(near.first))
    np.testing.assert_array_equal(near.q[near.first[:-1]], way.q)
    assert np.diff(near.first).min() > 1
    assert np.diff(near.first).max() <= 255
    assert np.abs(near.q - way.q[layer]).max() < 0.7
    assert given.arm.rom.margin(near.q).min() > -1e-8
    position, rotation = poses(given.arm, near.q)
    assert given.path.rotation is not None
    assert np.abs(position - given.path.position[way.sample[layer]]).max() < 1e-8
    assert np.abs(rotation - given.path.rotation[way.sample[layer]]).max() < 1e-8
    if family == "through_shoulder_pole":
        assert any(np.unique(near.branch[layer == k]).size > 1 for k in range(len(way.sample)))
