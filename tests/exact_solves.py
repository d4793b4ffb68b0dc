"""Exact solves that several tests compare with, and what every exact solution promises."""

from __future__ import annotations

import numpy as np
from sample_arms import ARMS
from smooth_motions import smooth_path

import armik_sym as ak
from armik_sym.motion.hand_path import HandPath

EHMCS = ARMS["ehmcs"]
N = 25


def check(solution, *, position=1e-9, rotation=1e-9):
    """What every exact solution promises, without any tolerance on limits."""
    rom = solution.arm.rom
    assert solution.ok, solution.reasons
    assert np.all(solution.q >= rom.lower)
    assert np.all(solution.q <= rom.upper)
    assert solution.position_error.max() < position
    assert solution.rotation_error.max() < rotation
    return solution


def reference_solve():
    """One exact full-pose solve: path, generating motion, solution."""
    path, q = smooth_path(EHMCS, N, seed=1)
    return path, q, check(ak.solve(EHMCS, path))


def free_solve():
    """One position-only solve: four joints' worth of freedom, so rate limits can bind and still hold."""
    path, _ = smooth_path(EHMCS, N, seed=2)
    return HandPath(path.time, path.position), check(ak.solve(EHMCS, path, orientation="none"))
