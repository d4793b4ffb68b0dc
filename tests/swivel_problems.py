"""Problems over the swivel angle for tests of the global search."""

from __future__ import annotations

import numpy as np
from random_trajectories import RandomTrajectory

from armik_sym.compiled.backend import Backend
from armik_sym.swivel.full_turns import split_at_full_turns
from armik_sym.swivel.intervals import feasible_intervals
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.trajectory.library import trajectory_library
from armik_sym.trajectory.one_curve.limits import Limits
from armik_sym.trajectory.one_curve.parameters import wide_joints
from armik_sym.trajectory.swivel_problem import SwivelProblem


def swivel_problem_of(
    given: RandomTrajectory, backend: Backend = "auto", first: np.ndarray | None = None
) -> SwivelProblem:
    """The problem a random trajectory poses, with the usual weights."""
    arm, path = given.arm, given.path
    spherical = recognise(arm)
    assert path.rotation is not None
    reference = transported_reference(spherical, wrist_directions(spherical, path.position, path.rotation))
    intervals = split_at_full_turns(
        feasible_intervals(spherical, path.position, path.rotation, reference, backend), backend
    )
    limits = Limits(np.full(7, 10.0), np.full(7, np.inf), arm.rom, wide_joints(intervals))
    return SwivelProblem(
        arm=arm,
        path=path,
        intervals=intervals,
        reference=reference,
        weights=(1.0, 0.01, 1e-3),
        aim=arm.rom.middle,
        limits=limits,
        first=first,
        library=trajectory_library(backend),
        backend=backend,
    )
