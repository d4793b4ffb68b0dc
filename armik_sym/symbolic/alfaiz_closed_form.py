"""The inverse kinematics of Al-Faiz in closed form, corrected, as CasADi expressions.

All seven angles follow from the pose, one free number and the choice of branches. Two numbers serve as
the free one:

- φ of eq. (13)-(14), as in the paper: `posture`. Not every φ has a solution, and where it ends two branches
  meet with infinite slope.
- the swivel angle ψ by which the elbow turns about the line from shoulder to wrist: `swivel_curve`. Every ψ
  has a solution, and all rotations are C0 + C1·cos ψ + C2·sin ψ, so that every joint limit is an equation
  a + b·cos ψ + c·sin ψ = 0. φ = atan2(-dx, dz) - θ1 follows.

Both give the same postures. Throughout, θ_i are the joint angles q_i without the offsets of Table 1.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import casadi as ca

from armik_sym.arm.catalog import alfaiz
from armik_sym.arm.chain import DHChain
from armik_sym.arm.model import Arm
from armik_sym.symbolic.arm_expressions import ArmExpressions, express
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.link_transform import link_transform
from armik_sym.symbolic.row_order import row_by_row, row_major

_HALF_TURN = ca.DM([[1, 0, 0], [0, -1, 0], [0, 0, -1]])  # Rx(π)
_TINY = 1e-30
_POLE = 1e-26  # cos²θ6 below which θ5 and θ7 turn about the same axis


@dataclass(frozen=True, eq=False)
class Elbow:
    """The part of the solution that does not depend on the free number.

    Attributes:
        angle: θ4, in [rad].
        position: The wrist, drawn to where the arm reaches if it does not, SX of shape (3, 1), in [m].
        along: l4 + l3·cos θ4, the wrist's distance along the upper arm, in [m].
        across: l3·sin θ4, its distance from the line of the upper arm, in [m].
        shortfall: |position| of the target minus that of `position`: 0 if within reach, in [m].
    """

    angle: ca.SX
    position: ca.SX
    along: ca.SX
    across: ca.SX
    shortfall: ca.SX


def closed_form_fits(arm: Arm) -> bool:
    """Whether the closed form holds for an arm: the rows of Al-Faiz, nothing before and after them.

    Segment lengths, range of motion and names of the joints are free.

    Args:
        arm: The arm.

    Returns:
        True if it does.

    Source:
        Al-Faiz, Table 1, as in `catalog.alfaiz`.
    """
    chain, model = arm.chain, alfaiz().chain
    return (
        chain.convention is model.convention
        and _numbers(chain) == _numbers(model)
        and bool((chain.base == model.base).all() and (chain.tool == model.tool).all())
    )


def elbow(position: ca.SX, lengths: ca.SX, side: ca.SX) -> Elbow:
    """The elbow angle: tg² = l4² + l3² + 2·l4·l3·cos θ4.

    By half angles, tan²(θ4/2) = ((l4 + l3)² - tg²) / (tg² - (l4 - l3)²), which keeps all digits near the
    straight arm. Targets out of reach take the arm straight, or folded, in their direction.

    Args:
        position: The wrist, SX of shape (3, 1), in [m].
        lengths: l4 (upper arm) and l3 (forearm), SX of shape (2, 1), in [m].
        side: 1 for flexion, -1 for θ4 < 0.

    Returns:
        The elbow.

    Source:
        Al-Faiz, eq. 4-6, corrected.
    """
    l4, l3 = lengths[0], lengths[1]
    tg = ca.sqrt(ca.sumsqr(position))
    longest, shortest = l4 + l3, ca.fabs(l4 - l3)
    bent = ca.fmax((longest - tg) * (longest + tg), 0)
    open_ = ca.fmax((tg - shortest) * (tg + shortest), 0)
    angle = side * 2 * ca.atan2(ca.sqrt(bent), ca.sqrt(open_))
    along, across = l4 + l3 * ca.cos(angle), l3 * ca.sin(angle)
    reached = ca.sqrt(along**2 + across**2)
    inside = position * (reached / ca.fmax(tg, _TINY))
    return Elbow(angle, inside, along, across, ca.fabs(tg - reached))


def shoulder(
    arm: Elbow, cos_phi: ca.SX | float, sin_phi: ca.SX | float, phi: ca.SX | float, side: ca.SX | float
) -> tuple[ca.SX, ca.SX]:
    """The three shoulder angles for a given φ.

    θ1 = atan2(-dx, dz) - φ; (l3·cos θ4 + l4)·sin θ3 = r·cos φ; θ2 from the linear system (30). With k3 of
    (26) written as ±sqrt(k2² + dy² - k4²) nothing is divided, and nothing cancels near the straight arm.

    Args:
        arm: The elbow.
        cos_phi: cos φ.
        sin_phi: sin φ.
        phi: φ, in [rad].
        side: The sign of cos θ3: 1 for the arc sine of eq. (22), -1 for π minus it.

    Returns:
        θ1, θ2, θ3, SX of shape (3, 1), in [rad], and the discriminant k2² + dy² - k4² in [m²]: no solution
        has this φ if it is negative.

    Source:
        Al-Faiz, eq. 13-35, corrected.
    """
    dx, dy, dz = ca.vertsplit(arm.position)
    r = ca.sqrt(dx**2 + dz**2)
    k1, k2, k4 = r * cos_phi, r * sin_phi, arm.across
    discriminant = k2**2 + dy**2 - k4**2
    direction = ca.if_else(arm.along < 0, -1, 1)
    k3 = direction * side * ca.sqrt(ca.fmax(discriminant, 0))
    theta1 = ca.atan2(-dx, dz) - phi
    theta2 = ca.atan2(k3 * k2 + k4 * dy, k4 * k2 - k3 * dy)
    theta3 = ca.atan2(direction * k1, direction * k3)
    return ca.vertcat(theta1, theta2, theta3), discriminant


def wrist_sides(R: ca.SX, pole: ca.SX | tuple[float, float] = (1.0, 0.0)) -> ca.SX:
    """Sines and cosines of the wrist angles, each pair times a positive number: y5, x5, y6, x6, y7, x7.

    θ5 is found from r13 and r33, the others from the rotation that is left, R turned back by θ5. Where
    θ6 = ±90° this still returns R, whatever θ5 is: only θ5 ± θ7 is determined there, and θ5 is taken from
    `pole`. The shoulder obeys the same equations: R_0^3·Rx(π) is this matrix for (-θ1, -θ2, -θ3).

    Args:
        R: The rotation of A_5 A_6 A_7, SX of shape (3, 3).
        pole: cos θ5 and sin θ5 to take where θ5 is free.

    Returns:
        SX of shape (6, 1), for the solution with cos θ6 ≥ 0.

    Source:
        Al-Faiz, eq. 37-47, corrected.
    """
    x, y = R[0, 2], -R[2, 2]
    square = x**2 + y**2
    free = square < _POLE
    size = ca.sqrt(ca.fmax(square, _POLE))
    c5, s5 = ca.if_else(free, pole[0], x / size), ca.if_else(free, pole[1], y / size)
    x6, y7, x7 = c5 * x + s5 * y, -(s5 * R[0, 0] + c5 * R[2, 0]), -(s5 * R[0, 1] + c5 * R[2, 1])
    return ca.vertcat(s5, c5, R[1, 2], x6, y7, x7)


def wrist(R: ca.SX, side: ca.SX | float = 1, pole: ca.SX | tuple[float, float] = (1.0, 0.0)) -> ca.SX:
    """The three wrist angles from the rotation of A_5 A_6 A_7.

    θ5 = atan2(-σ·r33, σ·r13), θ6 = atan2(r23, σ·sqrt(r13² + r33²)), θ7 = atan2(σ·r22, -σ·r21), the last two
    in the form of `wrist_sides`.

    Args:
        R: SX of shape (3, 3).
        side: σ, the sign of cos θ6.
        pole: cos θ5 and sin θ5 to take where θ5 is free.

    Returns:
        θ5, θ6, θ7, SX of shape (3, 1), in [rad].

    Source:
        Al-Faiz, eq. 37-47, corrected.
    """
    y5, x5, y6, x6, y7, x7 = ca.vertsplit(wrist_sides(R, pole))
    return ca.vertcat(ca.atan2(side * y5, side * x5), ca.atan2(y6, side * x6), ca.atan2(side * y7, side * x7))


def posture(
    position: ca.SX, rotation: ca.SX, lengths: ca.SX, phi: ca.SX, sides: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """All seven angles for a given pose, φ and branches.

    Args:
        position: Position of the hand, SX of shape (3, 1), in [m].
        rotation: Rotation of the hand, SX of shape (3, 3).
        lengths: l4 (upper arm) and l3 (forearm), SX of shape (2, 1), in [m].
        phi: φ, in [rad].
        sides: Signs ±1 of θ4, cos θ3 and cos θ6, SX of shape (3, 1).

    Returns:
        Joint angles, SX of shape (7, 1), in [rad]; the discriminant of `shoulder`, negative if this φ has no
        solution, in [m²]; and by how much the target is out of reach, in [m].

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    arm = elbow(position, lengths, sides[0])
    first, discriminant = shoulder(arm, ca.cos(phi), ca.sin(phi), phi, sides[1])
    R = upper_rotation(first, arm.angle).T @ rotation
    return ca.vertcat(first, arm.angle, wrist(R, sides[2])), discriminant, arm.shortfall


def swivel_curve(position: ca.SX, rotation: ca.SX, lengths: ca.SX, side: ca.SX) -> ca.SX:
    """All postures that reach a pose, as rotations of shoulder and wrist over the swivel angle ψ.

    ψ = 0 is the posture with φ = 90°, which always exists. Turning it about the unit vector n to the wrist,
    R_0^4(ψ) = (n·nᵀ + cos ψ·(I - n·nᵀ) + sin ψ·[n]×)·R_0^4(0). Shoulder: S = R_0^3·Rx(π); wrist:
    W = (R_0^4)ᵀ·R^d, both to be put into `wrist`.

    Args:
        position: Position of the hand, SX of shape (3, 1), in [m].
        rotation: Rotation of the hand, SX of shape (3, 3).
        lengths: l4 (upper arm) and l3 (forearm), SX of shape (2, 1), in [m].
        side: 1 for θ4 ≥ 0, -1 for θ4 < 0.

    Returns:
        SX of shape (55, 1): θ4 in [rad]; then C0, C1, C2 of S(ψ) = C0 + C1·cos ψ + C2·sin ψ, nine entries row
        by row each; then those of W(ψ).

    Source:
        Al-Faiz, eq. 4-38, corrected; Siciliano et al., Robotics (2009), eq. 2.25 (turn about n).
    """
    arm = elbow(position, lengths, side)
    right_angle = ca.pi / 2
    first, _ = shoulder(arm, 0.0, 1.0, right_angle, 1.0)
    R = upper_rotation(first, arm.angle)
    size = ca.sqrt(ca.sumsqr(arm.position))
    hanging = ca.DM([0, -1, 0])
    n = ca.if_else(size > _TINY, arm.position / ca.fmax(size, _TINY), hanging)
    fixed = n @ n.T
    turned = (fixed @ R, R - fixed @ R, ca.skew(n) @ R)
    to_shoulder = _rotation_of_row(3, arm.angle).T @ _HALF_TURN
    parts = [part @ to_shoulder for part in turned] + [part.T @ rotation for part in turned]
    return ca.vertcat(arm.angle, *[row_by_row(part) for part in parts])


def search_functions() -> dict[str, ca.Function]:
    """What the search needs, as CasADi Functions for generated C and for NumPy.

    - `alfaiz_curve` (pose 12, lengths 2, side 1) → 55: `swivel_curve`.
    - `alfaiz_sides` (R 9, pole 2) → 6: `wrist_sides`.
    - `alfaiz_rates` (R 9, dR 9, pole 2) → 3: the derivative of `wrist` with σ = 1 along dR.
    - `alfaiz_quotients` (curve 55, turn 2) → 12: for cos ψ and sin ψ, y5, x5, r23, x5² + y5², y7, x7 by
      eq. (39)-(46), of S(ψ) and then of W(ψ); not for cos θ6 = 0. Arithmetic only, so that it runs in lanes.
    - `alfaiz_shoulder` (q 7) → 9: S = R_0^3·Rx(π) of a posture, row by row.

    A pose is the position and the rotation row by row; so is R.

    Returns:
        Functions by name.

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    pose, lengths, side = ca.SX.sym("pose", 12), ca.SX.sym("lengths", 2), ca.SX.sym("side")
    R, dR, pole = ca.SX.sym("R", 9), ca.SX.sym("dR", 9), ca.SX.sym("pole", 2)
    curve, turn = ca.SX.sym("curve", 55), ca.SX.sym("turn", 2)
    model = _model()
    S = model.frames[3][:3, :3] @ _HALF_TURN
    parts: dict[str, tuple[dict[str, ca.SX], ca.SX]] = {
        "alfaiz_curve": (
            {"pose": pose, "lengths": lengths, "side": side},
            swivel_curve(pose[:3], row_major(pose[3:]), lengths, side),
        ),
        "alfaiz_sides": ({"R": R, "pole": pole}, wrist_sides(row_major(R), pole)),
        "alfaiz_rates": (
            {"R": R, "dR": dR, "pole": pole},
            ca.jtimes(wrist(row_major(R), 1, pole), R, dR),
        ),
        "alfaiz_quotients": ({"curve": curve, "turn": turn}, _quotients(curve, turn)),
        "alfaiz_shoulder": ({"q": model.q}, ca.vec(S.T)),
    }
    return {name: dense_function(name, *part) for name, part in parts.items()}


def posture_function() -> ca.Function:
    """The closed form over φ as a CasADi Function.

    `alfaiz_posture` (pose 12, lengths 2, phi 1, sides 3) → 9: `posture`, its two discriminants last.

    Returns:
        The Function.

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    inputs = {
        name: ca.SX.sym(name, n) for name, n in (("pose", 12), ("lengths", 2), ("phi", 1), ("sides", 3))
    }
    pose, lengths, phi, sides = inputs.values()
    value = ca.vertcat(*posture(pose[:3], row_major(pose[3:]), lengths, phi, sides))
    return dense_function("alfaiz_posture", inputs, value)


def upper_rotation(first: ca.SX, elbow_angle: ca.SX) -> ca.SX:
    """R_0^4, the rotation of the forearm.

    Args:
        first: θ1, θ2, θ3, SX of shape (3, 1), in [rad].
        elbow_angle: θ4, in [rad].

    Returns:
        SX of shape (3, 3).

    Source:
        Al-Faiz, eq. 36.
    """
    model = _model()
    q = ca.vertcat(first, elbow_angle, ca.SX.zeros(3))
    return ca.substitute(model.frames[4][:3, :3], model.q, q)


@functools.cache
def _model() -> ArmExpressions:
    return express(alfaiz())


def _quotients(curve: ca.SX, turn: ca.SX) -> ca.SX:
    sides = []
    for group in (0, 1):
        C0, C1, C2 = (curve[1 + 27 * group + 9 * k : 10 + 27 * group + 9 * k] for k in range(3))
        R = row_major(C0 + C1 * turn[0] + C2 * turn[1])
        x, y = R[0, 2], -R[2, 2]
        sides += [y, x, R[1, 2], x**2 + y**2, R[1, 1], -R[1, 0]]
    return ca.vertcat(*sides)


def _numbers(chain: DHChain) -> tuple[object, ...]:
    """The rows of a chain without names; segment lengths by their place."""

    def place(value: float | str) -> object:
        return ("length", chain.length_names.index(value)) if isinstance(value, str) else value

    return tuple((r.theta, place(r.d), place(r.a), r.alpha, r.joint, r.sign) for r in chain.links)


def _rotation_of_row(index: int, angle: ca.SX) -> ca.SX:
    chain = alfaiz().chain
    nothing = dict.fromkeys(chain.length_names, 0.0)
    return link_transform(chain.links[index], chain.convention, angle, nothing)[:3, :3]
