"""The geometric Jacobian against automatic and numeric differentiation."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from sample_arms import ARMS, postures

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.emit_vectors import jacobian_by_differences
from armik_sym.symbolic import express


def _singular(arm, q):
    """Postures with one or more joints at or next to 0 and ±90°: stretched elbow, poles, gimbal lock."""
    rng = np.random.default_rng(5)
    special = rng.choice([0.0, np.pi / 2, -np.pi / 2, 1e-9, np.pi / 2 - 1e-9], q.shape)
    return np.vstack([q, np.where(rng.random(q.shape) < 0.7, special, q), np.zeros((1, arm.dof))])


@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_equals_automatic_differentiation(arm):
    symbols = express(arm, "baked")
    R = symbols.rotation
    columns = []
    for i in range(arm.dof):
        spin = ca.reshape(ca.jacobian(ca.vec(R), symbols.q[i]), 3, 3) @ R.T
        columns.append(ca.vertcat(spin[2, 1], spin[0, 2], spin[1, 0]))
    by_casadi = ca.vertcat(ca.jacobian(symbols.position, symbols.q), ca.horzcat(*columns))
    f = ca.Function("f", [symbols.q], [symbols.jacobian, by_casadi])
    for q in _singular(arm, postures(arm, 40)):
        ours, theirs = f(q)
        np.testing.assert_allclose(np.array(ours), np.array(theirs), atol=1e-13)


@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_equals_finite_differences(arm):
    q = _singular(arm, postures(arm, 20, seed=1))
    f = express(arm, "baked").function("jacobian")
    ours = np.array([np.array(f(x, [])) for x in q])
    np.testing.assert_allclose(ours, jacobian_by_differences(arm, q), atol=1e-12)
    h = 1e-6
    for i in range(arm.dof):
        step = h * np.eye(arm.dof)[i]
        slope = (
            hand_pose(arm.chain, q + step, arm.lengths)[0] - hand_pose(arm.chain, q - step, arm.lengths)[0]
        ) / (2 * h)
        np.testing.assert_allclose(ours[:, :3, i], slope, atol=1e-9)
