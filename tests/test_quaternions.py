"""Quaternions and rotation matrices, against SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armik_sym.motion.rotations import quaternions_to_rotations, rotations_to_quaternions


def turns(kind: str, n: int = 2_000) -> Rotation:
    """Random turns; turns by nearly nothing, by nearly half a turn, and by exactly half a turn."""
    rng = np.random.default_rng(0)
    axis = rng.normal(size=(n, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    angle = {
        "random": rng.uniform(0, np.pi, n),
        "tiny": 10.0 ** rng.uniform(-12, -3, n),
        "nearly half": np.pi - 10.0 ** rng.uniform(-12, -3, n),
        "half": np.full(n, np.pi),
    }[kind]
    if kind == "half":
        axis[:300] = np.eye(3)[np.arange(300) % 3]
    return Rotation.from_rotvec(axis * angle[:, None])


@pytest.mark.parametrize("kind", ["random", "tiny", "nearly half", "half"])
def test_both_ways_agree_with_scipy_to_rounding(kind):
    turn = turns(kind)
    matrix, xyzw = turn.as_matrix(), turn.as_quat()
    assert np.abs(quaternions_to_rotations(xyzw[:, [3, 0, 1, 2]]) - matrix).max() < 2e-15
    found = rotations_to_quaternions(matrix)
    assert np.abs(np.abs((found * xyzw[:, [3, 0, 1, 2]]).sum(axis=1)) - 1).max() < 2e-15
    assert np.abs(quaternions_to_rotations(found) - matrix).max() < 3e-15
    assert (np.einsum("ni,ni->n", found[1:], found[:-1]) >= 0).all()
    assert found[0, 0] >= 0
