"""One-curve problems that the tests share: postures, their curves, and trajectories in a corridor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from spherical_arms import ARMS, poses

from armik_sym.arm import Arm
from armik_sym.compiled.build import Library
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.full_turns import split_at_full_turns
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals
from armik_sym.swivel.reference import transported_reference, wrist_directions
from armik_sym.swivel.spherical_arm import SphericalArm, recognise
from armik_sym.trajectory.library import trajectory_library
from armik_sym.trajectory.one_curve.parameters import curve_parameters
from armik_sym.trajectory.one_curve.smoothness import Smoothness, smoothness
from armik_sym.trajectory.one_curve.stage import ROOT, SHOULDER, SWIVEL, WRIST

Array = NDArray[np.float64]
WEIGHTS = (1.0, 0.01, 1e-3)
CHARTS = (SWIVEL, SHOULDER, WRIST)
MIDDLE = {SHOULDER: 1, WRIST: 5}  # the joint that is 0 (less its offset) at the pole
FIRST = {SHOULDER: 0, WRIST: 4}
BACKENDS = ("c", "vm")


@dataclass(frozen=True, eq=False)
class Curves:
    """Postures on their curves: intervals of the poses, branch, swivel angle and parameters of each."""

    arm: Arm
    spherical: SphericalArm
    intervals: FeasibleIntervals
    q: Array
    branch: NDArray[np.int64]
    psi: Array
    rows: Array
    position: Array
    rotation: Array

    def bounds(self, where: Array | None = None) -> tuple[Array, Array]:
        """Start and end of the interval every posture is in, turned to lie around its swivel angle."""
        psi = self.psi if where is None else where
        lower, upper = np.empty(len(psi)), np.empty(len(psi))
        for k, (branch, at) in enumerate(zip(self.branch, psi, strict=True)):
            ends = self.intervals.of(k, branch)
            turned = ends + 2 * np.pi * np.rint((at - ends.mean(axis=1)) / (2 * np.pi))[:, None]
            off = np.maximum(turned[:, 0] - at, at - turned[:, 1])
            lower[k], upper[k] = turned[off.argmin()]
            assert off.min() <= 1e-6, (k, off)
            if upper[k] - lower[k] >= 2 * np.pi - 1e-12:
                lower[k], upper[k] = -np.inf, np.inf
        return lower, upper


def curves_of(arm: Arm, q: Array, time_varying: bool = False) -> Curves:
    """The curves of postures; reference directions are transported if the postures are a motion."""
    spherical = recognise(arm)
    position, rotation = poses(arm, q)
    reference = np.tile(spherical.reference, (len(q), 1))
    if time_varying:
        reference = transported_reference(spherical, wrist_directions(spherical, position, rotation))
    intervals = split_at_full_turns(feasible_intervals(spherical, position, rotation, reference))
    at = swivel_of_postures(spherical, q, reference)
    signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
    branch = (signs[:, None] == intervals.branches).all(axis=2).argmax(axis=1)
    rows = curve_parameters(intervals, np.arange(len(q)), branch, q)
    return Curves(arm, spherical, intervals, q, branch, at.psi, rows, position, rotation)


def unlimited(name: str, most: float = 3.6) -> Arm:
    """An arm whose joints turn farther than any test goes, each less than two turns in all."""
    arm = ARMS[name]
    return arm.with_rom(np.full(7, -most), np.full(7, most))


def with_root(rows: Array, root: Array | float) -> Array:
    """Rows of parameters with the root filled in."""
    rows = rows.copy()
    rows[:, ROOT[0]] = root
    return rows


def library(backend: str) -> Library | None:
    return trajectory_library(backend)


def bare(n: int, seed: int, time: Array | None = None) -> Smoothness:
    """The usual objective over n samples, drawn to a random posture."""
    time = 0.05 * np.arange(n) if time is None else time
    return smoothness(time, WEIGHTS, np.random.default_rng(seed).normal(size=7))
