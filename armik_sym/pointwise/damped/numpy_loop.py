"""Damped methods for many poses without a compiler."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.kinematics import compile
from armik_sym.pointwise.damped.found import Found
from armik_sym.pointwise.damped.reach import PoseReacher
from armik_sym.pointwise.damped.settings import DampedSettings
from armik_sym.pointwise.random_stream import random_branch

Array = NDArray[np.float64]


class NumpyLoop:
    """The same as `CompiledLoop` without a compiler.

    Args:
        arm: The arm.
        settings: Numbers of the method.
        seed: Seed of random restarts.

    Source:
        Al-Faiz, eq. 58-63; Sugihara (2011), doi:10.1109/TRO.2011.2148230.
    """

    def __init__(self, arm: Arm, settings: DampedSettings, seed: int) -> None:
        self._reacher = PoseReacher(compile(arm, "vm"), settings)
        self._seed = seed

    def __call__(self, part: slice, targets: Array, starts: Array, chain: bool, found: Found) -> None:
        """Solve samples part.start … part.stop - 1.

        Args:
            part: The samples.
            targets: Targets of all samples, shape (n, 12).
            starts: One posture (dof,) for a chain, else one per sample, shape (n, dof), in [rad].
            chain: Whether each sample starts from the posture before.
            found: Where the answers go.

        Source:
            None (packaging).
        """
        q = starts
        for i in range(part.start, part.stop):
            reached = self._reacher.reach(targets[i], q if chain else starts[i], random_branch(self._seed, i))
            found.q[i] = q = reached.q
            found.error[i] = math.sqrt(reached.size)
            found.iterations[i] = reached.iterations
            found.evaluations[i] = reached.evaluations
