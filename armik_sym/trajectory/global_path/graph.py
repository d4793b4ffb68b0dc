"""The graph the global search runs on: nodes, what they cost, what the steps between them cost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.trajectory.global_path.elbow_change import elbow_angles, elbow_change_costs
from armik_sym.trajectory.global_path.nodes import Nodes, spread_nodes
from armik_sym.trajectory.global_path.shortest_path import Edges
from armik_sym.trajectory.rates import sample_durations
from armik_sym.trajectory.swivel_problem import SwivelProblem

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Distance between neighbouring nodes, in [rad].
_SPACING = 0.08
# What the distance between nodes may add to a step, in [rad].
_SLACK = 0.4
# A motion whose angular frequency is this makes the share of accelerations in the search's edges, in [1/s²].
_TYPICAL_FREQUENCY_SQUARED = 10.0


@dataclass(frozen=True, eq=False)
class Graph:
    """What the search runs on.

    Attributes:
        knots: Samples of the layers, shape (layers,).
        nodes: Postures in layers.
        cost: Cost of every node, shape (m,).
        edges: What steps cost.
    """

    knots: Indices
    nodes: Nodes
    cost: Array
    edges: Edges


def search_graph(problem: SwivelProblem, knots: Indices) -> Graph:
    """The graph over some samples of a problem.

    Args:
        problem: The problem.
        knots: Samples, increasing, the first and the last among them, shape (layers,).

    Returns:
        The graph; its first layer is the known posture alone if there is one.

    Source:
        None (this package).
    """
    nodes = spread_nodes(problem.intervals, knots, _SPACING, problem.backend)
    if problem.first is not None:
        nodes = nodes.with_first(*_branch_of_first(problem), problem.first)
    cost = node_costs(problem, nodes.q, nodes.sample, knots)
    return Graph(knots, nodes, cost, _edges(problem, knots))


def node_costs(problem: SwivelProblem, q: Array, sample: Indices, knots: Indices) -> Array:
    """What postures cost by themselves, for the share of time between knots that each stands for.

    Args:
        problem: The problem.
        q: Postures, shape (m, dof), in [rad].
        sample: Sample of each, one of the knots, shape (m,).
        knots: All samples the search looks at, shape (layers,).

    Returns:
        Shape (m,).

    Source:
        None (the objective's own terms).
    """
    shares = sample_durations(problem.path.time[knots])[np.searchsorted(knots, sample)]
    cost = 0.5 * problem.weights[2] * shares * np.square(q - problem.aim).sum(axis=1)
    if problem.posture_cost is not None:
        cost = cost + shares * problem.posture_cost.evaluate(q)
    return np.asarray(cost)


def most_per_step(problem: SwivelProblem, knots: Indices) -> Array:
    """How far each joint may move between neighbouring knots.

    Args:
        problem: The problem.
        knots: Samples, shape (layers,).

    Returns:
        Shape (layers - 1, dof), in [rad].

    Source:
        None (definition).
    """
    return np.outer(np.diff(problem.path.time[knots]), problem.limits.max_speed) + _SLACK


def _branch_of_first(problem: SwivelProblem) -> tuple[int, int, float]:
    """Branch, side of the elbow and swivel angle of the known posture."""
    spherical = problem.intervals.curves[0].spherical
    known = swivel_of_postures(spherical, np.asarray(problem.first)[None], problem.reference[:1])
    signs = np.array([known.elbow[0], known.shoulder[0], known.wrist[0]])
    branch = int(problem.intervals.branch_of(signs[None])[0])
    return branch, int(known.elbow[0] < 0), float(known.psi[0])


def _edges(problem: SwivelProblem, knots: Indices) -> Edges:
    time, weights = problem.path.time, problem.weights
    weight = weights[0] + _TYPICAL_FREQUENCY_SQUARED * weights[1]
    return Edges(
        weight=max(weight, 1e-6) / np.diff(time[knots]),
        most=most_per_step(problem, knots),
        turns=turning_joints(problem),
        change=elbow_change_costs(elbow_angles(problem.intervals), time, knots, weights[1]),
    )


def turning_joints(problem: SwivelProblem) -> NDArray[np.bool_]:
    """Joints that can turn by more than a full turn: they take the shorter way round.

    Args:
        problem: The problem.

    Returns:
        Shape (dof,).

    Source:
        None (definition).
    """
    return np.asarray(problem.arm.rom.width > 2 * np.pi + 1e-6)
