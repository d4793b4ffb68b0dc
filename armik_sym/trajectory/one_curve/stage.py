"""Joint angles of one sample along its curve, with two exact derivatives, compiled once for all arms.

On one branch all angles are functions of the swivel angle: with Rz(α)·Ry(β)·Rz(γ) = C0 + C1 cos ψ + C2 sin ψ,

    α = atan2(±q23, ±q13),  β = atan2(±√(q13² + q23²), q33),
    γ = atan2(q21·cos α - q11·sin α, q22·cos α - q12·sin α).

Beside a pole (β = 0) α turns fast while ψ hardly changes. There α itself is the coordinate: ψ is a root of
sin α·q13 - cos α·q23 = 0, and with sin β = cos α·q13 + sin α·q23, which takes its sign along, everything is
smooth through the pole, where two branches meet.

Of all angles 2π apart, each is the one less than half a turn from a reference angle, so that nothing jumps.
"""

from __future__ import annotations

import functools

import casadi as ca

from armik_sym.swivel.constants import TURN
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_major

# The parameters of one sample, as (first, last + 1):
PARTS = (0, 54)  # C0, C1, C2 of the shoulder, then of the wrist, entries row by row
BRANCH = (54, 56)  # ±1 of shoulder and wrist
OFFSET = (56, 58)  # offset of the middle angle of shoulder and wrist, in [rad]
REFERENCE = (58, 65)  # reference angles of all joints, in [rad]; that of the elbow is its angle
ROOT = (65, 66)  # ±1: which root ψ is, where an angle of shoulder or wrist is the coordinate
SIZE = 66

_TINY = 1e-30

# What the coordinate is: ψ, the first angle of the shoulder, or the first angle of the wrist.
SWIVEL, SHOULDER, WRIST = range(3)


def curve_angles(coordinate: ca.SX, parameters: ca.SX, chart: int) -> ca.SX:
    """All seven joint angles at a point of the curve.

    Args:
        coordinate: ψ or a joint angle, SX of shape (1, 1), in [rad].
        parameters: One sample's row, SX of shape (SIZE, 1).
        chart: What the coordinate is: SWIVEL, SHOULDER or WRIST.

    Returns:
        SX of shape (7, 1), in [rad].

    Source:
        Siciliano et al., Robotics (2009), eq. 2.19-2.20, over C0, C1, C2; Shimizu et al. (2008).
    """
    reference = parameters[slice(*REFERENCE)]
    groups = [
        [row_major(parameters[9 * (3 * i + k) : 9 * (3 * i + k) + 9]) for k in range(3)] for i in range(2)
    ]
    psi = coordinate
    if chart != SWIVEL:
        psi = _swivel_angle(coordinate, groups[chart - 1], parameters[ROOT[0]])
    angles = []
    for i, (C, offset) in enumerate(zip(groups, ca.vertsplit(parameters[slice(*OFFSET)]), strict=True)):
        Q = C[0] + C[1] * ca.cos(psi) + C[2] * ca.sin(psi)
        near = reference[4 * i : 4 * i + 3] + ca.vertcat(0, offset, 0)
        three = (
            _from_first(Q, near, coordinate) if chart == i + 1 else _three(Q, near, parameters[BRANCH[0] + i])
        )
        angles += [three[0], three[1] - offset, three[2]]
    return ca.vertcat(*angles[:3], reference[3], *angles[3:])


def _three(Q: ca.SX, near: ca.SX, side: ca.SX) -> list[ca.SX]:
    """α, β, γ on one branch; γ from Rz(-α)·Q, so that the pose is kept whatever rounding makes of α."""
    x, y = side * Q[0, 2], side * Q[1, 2]
    return [
        _near(near[0], y, x),
        _near(near[1], side * ca.sqrt(x**2 + y**2), Q[2, 2]),
        _near(near[2], x * Q[1, 0] - y * Q[0, 0], x * Q[1, 1] - y * Q[0, 1]),
    ]


def _from_first(Q: ca.SX, near: ca.SX, alpha: ca.SX) -> list[ca.SX]:
    """α, β, γ where α is known."""
    c, s = ca.cos(alpha), ca.sin(alpha)
    return [
        alpha,
        _near(near[1], c * Q[0, 2] + s * Q[1, 2], Q[2, 2]),
        _near(near[2], c * Q[1, 0] - s * Q[0, 0], c * Q[1, 1] - s * Q[0, 1]),
    ]


def _swivel_angle(alpha: ca.SX, C: list[ca.SX], root: ca.SX) -> ca.SX:
    """ψ at which the first angle is α."""
    a, b, c = (ca.sin(alpha) * part[0, 2] - ca.cos(alpha) * part[1, 2] for part in C)
    square = b**2 + c**2 - a**2
    return ca.atan2(c, b) + root * ca.atan2(ca.sqrt(ca.fmax(square, _TINY)), -a)


@functools.cache
def curve_functions() -> dict[str, ca.Function]:
    """`curve_angles` and its derivatives as SX Functions of (coordinate, parameters), for every chart.

    Returns:
        `angles_0` … `angles_2` → q, shape (7, 1); `second_0` … `second_2` → q, q', q'', shape (21, 1).

    Source:
        None (exact derivatives by CasADi).
    """
    x, parameters = ca.SX.sym("coordinate"), ca.SX.sym("parameters", SIZE)
    inputs = {"coordinate": x, "parameters": parameters}
    functions = {}
    for chart in (SWIVEL, SHOULDER, WRIST):
        q = curve_angles(x, parameters, chart)
        slope = ca.jacobian(q, x)
        values = {"angles": q, "second": ca.vertcat(q, slope, ca.jacobian(slope, x))}
        for name, value in values.items():
            functions[f"{name}_{chart}"] = dense_function(f"{name}_{chart}", inputs, value)
    return functions


def _near(reference: ca.SX, sine: ca.SX, cosine: ca.SX) -> ca.SX:
    """The angle with this sine and cosine (of any common size) at most half a turn from a reference."""
    angle = ca.atan2(sine, cosine)
    return angle + TURN * ca.floor((reference - angle) / TURN + 0.5)
