"""Coordinates along the curves: the swivel angle, or beside a pole the joint angle that turns fast there.

With v = (q13, q23) of shoulder or wrist, v × v' = B×D + A×D·cos ψ - A×B·sin ψ (A, B, D: those of C0, C1, C2)
is |v|² times the slope of the first angle over ψ. Between its zeros the first angle is monotone and can
take the place of ψ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.swivel.constants import TURN
from armik_sym.swivel.limit_cuts import zeros
from armik_sym.trajectory.one_curve.stage import (
    BRANCH,
    OFFSET,
    PARTS,
    REFERENCE,
    ROOT,
    SHOULDER,
    SWIVEL,
    WRIST,
)

Array = NDArray[np.float64]

# Slope of a joint angle over ψ above which it becomes the coordinate.
_STEEP = 2.0
# Share of a monotone stretch that is left out at both ends, where the slope vanishes.
_INSET = 0.02
_NOTHING = 1e-9
# The posture at ψ may miss the one wanted by this much; more means that ψ is too coarse there, in [rad].
_MISSED = 0.15

_FIRST, _MIDDLE = [0, 4], [1, 5]

# A curve that comes this near to a pole runs through it, and a swivel angle this near to it is there.
_POLE = 1e-10
_AT = 1e-3
# Beside a pole the rounding of a swivel angle grows into this much of a joint angle at most, in [rad].
_GROWN = 1e-5
# Rounding of a joint angle, in [rad]; where it hardly turns this can be much of the swivel angle.
_ROUNDED = 2e-14


@dataclass(frozen=True, eq=False)
class Charts:
    """One coordinate per sample.

    Attributes:
        chart: What it is, shape (n,).
        rows: Parameters with the root filled in, shape (n, SIZE).
        x: Coordinates of the point they were chosen at, shape (n,), in [rad].
        lower: Least coordinates, shape (n,), in [rad].
        upper: Largest coordinates, shape (n,), in [rad].
        near: Swivel angles less than half a turn from all between the bounds, shape (n,), in [rad].
        cut: Whether a bound is the end of a monotone stretch and not of the interval, shape (2, n).
    """

    chart: NDArray[np.int32]
    rows: Array
    x: Array
    lower: Array
    upper: Array
    near: Array
    cut: NDArray[np.bool_]

    def swivel_angles(self, x: Array) -> Array:
        """Swivel angles of points given by their coordinates.

        Args:
            x: Coordinates, shape (n,), in [rad].

        Returns:
            Shape (n,), in [rad].

        Source:
            Shimizu et al. (2008).
        """
        psi = np.array(x, dtype=np.float64)
        for chart in (SHOULDER, WRIST):
            chosen = np.flatnonzero(self.chart == chart)
            if chosen.size:
                psi[chosen] = _on_root(self.rows[chosen], chart, x[chosen], self.near[chosen])
        return psi

    def stopped(self, x: Array) -> bool:
        """Whether a point lies at the end of a monotone stretch, where another coordinate leads on.

        Args:
            x: Coordinates, shape (n,), in [rad].

        Returns:
            True if so.

        Source:
            None (definition).
        """
        at_lower, at_upper = x <= self.lower + 1e-9, x >= self.upper - 1e-9
        return bool((self.cut[0] & at_lower | self.cut[1] & at_upper).any())


def choose_charts(
    rows: Array,
    psi: Array,
    lower: Array,
    upper: Array,
    q: Array,
    slope: Array,
    wanted: Array,
    rom: RangeOfMotion,
) -> Charts:
    """The coordinate for every sample: ψ unless the first angle of shoulder or wrist turns much faster.

    Args:
        rows: Parameters of all samples, shape (n, SIZE).
        psi: Swivel angles, shape (n,), in [rad].
        lower: Least swivel angles, shape (n,), in [rad]; -inf for a whole circle.
        upper: Largest swivel angles, shape (n,), in [rad].
        q: Joint angles there, shape (n, 7), in [rad].
        slope: dq/dψ there, shape (n, 7).
        wanted: Joint angles to be near to where ψ is too coarse to tell, shape (n, 7), in [rad].
        rom: Range of motion: what bounds the coordinate right at a pole, where ψ says nothing.

    Returns:
        The coordinates.

    Source:
        None (this package).
    """
    steep = np.nan_to_num(np.abs(slope[:, _FIRST]), nan=np.inf)
    steep[np.abs(np.sin(q[:, _MIDDLE] + rows[:, slice(*OFFSET)])) < _POLE] = np.inf
    missed = np.abs(q[:, _FIRST] - wanted[:, _FIRST])
    urgency = np.maximum(steep / _STEEP, missed / _MISSED)
    chart = np.where(urgency.max(axis=1) > 1.0, 1 + urgency.argmax(axis=1), SWIVEL)
    charts = Charts(
        chart.astype(np.int32),
        rows.copy(),
        psi.copy(),
        lower.copy(),
        upper.copy(),
        psi.copy(),
        np.zeros((2, len(psi)), dtype=np.bool_),
    )
    for kind in (SHOULDER, WRIST):
        chosen = np.flatnonzero(chart == kind)
        if chosen.size:
            at = _by_first_angle(charts, kind, chosen, wanted[chosen, _FIRST[kind - 1]], rom)
            _keep_in_range(charts, kind, chosen, rom)
            _at_pole(charts, kind, chosen, at, wanted[chosen], rom)
    np.clip(charts.x, charts.lower, charts.upper, out=charts.x)
    return charts


def _by_first_angle(
    charts: Charts, kind: int, chosen: NDArray[np.int64], angle: Array, rom: RangeOfMotion
) -> Array:
    """Make the first angle of shoulder or wrist the coordinate; returns the swivel angles there."""
    joint = _FIRST[kind - 1]
    near = rom.middle[joint] if rom.width[joint] <= TURN + _NOTHING else angle
    angle = near + _wrapped(angle - near)
    rows, lower, upper = charts.rows[chosen], charts.lower[chosen], charts.upper[chosen]
    found = _of_angle(rows, kind, angle)
    away = np.abs(_wrapped(found - charts.near[chosen, None]))
    away[~(_alongside(rows, kind, angle, found) >= -_POLE)] = np.inf
    none = np.isinf(away).all(axis=1)
    second = (away[:, 1] <= away[:, 0]) | none
    psi = np.where(none, charts.near[chosen], np.where(second, found[:, 1], found[:, 0]))
    psi = charts.near[chosen] + _wrapped(psi - charts.near[chosen])
    inside = np.clip(psi, lower, upper)
    turned_by = _turn(rows, kind, psi, inside, np.zeros(len(psi)))
    moved = none | (np.abs(inside - psi) > _NOTHING) | (np.abs(turned_by) > _NOTHING)
    psi = inside
    angle = np.where(moved, _first_angle(rows, kind, psi, near), angle)
    again = _of_angle(rows, kind, angle)
    off = np.abs(_wrapped(again - psi[:, None]))
    second = np.where(moved, off[:, 1] <= off[:, 0], second)
    start, end, cut = _monotone(rows, kind, psi, lower, upper)
    rising = _turning(rows, kind, psi) > 0
    turned = []
    for ends, sign in ((start, -1.0), (end, 1.0)):
        about = angle + _turn(rows, kind, psi, ends, np.where(rising, sign, -sign))
        turned.append(np.where(ends == psi, about, _first_angle(rows, kind, ends, about)))
    low, high = np.minimum(*turned), np.maximum(*turned)
    inset = np.minimum(_ROUNDED, 0.5 * (high - low))
    charts.x[chosen] = angle
    charts.lower[chosen], charts.upper[chosen] = low + inset, high - inset
    charts.near[chosen] = 0.5 * (start + end)
    charts.cut[:, chosen] = np.where(rising, cut, cut[::-1])
    charts.rows[chosen, ROOT[0]] = np.where(second, 1.0, -1.0)
    return psi


def _keep_in_range(charts: Charts, kind: int, chosen: NDArray[np.int64], rom: RangeOfMotion) -> None:
    """Draw bounds in where rounding of an interval's end takes them out of the range of the outer joints.

    Beside a pole both joints turn alike, thousands of times as fast as the swivel angle.
    """
    rows, near = charts.rows[chosen], charts.near[chosen]
    joints = [_FIRST[kind - 1], _FIRST[kind - 1] + 2]
    limited = rom.width[joints] < TURN - _NOTHING
    for bound, inwards in ((charts.lower, 1.0), (charts.upper, -1.0)):
        x = bound[chosen]
        outer = np.column_stack([x, _third_angle(rows, kind, x, _on_root(rows, kind, x, near))])
        beyond = np.maximum(rom.lower[joints] - outer, outer - rom.upper[joints])
        off = np.where(limited, beyond, 0.0).max(axis=1)
        bound[chosen] = x + inwards * np.where((off > 0) & (off < _GROWN), off, 0.0)
    charts.upper[chosen] = np.maximum(charts.lower[chosen], charts.upper[chosen])


def _at_pole(
    charts: Charts, kind: int, chosen: NDArray[np.int64], psi: Array, wanted: Array, rom: RangeOfMotion
) -> None:
    """Bounds of the first angle where the curve runs right through the pole: it is free to turn there.

    The third angle turns against it (β = 0) or with it (β = π), everything else stands still.
    """
    rows = charts.rows[chosen]
    x, y = _entries(rows, kind)
    pole = _pole(rows, kind, psi)
    turn = np.column_stack([np.ones(len(pole)), np.cos(pole), np.sin(pole)])
    through = np.hypot((x * turn).sum(axis=1), (y * turn).sum(axis=1)) < _POLE
    through &= np.abs(_wrapped(pole - psi)) < _AT
    if not through.any():
        return
    at, turn, rows, wanted = chosen[through], turn[through], rows[through], wanted[through]
    C = rows[:, slice(*PARTS)].reshape(-1, 2, 3, 9)[:, kind - 1]
    sense = np.where((C[:, :, 8] * turn).sum(axis=1) > 0, -1.0, 1.0)
    first, third = _FIRST[kind - 1], _FIRST[kind - 1] + 2
    turned = _third_angle(rows, kind, wanted[:, first], pole[through])
    ends = [wanted[:, first] + sense * (limit - turned) for limit in (rom.lower[third], rom.upper[third])]
    vx, vy = (-part[through, 1] * turn[:, 2] + part[through, 2] * turn[:, 1] for part in (x, y))
    direction = wanted[:, first] + np.mod(np.arctan2(vy, vx) - wanted[:, first], np.pi)
    lower = np.maximum(rom.lower[first], np.minimum(*ends))
    upper = np.minimum(rom.upper[first], np.maximum(*ends))
    charts.cut[:, at] = [direction - np.pi > lower, direction < upper]
    charts.lower[at] = np.maximum(lower, direction - np.pi + _NOTHING)
    charts.upper[at] = np.maximum(charts.lower[at], np.minimum(upper, direction - _NOTHING))
    charts.near[at] = psi[through] + _wrapped(pole[through] - psi[through])
    charts.x[at] = wanted[:, first]
    found = _of_angle(rows, kind, np.clip(charts.x[at], charts.lower[at], charts.upper[at]))
    away = np.abs(_wrapped(found - charts.near[at][:, None]))
    charts.rows[at, ROOT[0]] = np.where(away[:, 1] <= away[:, 0], 1.0, -1.0)


def _pole(rows: Array, kind: int, psi: Array) -> Array:
    """The swivel angle near ψ at which the curve is nearest to a pole: where q33 is extreme."""
    C = rows[:, slice(*PARTS)].reshape(-1, 2, 3, 9)[:, kind - 1, :, 8]
    extreme = np.arctan2(C[:, 2], C[:, 1])
    return np.asarray(extreme + np.pi * np.rint((psi - extreme) / np.pi))


def _entries(rows: Array, kind: int) -> tuple[Array, Array]:
    """C0, C1, C2 of q13 and of q23, shape (n, 3) each."""
    C = rows[:, slice(*PARTS)].reshape(-1, 2, 3, 9)[:, kind - 1]
    return C[:, :, 2], C[:, :, 5]


def _equation(rows: Array, kind: int, angle: Array) -> Array:
    """a, b, c of a + b·cos ψ + c·sin ψ = 0 for the first angle (or the opposite one) to have a value."""
    x, y = _entries(rows, kind)
    return np.asarray(np.sin(angle)[:, None] * x - np.cos(angle)[:, None] * y)


def _of_angle(rows: Array, kind: int, angle: Array) -> Array:
    """Both swivel angles at which the first angle (or the opposite one) has a value; NaN if none has."""
    return zeros(_equation(rows, kind, angle))


def _alongside(rows: Array, kind: int, angle: Array, psi: Array) -> Array:
    """Positive where ψ, shape (n, m), has this first angle on the branch; negative for the opposite one."""
    (x, y), side = _entries(rows, kind), rows[:, BRANCH[0] + kind - 1]
    turn = np.stack([np.ones_like(psi), np.cos(psi), np.sin(psi)])
    vx, vy = (np.einsum("nk,knm->nm", part, turn) for part in (x, y))
    return np.asarray(side[:, None] * (np.cos(angle)[:, None] * vx + np.sin(angle)[:, None] * vy))


def _on_root(rows: Array, kind: int, angle: Array, near: Array) -> Array:
    """The swivel angle at which the first angle has a value, on the root that the rows name.

    A curve that passes a pole by next to nothing counts as going through it (`_at_pole`) and may miss
    the last few microradians before its turning point: then the turning point, as in `stage`.
    """
    equation = _equation(rows, kind, angle)
    found = zeros(equation)
    root = np.where(rows[:, ROOT[0]] > 0, found[:, 1], found[:, 0])
    a, b, c = equation.T
    root = np.where(np.isnan(root), np.arctan2(c, b) + np.pi * (a > 0), root)
    return np.asarray(root + TURN * np.rint((near - root) / TURN))


def _third_angle(rows: Array, kind: int, angle: Array, psi: Array) -> Array:
    """The third angle where the first one and the swivel angle are known, from Rz(-α)·Q as in `stage`."""
    C = rows[:, slice(*PARTS)].reshape(-1, 2, 3, 9)[:, kind - 1]
    Q = C[:, 0] + C[:, 1] * np.cos(psi)[:, None] + C[:, 2] * np.sin(psi)[:, None]
    c, s = np.cos(angle), np.sin(angle)
    found = np.arctan2(c * Q[:, 3] - s * Q[:, 0], c * Q[:, 4] - s * Q[:, 1])
    reference = rows[:, REFERENCE[0] + _FIRST[kind - 1] + 2]
    return np.asarray(reference + _wrapped(found - reference))


def _monotone(
    rows: Array, kind: int, psi: Array, lower: Array, upper: Array
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """The part of an interval around ψ on which the first angle is monotone."""
    turning = zeros(_turning_curve(rows, kind))
    ahead = np.sort(np.mod(turning - psi[:, None], TURN), axis=1)
    none = np.isnan(ahead).any(axis=1)
    after = psi + np.where(none, np.pi, ahead[:, 0])
    before = psi + np.where(none, -np.pi, ahead[:, 1] - TURN)
    inset = _INSET * (after - before)
    after, before = np.maximum(after - inset, psi), np.minimum(before + inset, psi)
    return np.maximum(lower, before), np.minimum(upper, after), np.array([before > lower, after < upper])


def _first_angle(rows: Array, kind: int, psi: Array, near: Array | float) -> Array:
    """The first angle at ψ, of those 2π apart the one nearest to another angle."""
    x, y = (part[:, 0] + part[:, 1] * np.cos(psi) + part[:, 2] * np.sin(psi) for part in _entries(rows, kind))
    side = rows[:, BRANCH[0] + kind - 1]
    found = np.arctan2(side * y, side * x)
    return np.asarray(near + _wrapped(found - near))


def _turning_curve(rows: Array, kind: int) -> Array:
    """V × v' as a + b·cos ψ + c·sin ψ."""
    (ax, bx, dx), (ay, by, dy) = (part.T for part in _entries(rows, kind))
    return np.column_stack([bx * dy - by * dx, ax * dy - ay * dx, -(ax * by - ay * bx)])


def _turning(rows: Array, kind: int, psi: Array) -> Array:
    """V × v', which has the sign of the slope of the first angle."""
    a, b, c = _turning_curve(rows, kind).T
    return np.asarray(a + b * np.cos(psi) + c * np.sin(psi))


def _turn(rows: Array, kind: int, psi: Array, ends: Array, sign: Array) -> Array:
    """By how much the first angle turns from ψ to the end of a stretch, in a known sense."""
    (x0, x1), (y0, y1) = (
        [part[:, 0] + part[:, 1] * np.cos(at) + part[:, 2] * np.sin(at) for at in (psi, ends)]
        for part in _entries(rows, kind)
    )
    turn = np.arctan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1)
    against = (turn * sign < -_NOTHING) & (np.abs(ends - psi) > 0)
    return np.asarray(turn + TURN * sign * against)


def _wrapped(angle: Array) -> Array:
    return np.asarray(angle - TURN * np.rint(angle / TURN))
