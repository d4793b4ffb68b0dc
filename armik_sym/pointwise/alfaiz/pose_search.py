"""One pose, one side of the elbow: which swivel angle and which branches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.pointwise.alfaiz.closed_form import evaluate
from armik_sym.pointwise.alfaiz.limit_cuts import limit_cuts

Array = NDArray[np.float64]

# Angles by which a limit may be exceeded before the posture is put back, in [rad].
ROUNDING = 1e-12

_OUTSIDE = 10_000.0
_TURN = 2 * np.pi
_STEPS = 8
_ZOOM = 16
_VALLEYS = 3
_GROUPS = (slice(0, 3), slice(4, 7))


@dataclass(frozen=True, eq=False)
class Posture:
    """A posture on the curve.

    Attributes:
        q: Joint angles, shape (7,), in [rad].
        psi: Swivel angle, in [rad].
        margin: Smallest margin of shoulder and wrist, in [rad].
        cost: What is minimised.
        flipped: Whether shoulder and wrist take their second solution.
    """

    q: Array
    psi: float
    margin: float
    cost: float
    flipped: tuple[bool, bool]


class PoseSearch:
    """All postures that reach one pose with one side of the elbow, and the best of them.

    Names and order of decisions are those of compiled/c/alfaiz_search.h.

    Args:
        arm: The arm.
        target: Position and rotation row by row, shape (12,).
        side: 1 for θ4 ≥ 0, -1 for θ4 < 0.
        previous: Posture before, shape (7,), in [rad]; None if none counts.

    Source:
        Al-Faiz, eq. 4-57, corrected.
    """

    def __init__(self, arm: Arm, target: Array, side: float, previous: Array | None) -> None:
        self._rom = arm.rom
        self._previous = previous
        self._wish = arm.rom.middle if previous is None else previous
        self._curve = evaluate("alfaiz_curve", target, arm.length_values, side)[0]
        self._parts = self._curve[1:].reshape(2, 3, 9)
        self._pole = [_cos_sin(-self._wish[0]), _cos_sin(self._wish[4])]
        elbow = self._fitted(self._curve[:1], slice(3, 4))[0]
        self._elbow = float(elbow)
        self.elbow_margin = float(min(elbow - arm.rom.lower[3], arm.rom.upper[3] - elbow))
        self.evaluations = 0

    def everywhere(self, grid: int, refinements: int) -> Posture:
        """The best posture on the whole circle.

        Args:
            grid: Swivel angles looked at, besides one per cell.
            refinements: Times the surroundings of the best one are looked at more closely.

        Returns:
            The posture; its margin is negative if none is inside the range of motion.

        Source:
            Al-Faiz, §3.2.
        """
        cuts = limit_cuts(self._parts, self._rom)
        if self._previous is not None and (nearest := self._nearest(grid, cuts)) is not None:
            return nearest
        best = self._farthest(grid, refinements, cuts)
        if cuts.size and best.margin < 0:
            best = self._try(cuts, best)
        if self._previous is not None and best.margin >= -ROUNDING:
            best = self._follow(best)
        return best

    def follow_from_before(self, near: float) -> Posture | None:
        """The posture found by following the one before.

        Args:
            near: How far a joint may have moved, in [rad].

        Returns:
            The posture, None if it is not inside the range of motion or not near.

        Source:
            None (this package).
        """
        best = self._look(np.array([self._swivel_before()]))[0]
        if best.margin < -ROUNDING:
            return None
        best = self._follow(best)
        return best if np.abs(best.q - self._wish).max() <= near else None

    def _swivel_before(self) -> float:
        """The swivel angle at which the upper arm is turned most like before."""
        S = evaluate("alfaiz_shoulder", self._wish)[0]
        return float(np.arctan2(self._parts[0, 2] @ S, self._parts[0, 1] @ S))

    def _nearest(self, grid: int, cuts: Array) -> Posture | None:
        """The best few of grid, swivel before, cuts and middles between them, each followed downhill."""
        psi = np.append(_angles(grid, _TURN / grid, -np.pi), self._swivel_before())
        if cuts.size:
            middles = _middles(cuts)
            psi = np.concatenate([psi, cuts, middles - _TURN * (middles >= np.pi)])
        psi = np.sort(psi - _TURN * (psi >= np.pi))
        looked = self._look(psi)
        costs = np.array([posture.cost for posture in looked])
        valley = (costs < np.roll(costs, 1)) & (costs <= np.roll(costs, -1)) & (costs < _OUTSIDE)
        lowest = np.flatnonzero(valley)
        lowest = lowest[np.argsort(costs[lowest], kind="stable")][:_VALLEYS]
        self.evaluations += len(lowest)
        followed = [self._follow(looked[i]) for i in lowest]
        return min(followed, key=lambda posture: posture.cost, default=None)

    def _farthest(self, grid: int, refinements: int, cuts: Array) -> Posture:
        """The swivel angle farthest from all limits: a grid and one angle per cell, then more closely."""
        spacing = _TURN / grid
        psi = _angles(grid, spacing, -np.pi)
        if cuts.size:
            psi = np.append(psi, _middles(cuts))
        margins = self._margins(psi)
        k = int(np.argmax(margins))
        middle, margin = float(psi[k]), margins[k]
        aside = spacing if k < grid else middle - float(cuts[k - grid])
        for _ in range(refinements):
            step = aside / (_ZOOM // 2)
            psi = _angles(_ZOOM, step, middle - step * 0.5 * (_ZOOM - 1))
            margins = self._margins(psi)
            k = int(np.argmax(margins))
            if margins[k] > margin:
                middle, margin = float(psi[k]), margins[k]
            aside = step
        return self._look(np.array([middle]))[0]

    def _margins(self, psi: Array) -> Array:
        """Smallest margin at every swivel angle, with the best branches."""
        self.evaluations += len(psi)
        turn = np.column_stack([np.cos(psi), np.sin(psi)])
        sides = evaluate("alfaiz_quotients", self._curve, turn).reshape(-1, 2, 3, 2)
        cosines = sides[..., 1].copy()
        cosines[:, :, 1] = np.sqrt(cosines[:, :, 1])
        margin = np.full(len(psi), np.inf)
        for group, part in enumerate(_GROUPS):
            middle = self._rom.middle[part] * (1 if group else -1)
            branches = _both(np.arctan2(sides[:, group, :, 0], cosines[:, group]))
            away = branches - middle
            away = np.abs(away - _TURN * np.rint(away / _TURN))
            best = (0.5 * self._rom.width[part] - away).min(axis=-1).max(axis=0)
            margin = np.minimum(margin, best)
        return margin

    def _look(self, psi: Array) -> list[Posture]:
        """The best branches at every swivel angle: shoulder and wrist choose independently."""
        self.evaluations += len(psi)
        n = len(psi)
        c, s = np.cos(psi)[:, None], np.sin(psi)[:, None]
        q, margin = np.full((n, 7), self._elbow), np.full(n, _OUTSIDE)
        distance = np.full(n, (self._elbow - self._wish[3]) ** 2)
        flipped = np.zeros((n, 2), dtype=np.bool_)
        for group, part in enumerate(_GROUPS):
            C0, C1, C2 = self._parts[group]
            sides = evaluate("alfaiz_sides", C0 + C1 * c + C2 * s, self._pole[group]).reshape(n, 3, 2)
            angles = np.arctan2(sides[..., 0], sides[..., 1]) * (1 if group else -1)
            fitted = self._fitted(_both(angles), part)
            margins = np.minimum(fitted - self._rom.lower[part], self._rom.upper[part] - fitted).min(axis=-1)
            distances = ((fitted - self._wish[part]) ** 2).sum(axis=-1)
            second = margins[1] > margins[0]
            if self._previous is not None:
                inside = (margins >= -ROUNDING).all(axis=0)
                second = np.where(inside, distances[1] < distances[0], second)
            k, rows = second.astype(np.intp), np.arange(n)
            q[:, part], flipped[:, group] = fitted[k, rows], second
            margin = np.minimum(margin, margins[k, rows])
            distance += distances[k, rows]
        cost = -margin
        if self._previous is not None:
            cost = np.where(margin >= -ROUNDING, distance, _OUTSIDE - margin)
        return [
            Posture(q[i], float(psi[i]), float(margin[i]), float(cost[i]), (flipped[i, 0], flipped[i, 1]))
            for i in range(n)
        ]

    def _try(self, psi: Array, best: Posture) -> Posture:
        """The best of several swivel angles and the best before; the first of equals."""
        for posture in self._look(psi):
            if posture.cost < best.cost:
                best = posture
        return best

    def _follow(self, best: Posture) -> Posture:
        """Move psi to where the posture is nearest to the one before, inside the range of motion."""
        for _ in range(_STEPS):
            step = self._step(best)
            if not abs(step) > ROUNDING:
                return best
            step = float(np.clip(step, -0.5, 0.5))
            if abs(step) < 1e-4:  # too small to be judged by the cost
                new = self._look(np.array([best.psi + step]))[0]
                if not (new.margin >= -ROUNDING and new.cost <= best.cost + 1e-8):
                    return best
                if new.flipped != best.flipped:
                    return best
                best = new
                continue
            for _ in range(_STEPS):
                new = self._look(np.array([best.psi + step]))[0]
                if new.cost < best.cost:
                    break
                step *= 0.5
            else:
                return best
            best = new
        return best

    def _step(self, at: Posture) -> float:
        """Gauss-Newton step in psi towards the posture before."""
        c, s = np.cos(at.psi), np.sin(at.psi)
        slope, square = 0.0, ROUNDING
        for group, part in enumerate(_GROUPS):
            C0, C1, C2 = self._parts[group]
            rates = evaluate("alfaiz_rates", C0 + C1 * c + C2 * s, C2 * c - C1 * s, self._pole[group])[0]
            signs = np.full(3, 1.0 if group else -1.0)
            if at.flipped[group]:
                signs[1] = -signs[1]
            slope += float((at.q[part] - self._wish[part]) @ (signs * rates))
            square += float(rates @ rates)
        return -slope / square

    def _fitted(self, angle: Array, part: slice) -> Array:
        """Of all angle + 2πk the one inside the range nearest to the wish, or leaving the range least."""
        lower, upper, wish = self._rom.lower[part], self._rom.upper[part], self._wish[part]
        q = angle + _TURN * np.floor((wish - angle) / _TURN + 0.5)
        down = (q > upper + ROUNDING) & (lower - (q - _TURN) < q - upper)
        up = (q < lower - ROUNDING) & (q + _TURN - upper < lower - q)
        return np.asarray(q - _TURN * down + _TURN * up)


def _angles(count: int, spacing: float, first: float) -> Array:
    return first + spacing * np.arange(count, dtype=np.float64)


def _middles(cuts: Array) -> Array:
    """The middle of the stretch after every cut."""
    return np.asarray(0.5 * (cuts + np.append(cuts[1:], cuts[0] + _TURN)))


def _both(angles: Array) -> Array:
    """Both solutions of three angles, stacked in front."""
    a, b, c = np.moveaxis(angles, -1, 0)
    return np.stack([angles, np.stack([a + np.pi, np.pi - b, c + np.pi], axis=-1)])


def _cos_sin(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])
