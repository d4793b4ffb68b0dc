"""One DH row as an expression, against elementary transforms."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm import DHConvention, DHLink, JointType
from armik_sym.symbolic.link_transform import joint_cos_sin, link_transform

_ANGLE = st.one_of(st.floats(-7, 7), st.sampled_from([k * math.pi / 2 for k in range(-4, 5)]))
_SHIFT = st.floats(-2, 2)


def _rz(t: float) -> np.ndarray:
    c, s = math.cos(t), math.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def _rx(t: float) -> np.ndarray:
    c, s = math.cos(t), math.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def _shift(x: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T


@given(_ANGLE, _SHIFT, _SHIFT, _ANGLE, st.sampled_from(JointType), st.sampled_from([1, -1]), st.floats(-4, 4))
def test_equals_the_product_of_elementary_transforms(theta, d, a, alpha, joint, sign, q):
    link = DHLink("row", theta, d, a, alpha, joint, sign)
    angle = theta + sign * q if joint is JointType.REVOLUTE else theta
    shift = d + sign * q if joint is JointType.PRISMATIC else d
    z_part, x_part = _rz(angle) @ _shift(0, shift), _shift(a, 0) @ _rx(alpha)
    wanted = {DHConvention.STANDARD: z_part @ x_part, DHConvention.MODIFIED: x_part @ z_part}
    symbol = ca.SX.sym("q")
    for convention, T in wanted.items():
        f = ca.Function("f", [symbol], [link_transform(link, convention, symbol, {})])
        np.testing.assert_allclose(np.array(f(q)), T, atol=5e-15)


def test_named_lengths_are_looked_up():
    link = DHLink("row", d="upper", a="lower")
    T = ca.DM(ca.evalf(link_transform(link, DHConvention.STANDARD, ca.SX(0), {"upper": 0.3, "lower": 0.2})))
    assert float(T[2, 3]) == 0.3
    assert float(T[0, 3]) == 0.2


@pytest.mark.parametrize("k", range(-4, 5))
@pytest.mark.parametrize("sign", [1, -1])
def test_right_angle_offsets_share_sine_and_cosine_of_q(k, sign):
    q = ca.SX.sym("q")
    c, s = joint_cos_sin(DHLink("row", theta=k * math.pi / 2, sign=sign), q)
    f = ca.Function("f", [q], [c, s])
    constants = [
        f.instruction_constant(i) for i in range(f.n_instructions()) if f.instruction_id(i) == ca.OP_CONST
    ]
    assert constants == []
    for x in (0.0, 0.3, -2.0):
        angle = k * math.pi / 2 + sign * x
        np.testing.assert_allclose([float(v) for v in f(x)], [math.cos(angle), math.sin(angle)], atol=1e-15)
