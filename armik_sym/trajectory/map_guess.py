"""A first guess for the full-space problem from the swivel map: for positions, pointing and soft tracking.

The map cannot hold such a path exactly, but the shortest way through it still tells which branch and which
corridor the whole motion should take.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import ArmModelError
from armik_sym.swivel.closed_form import position_curve
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals, intervals_of_curves
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import SphericalArm, recognise
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.global_path.knots import knots
from armik_sym.trajectory.global_path.nodes import Nodes, spread_nodes
from armik_sym.trajectory.global_path.search import WaySearch
from armik_sym.trajectory.global_path.shortest_path import Edges
from armik_sym.trajectory.guess import Guess
from armik_sym.trajectory.library import trajectory_library
from armik_sym.trajectory.posture_cost import preferred_posture
from armik_sym.trajectory.rates import sample_durations
from armik_sym.trajectory.request import Request

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_SPACING = 0.12
# Wrist postures tried for positions: the middle, and each joint this share of its range to both sides.
_ASIDE = 0.3
_SLACK = 0.6


def map_guess(request: Request) -> Guess | None:
    """Joint angles along the shortest way through the swivel map.

    Samples without any posture are passed in a straight line through joint space.

    Args:
        request: What is asked.

    Returns:
        The guess; None if the arm has no closed form, or too few samples have a posture.

    Source:
        None (this package).
    """
    try:
        spherical = recognise(request.arm)
    except ArmModelError:
        return None
    rotation = request.path.rotation
    if request.orientation is Orientation.NONE:
        maps = _of_positions(request, spherical)
    elif spherical.wrist is None or rotation is None:
        return None
    else:
        maps = [_of_poses(request, spherical, rotation)]
    reached = ~np.all([one.empty.all(axis=1) for one in maps], axis=0)
    chosen = knots(request.path, request.arm.reach)
    usable = chosen[reached[chosen]]
    exact = request.options.tracking == "exact"
    if len(usable) < 2 or (exact and len(usable) < len(chosen)):
        return None
    nodes = _joined([spread_nodes(one, usable, _SPACING, request.backend) for one in maps])
    if request.start is not None and usable[0] == 0:
        nodes = nodes.with_first(0, 0, 0.0, request.start)
    library = trajectory_library(request.backend)
    search = WaySearch(nodes, _costs(request, nodes, usable), _edges(request, usable), library)
    way = search.cheapest()
    if way is None:
        return None
    q = way.straight(request.path.time)
    return Guess(q, np.zeros(len(q)), "way through the swivel map")


def _of_poses(request: Request, spherical: SphericalArm, rotation: Array) -> FeasibleIntervals:
    position = request.path.position
    along = wrist_directions(spherical, position, rotation)
    reference = transported_reference(spherical, along)
    return feasible_intervals(spherical, position, rotation, reference, request.backend)


def _of_positions(request: Request, spherical: SphericalArm) -> list[FeasibleIntervals]:
    """One map for each of some postures of the joints after the elbow."""
    rom, position = request.arm.rom, request.path.position
    middle = preferred_posture(request.arm, request.options.prefer)[4:]
    rests = [middle]
    for j in range(len(middle)):
        for side in (-_ASIDE, _ASIDE):
            rest = middle.copy()
            rest[j] = np.clip(rest[j] + side * rom.width[4 + j], rom.lower[4 + j], rom.upper[4 + j])
            rests.append(rest)
    reference = transported_reference(spherical, position - spherical.shoulder.centre)
    found = []
    for rest in rests:
        one, other = (
            position_curve(spherical, position, rest, side, reference, request.backend) for side in (1, -1)
        )
        found.append(intervals_of_curves((one, other), request.backend))
    return found


def _joined(parts: list[Nodes]) -> Nodes:
    """The nodes of several maps in common layers."""
    if len(parts) == 1:
        return parts[0]
    layer = np.concatenate([part.layer for part in parts])
    order = np.argsort(layer, kind="stable")
    columns = {
        name: np.concatenate([getattr(part, name) for part in parts])[order]
        for name in ("layer", "sample", "branch", "psi", "q", "side")
    }
    first = np.searchsorted(columns["layer"], np.arange(len(parts[0].first)))
    return replace(parts[0], first=first, **columns)


def _costs(request: Request, nodes: Nodes, usable: Indices) -> Array:
    share = sample_durations(request.path.time[usable])[nodes.layer]
    away = nodes.q - preferred_posture(request.arm, request.options.prefer)
    return np.asarray(0.5 * request.options.posture_weight * share * np.square(away).sum(axis=1))


def _edges(request: Request, usable: Indices) -> Edges:
    steps = np.diff(request.path.time[usable])
    return Edges(
        weight=max(request.options.speed_weight, 1e-6) / steps,
        most=np.outer(steps, request.max_speed) + _SLACK,
        turns=np.zeros(request.arm.dof, dtype=np.bool_),
        change=np.zeros((len(steps), 2, 2)),
    )
