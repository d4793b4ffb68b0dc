r"""The closed form over the swivel angle as CasADi expressions, the same for every arm.

With the shoulder at S, the point to be reached at W and ŵ = (W - S)/|W - S|, the elbow lies on a circle about
ŵ. The swivel angle ψ is its turn about ŵ, zero in the half plane of a reference direction r:
u = ŵ × r/|ŵ × r|, g = u × ŵ; the elbow points to cos ψ·g + sin ψ·u. In the upper arm's own hinge frame
(upper arm, hinge × upper arm, hinge) the same three directions are ŵ0, g0 and k0 = ŵ0 × g0, which depend on
the elbow angle only. So

    R_upper_arm(ψ) = ŵ·ŵ0' + cos ψ·(g·g0' + u·k0') + sin ψ·(u·g0' - g·k0').

Written in frames adapted to the axes of shoulder and wrist, both become Rz(a)·Ry(b)·Rz(c) = C0 + C1·cos ψ +
C2·sin ψ. All numbers of an arm are arguments (`geometry`): one C function serves every arm.
"""

from __future__ import annotations

import functools

import casadi as ca

from armik_sym.swivel import geometry as row
from armik_sym.swivel.constants import POLE
from armik_sym.symbolic.dense_function import dense_function
from armik_sym.symbolic.row_order import row_by_row, row_major

TINY = 1e-30
_REFERENCE = 1e-14  # |ŵ × r| below which r gives no direction


def elbow_angle(distance: ca.SX, lengths: ca.SX, side: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The angle θ between upper arm and forearm: d² - h² = le² + lf² + 2·le·lf·cos θ.

    By half angles, tan²(θ/2) = ((le + lf)² - d² + h²) / (d² - h² - (le - lf)²), which keeps all digits near
    the straight arm. Distances out of reach take the arm straight, or folded.

    Args:
        distance: d, from the shoulder to the point to be reached, in [m].
        lengths: Upper arm le, forearm lf at right angles to the hinge, offset h along the hinge, in [m].
        side: 1 for θ ≥ 0, -1 for θ ≤ 0.

    Returns:
        θ in [rad], cos θ and sin θ.

    Source:
        Al-Faiz, eq. 4-6, corrected; with an offset along the hinge.
    """
    le, lf, h = ca.vertsplit(lengths)
    flat = ca.sqrt(ca.fmax((distance - h) * (distance + h), 0))
    bent = ca.fmax((le + lf - flat) * (le + lf + flat), 0)
    open_ = ca.fmax((flat - le + lf) * (flat + le - lf), 0)
    total = ca.fmax(bent + open_, TINY)
    sine = side * 2 * ca.sqrt(bent * open_) / total
    return side * 2 * ca.atan2(ca.sqrt(bent), ca.sqrt(open_)), (open_ - bent) / total, sine


def hinge_directions(lengths: ca.SX, cosine: ca.SX, sine: ca.SX, side: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """ŵ0, g0, k0 in the hinge frame, and how far the point to be reached is from the shoulder.

    With along = le + lf·cos θ and m = hypot(lf·sin θ, h): ŵ0 = (along, lf·sin θ, h)/d, g0 = (m,
    -along·lf·sin θ/m, -along·h/m)/d. At the straight arm g0 keeps the direction it has on this side of the
    elbow.

    Args:
        lengths: As in `elbow_angle`, in [m].
        cosine: cos θ.
        sine: sin θ.
        side: Sign of θ.

    Returns:
        The matrix [ŵ0, g0, k0], SX of shape (3, 3); d in [m]; m in [m], 0 where the elbow is on the line.

    Source:
        None (vector algebra; this package).
    """
    le, lf, h = ca.vertsplit(lengths)
    along, across = le + lf * cosine, lf * sine
    m = ca.sqrt(across**2 + h**2)
    d = ca.sqrt(along**2 + m**2)
    on_line, at_shoulder = m < TINY, d < TINY
    a, b = (
        ca.if_else(on_line, side, across / ca.fmax(m, TINY)),
        ca.if_else(on_line, 0, h / ca.fmax(m, TINY)),
    )
    size = ca.fmax(d, TINY)
    x, y = ca.if_else(at_shoulder, 0, along / size), ca.if_else(at_shoulder, 1, m / size)
    w0 = ca.vertcat(x, y * a, y * b)
    g0 = ca.vertcat(y, -x * a, -x * b)
    return ca.horzcat(w0, g0, ca.cross(w0, g0)), d, m


def reference_directions(along: ca.SX, reference: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """ŵ, g, u in the base frame, and |ŵ × r|.

    Where r lies along ŵ, the axis of the base at the largest angle to ŵ takes its place. Where ŵ has no
    direction, it is x.

    Args:
        along: From the shoulder to the point to be reached, SX of shape (3, 1), in [m].
        reference: Reference direction r, a unit vector, SX of shape (3, 1).

    Returns:
        The matrix [ŵ, g, u], SX of shape (3, 3); |along| in [m]; |ŵ × r|, 0 where ψ has no zero of its own.

    Source:
        None (vector algebra; this package).
    """
    size = ca.sqrt(ca.sumsqr(along))
    w = ca.if_else(size > TINY, along / ca.fmax(size, TINY), ca.DM([1, 0, 0]))
    x, y, z = (ca.fabs(part) for part in ca.vertsplit(w))
    other = ca.if_else(
        ca.logic_and(x <= y, x <= z),
        ca.DM([1, 0, 0]),
        ca.if_else(y <= z, ca.DM([0, 1, 0]), ca.DM([0, 0, 1])),
    )
    sine = ca.sqrt(ca.sumsqr(ca.cross(w, reference)))
    across = ca.cross(w, ca.if_else(sine > _REFERENCE, reference, other))
    u = across / ca.sqrt(ca.sumsqr(across))
    u = u - w * ca.dot(w, u)  # near the reference line u keeps only few digits of its right angle
    u = u / ca.sqrt(ca.sumsqr(u))
    return ca.horzcat(w, ca.cross(u, w), u), size, sine


def swivel_curve(pose: ca.SX, geometry: ca.SX, side: ca.SX, reference: ca.SX) -> ca.SX:
    """All postures that reach a pose with one side of the elbow.

    Args:
        pose: Position of the hand in [m], its rotation row by row, SX of shape (12, 1).
        geometry: The arm, as in `geometry`, SX of shape (46, 1).
        side: 1 or -1, the sign of the angle from upper arm to forearm about the hinge.
        reference: Reference direction, SX of shape (3, 1).

    Returns:
        SX of shape (58, 1): q4 in [rad]; C0, C1, C2 of the shoulder, nine entries row by row each; those of
        the wrist; by how much the target is out of reach in [m]; distance of the elbow from the line in [m]
        (times d/le); |ŵ × r|.

    Source:
        Al-Faiz, eq. 4-38, for any arm of this kind; Shimizu et al. (2008).
    """
    S, lengths = _part(geometry, row.SHOULDER), _part(geometry, row.LENGTHS)
    R = row_major(pose[3:])
    world, distance, sine_reference = reference_directions(
        pose[:3] + R @ _part(geometry, row.WRIST_IN_HAND) - S, reference
    )
    theta, cosine, sine = elbow_angle(distance, lengths, side)
    body, reached, off_line = hinge_directions(lengths, cosine, sine, side)
    turn_back = ca.vertcat(ca.horzcat(cosine, sine, 0), ca.horzcat(-sine, cosine, 0), ca.horzcat(0, 0, 1))
    shoulder = _curve(
        _matrix(geometry, row.BEFORE_SHOULDER).T @ world, _matrix(geometry, row.AFTER_SHOULDER) @ body
    )
    wrist = _curve(
        (R @ _matrix(geometry, row.AFTER_WRIST)).T @ world,
        _matrix(geometry, row.BEFORE_WRIST) @ turn_back @ body,
    )
    parts = [row_by_row(part) for part in shoulder] + [row_by_row(part.T) for part in wrist]
    q4 = theta - _part(geometry, row.ELBOW_ZERO)
    return ca.vertcat(q4, *parts, ca.fabs(distance - reached), off_line, sine_reference)


def sines_and_cosines(Q: ca.SX, side: ca.SX, pole: ca.SX) -> ca.SX:
    """Angles of Rz(a)·Ry(b)·Rz(c) as sines and cosines.

    sin b·(cos a, sin a) = (q13, q23); sin b = cos a·q13 + sin a·q23, cos b = q33; sin c, cos c from the
    second row of Rz(-a)·Q, so that Q is returned whatever a is. Where sin b = 0 only a ± c is determined
    and a is taken from `pole`.

    Args:
        Q: SX of shape (3, 3).
        side: 1 or -1, the sign of sin b.
        pole: cos a and sin a to take where a is free, SX of shape (2, 1).

    Returns:
        SX of shape (6, 1): sine and cosine of a, of b and of c.

    Source:
        Siciliano et al., Robotics (2009), eq. 2.19-2.20, with the third angle turned back.
    """
    x, y = side * Q[0, 2], side * Q[1, 2]
    square = x**2 + y**2
    free, size = square < POLE, ca.sqrt(ca.fmax(square, POLE))
    c, s = ca.if_else(free, pole[0], x / size), ca.if_else(free, pole[1], y / size)
    return ca.vertcat(
        s, c, c * Q[0, 2] + s * Q[1, 2], Q[2, 2], c * Q[1, 0] - s * Q[0, 0], c * Q[1, 1] - s * Q[0, 1]
    )


def quotients(Q: ca.SX) -> ca.SX:
    """Angles of Rz(a)·Ry(b)·Rz(c) on branch 1 as quotients, without square root or case.

    As `sines_and_cosines`, each pair times |sin b|, that of b with the square of its sine.

    Args:
        Q: SX of shape (3, 3).

    Returns:
        SX of shape (6, 1): (y, x) of a; sin²b and cos b; (y, x) of c.

    Source:
        Siciliano et al., Robotics (2009), eq. 2.19-2.20.
    """
    x, y = Q[0, 2], Q[1, 2]
    return ca.vertcat(y, x, x * x + y * y, Q[2, 2], x * Q[1, 0] - y * Q[0, 0], x * Q[1, 1] - y * Q[0, 1])


def swivel_of(q: ca.SX, middle: ca.SX, geometry: ca.SX, reference: ca.SX) -> ca.SX:
    """The swivel angle of a posture and the signs of its branches.

    Args:
        q: Angles of joints 1 to 4, SX of shape (4, 1), in [rad].
        middle: `offset` of the shoulder, in [rad].
        geometry: The arm, as in `geometry`, SX of shape (46, 1).
        reference: Reference direction, SX of shape (3, 1).

    Returns:
        SX of shape (4, 1): ψ in [rad]; sin θ of the elbow, sin b of the shoulder, and |ŵ × r|.

    Source:
        Definition of the swivel angle (this package).
    """
    theta = q[3] + _part(geometry, row.ELBOW_ZERO)
    side = ca.if_else(ca.sin(theta) < 0, -1, 1)
    lengths = _part(geometry, row.LENGTHS)
    body, _, _ = hinge_directions(lengths, ca.cos(theta), ca.sin(theta), side)
    turns = _about_z(q[0]) @ _about_y(q[1] + middle) @ _about_z(q[2])
    R = _matrix(geometry, row.BEFORE_SHOULDER) @ turns @ _matrix(geometry, row.AFTER_SHOULDER)
    world, _, sine_reference = reference_directions(R @ body[:, 0], reference)
    elbow = R @ body[:, 1]
    psi = ca.atan2(ca.dot(world[:, 2], elbow), ca.dot(world[:, 1], elbow))
    return ca.vertcat(psi, ca.sin(theta), ca.sin(q[1] + middle), sine_reference)


@functools.cache
def swivel_functions() -> dict[str, ca.Function]:
    """What is evaluated, as CasADi Functions for NumPy and for generated C.

    - `swivel_curve` (pose 12, geometry 46, side 1, reference 3) → 58: `swivel_curve`.
    - `swivel_sides` (Q 9, side 1, pole 2) → 6: `sines_and_cosines`.
    - `swivel_quotients` (Q 9) → 6: `quotients`.
    - `swivel_of` (q 4, middle 1, geometry 46, reference 3) → 4: `swivel_of`.

    Returns:
        Functions by name.

    Source:
        Al-Faiz, eq. 4-47, for any arm of this kind.
    """
    pose, geometry, side = ca.SX.sym("pose", 12), ca.SX.sym("geometry", row.SIZE), ca.SX.sym("side")
    reference, Q, pole = ca.SX.sym("reference", 3), ca.SX.sym("Q", 9), ca.SX.sym("pole", 2)
    q, middle = ca.SX.sym("q", 4), ca.SX.sym("middle")
    return {
        function.name(): function
        for function in (
            dense_function(
                "swivel_curve",
                {"pose": pose, "geometry": geometry, "side": side, "reference": reference},
                swivel_curve(pose, geometry, side, reference),
            ),
            dense_function(
                "swivel_sides",
                {"Q": Q, "side": side, "pole": pole},
                sines_and_cosines(row_major(Q), side, pole),
            ),
            dense_function("swivel_quotients", {"Q": Q}, quotients(row_major(Q))),
            dense_function(
                "swivel_of",
                {"q": q, "middle": middle, "geometry": geometry, "reference": reference},
                swivel_of(q, middle, geometry, reference),
            ),
        )
    }


def _curve(world: ca.SX, body: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    w, g, u = ca.horzsplit(world)
    w0, g0, k0 = ca.horzsplit(body)
    return w @ w0.T, g @ g0.T + u @ k0.T, u @ g0.T - g @ k0.T


def _part(geometry: ca.SX, place: tuple[int, int]) -> ca.SX:
    return geometry[slice(*place)]


def _matrix(geometry: ca.SX, place: tuple[int, int]) -> ca.SX:
    return row_major(_part(geometry, place))


def _about_z(angle: ca.SX) -> ca.SX:
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(c, -s, 0), ca.horzcat(s, c, 0), ca.horzcat(0, 0, 1))


def _about_y(angle: ca.SX) -> ca.SX:
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(c, 0, s), ca.horzcat(0, 1, 0), ca.horzcat(-s, 0, c))
