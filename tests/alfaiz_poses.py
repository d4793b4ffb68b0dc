"""What the tests of the method of Al-Faiz share: poses of known postures, and the loops without a cache."""

from __future__ import annotations

import functools

import numpy as np

from armik_sym.arm.catalog import alfaiz
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.backend import build_or_none
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_functions, pointwise_source
from armik_sym.symbolic import Orientation
from armik_sym.symbolic.alfaiz_closed_form import search_functions

WITHOUT_COMPILER = PointwiseLibrary(None)


def narrow_arm() -> Arm:
    lower = np.deg2rad([-60, -60, -90, -20, -80, -40, -50])
    return alfaiz().with_rom(lower, np.deg2rad([60, 90, 30, 140, 80, 50, 60]))


def tight_arm() -> Arm:
    lower = np.deg2rad([-6, -6, -9, 20, -8, -4, -5])
    return alfaiz().with_rom(lower, np.deg2rad([6, 9, 3, 30, 8, 5, 6]))


def everywhere_arm() -> Arm:
    return alfaiz().with_rom([-np.pi] * 7, [np.pi] * 7)


def poses(arm: Arm, q: np.ndarray) -> np.ndarray:
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    return np.hstack([position, rotation.reshape(-1, 9)])


def targets(arm: Arm, q: np.ndarray) -> HandTargets:
    return HandTargets(Orientation.FULL, poses(arm, q))


def source() -> str:
    kinematics = pointwise_functions(alfaiz())
    functions = {"pose": kinematics["pose"], **search_functions()}
    return pointwise_source(functions, 7, loops=("lanes_atan2.h", "alfaiz_curve.h", "alfaiz_search.h"))


@functools.cache
def compiled() -> PointwiseLibrary:
    return PointwiseLibrary(build_or_none(source(), "c"))


def turned(difference: np.ndarray) -> np.ndarray:
    """Differences of angles, from -π to π."""
    return np.remainder(difference + np.pi, 2 * np.pi) - np.pi
