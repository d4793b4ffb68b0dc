"""Frames computed beforehand, for pages made where nothing compiles to WebAssembly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.backend import Backend
from armik_sym.report.wasm.drawn_points import DrawnPoints, drawn_function
from armik_sym.swivel.branches import SwivelAndBranch, swivel_of_postures
from armik_sym.swivel.closed_form import pose_curve
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.symbolic import express
from armik_sym.symbolic.dense_function import evaluate_rows

Array = NDArray[np.float64]

MOST_STEPS = 72
FEWEST_STEPS = 12

# How much the numbers of a page may take, in bytes, before they become text of 4/3 the size.
_BUDGET = 2_000_000


@dataclass(frozen=True, eq=False)
class Frames:
    """Postures with what is drawn of them.

    Attributes:
        q: Postures, shape (n, dof), in [rad].
        drawn: Points of the joints, position and rotation of the hand, shape (n, 3·dof + 12), in [m].
        psi: Swivel angles, shape (n,), in [rad]; empty without a closed form.
        turned: Posture and elbow at swivel angles psi + 2π·k/steps, shape (n, steps, dof + 3), in [rad] and
            [m]; all other points stay where they are. No steps without a closed form.
    """

    q: Array
    drawn: Array
    psi: Array
    turned: Array


def drawn_values(arm: Arm, points: DrawnPoints, q: Array) -> Array:
    """Points of the joints and pose of the hand.

    Args:
        arm: The arm.
        points: What is drawn of it.
        q: Postures, shape (n, dof), in [rad].

    Returns:
        Shape (n, 3·dof + 12): points in [m], position in [m], rotation row by row.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    return evaluate_rows(drawn_function(express(arm)), q, arm.length_values, points.local.ravel())


def fixed_frames(arm: Arm, points: DrawnPoints, q: Array, budget: int | None = None) -> Frames:
    """Frames of postures as they are; of a long motion every second one, or every third, and so on.

    Args:
        arm: The arm.
        points: What is drawn of it.
        q: Postures, shape (n, dof), in [rad].
        budget: How many bytes the frames may take; None for what a page alone has room for.

    Returns:
        Frames without steps.

    Source:
        None (packaging).
    """
    kept = q[:: _every(len(q), 8 * _numbers(arm), budget or _BUDGET)]
    return Frames(kept, drawn_values(arm, points, kept), np.zeros(0), np.zeros((len(kept), 0, arm.dof + 3)))


def turned_frames(
    arm: Arm,
    points: DrawnPoints,
    q: Array,
    reference: Array | None,
    backend: Backend = "auto",
    budget: int | None = None,
) -> Frames:
    """Frames of postures and of those with the elbow turned while the hand stays.

    As many steps as the budget of a page allows, `FEWEST_STEPS` to `MOST_STEPS`; if even the fewest are too
    many, every second posture is kept, or every third, and so on.

    Args:
        arm: The arm; it has a closed form for poses.
        points: What is drawn of it.
        q: Postures, shape (n, dof), n at least 1, in [rad].
        reference: Where the elbow points at ψ = 0, shape (3,) or (n, 3); None for the arm's own.
        backend: "auto", "c" or "vm".
        budget: How many bytes the frames may take; None for what a page alone has room for.

    Returns:
        The frames.

    Source:
        Al-Faiz, eq. 13-47, corrected; Shimizu et al. (2008).
    """
    step, fixed = 8 * (arm.dof + 3), 8 * _numbers(arm)
    allowed = budget or _BUDGET
    every = _every(len(q), fixed + FEWEST_STEPS * step, allowed)
    kept = q[::every]
    directions = reference[::every] if reference is not None and reference.ndim == 2 else reference
    steps = int(np.clip((allowed // len(kept) - fixed) // step, FEWEST_STEPS, MOST_STEPS))
    drawn = drawn_values(arm, points, kept)
    where = swivel_of_postures(recognise(arm), kept, directions, backend=backend)
    turned = _turned(arm, kept, drawn, where, directions, steps, backend)
    angles = turned.reshape(-1, arm.dof)
    elbow = drawn_values(arm, points, angles)[:, 9:12].reshape(len(kept), steps, 3)
    return Frames(kept, drawn, where.psi, np.concatenate([turned, elbow], axis=2))


def _numbers(arm: Arm) -> int:
    """How many numbers one frame has without steps: posture, points, hand, swivel angle."""
    return 4 * arm.dof + 13


def _every(n: int, size: int, budget: int) -> int:
    """Every how many-th frame of so many bytes fits the budget."""
    return max(1, -(-n * size // budget))


def _turned(
    arm: Arm,
    q: Array,
    drawn: Array,
    where: SwivelAndBranch,
    reference: Array | None,
    steps: int,
    backend: Backend,
) -> Array:
    """Postures at all steps, shape (n, steps, dof); the first step is the posture itself."""
    hand = drawn[:, 3 * arm.dof :]
    position, rotation = hand[:, :3], hand[:, 3:].reshape(-1, 3, 3)
    curves = [
        pose_curve(recognise(arm), position, rotation, side, reference, backend=backend) for side in (1, -1)
    ]
    branch = 4 * (where.elbow < 0) + 2 * (where.shoulder < 0) + (where.wrist < 0)
    psi = where.psi[:, None] + 2 * np.pi * np.arange(steps) / steps
    sample = np.repeat(np.arange(len(q)), steps)
    postures = postures_at(
        (curves[0], curves[1]),
        sample,
        branch[sample].astype(np.int64),
        psi.ravel(),
        q[sample],
        backend,
    )
    turned = postures.q.reshape(len(q), steps, arm.dof)
    turned[:, 0] = q
    return np.asarray(turned)
