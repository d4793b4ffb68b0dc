"""Arms, paths and libraries for the tests of ISADE and Pro-ISADE."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from hypothesis import strategies as st
from sample_arms import ARMS, postures

import armik_sym as ak
from armik_sym.compiled.backend import build_or_none
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary, pointwise_functions, pointwise_source
from armik_sym.symbolic import Orientation

FILES = (
    "real_math.h", "random_stream.h", "isade_settings.h", "isade_cost.h", "isade_generation.h", "isade.h"
)  # fmt: skip
NUMPY = PointwiseLibrary(None)
WINDOW = np.pi / 100
SEEDS = st.integers(0, 10**6)
BOTH = pytest.mark.parametrize("library_of", ["compiled", "numpy"])


def c_source(arm):
    functions = pointwise_functions(arm)
    used = {name: functions[name] for name in ("position", "pose")}
    return pointwise_source(used, arm.dof, loops=FILES)


@functools.cache
def compiled(name):
    library = build_or_none(c_source(ARMS[name]), "auto")
    if library is None:
        pytest.skip("no C compiler")
    return PointwiseLibrary(library)


def library(kind, name):
    return compiled(name) if kind == "compiled" else NUMPY


NAME = "ehmcs_5dof"
ARM = ARMS[NAME]


def targets_of(arm, q, orientation=Orientation.NONE):
    kin = ak.compile(arm)
    rotation = kin.rotation(q).reshape(-1, 9)
    if orientation is Orientation.NONE:
        rotation = np.broadcast_to(np.eye(3).ravel(), rotation.shape)
    return HandTargets(orientation, np.ascontiguousarray(np.hstack([kin.position(q), rotation])))


def gentle(arm, n, seed=0, step=0.01):
    """Postures along a straight line in joint space, each joint moving up to `step` per sample."""
    rng = np.random.default_rng(seed)
    first = postures(arm, 1, seed, stretch=0.6)[0]
    return first + np.arange(n)[:, None] * rng.uniform(-step, step, arm.dof)


def inside(arm, q):
    return bool(np.all(q >= arm.rom.lower) and np.all(q <= arm.rom.upper))


def same(a, b):
    return np.array_equal(a.q, b.q) and np.array_equal(a.iterations, b.iterations)
