"""Points of the arm and the pose of the hand they give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_TINY = 1e-12


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Recorded points over time, in the axes of the base of a left arm but from any origin.

    Attributes:
        points: Positions by name of the point (see `marker_map.POINTS`), each of shape (n, 3), in [m].
        turned: Fingers, ulnar and dorsal direction of the hand as columns if they were given with the
            recording, shape (n, 3, 3); None if they follow from the points.
    """

    points: Mapping[str, Array]
    turned: Array | None = None

    @property
    def shoulder(self) -> Array:
        """Shoulder centre, shape (n, 3), in [m]."""
        return self.points["shoulder"]

    @property
    def elbow(self) -> Array:
        """Elbow, shape (n, 3), in [m]."""
        return self.points["elbow"]

    @property
    def wrist(self) -> Array:
        """Wrist, or the middle of its two sides, shape (n, 3), in [m]."""
        return self._or_middle("wrist")

    @property
    def has_hand(self) -> bool:
        """Whether there is a point of the hand."""
        return "hand" in self.points or {"hand_radial", "hand_ulnar"} <= self.points.keys()

    @property
    def hand(self) -> Array:
        """Hand, or the middle of its two sides, shape (n, 3), in [m]."""
        return self._or_middle("hand")

    def _or_middle(self, name: str) -> Array:
        if name in self.points:
            return self.points[name]
        return 0.5 * (self.points[f"{name}_radial"] + self.points[f"{name}_ulnar"])

    def rows(self, chosen: NDArray[np.bool_]) -> Landmarks:
        """Some samples only.

        Args:
            chosen: A mask of samples, shape (n,).

        Returns:
            The points of these.

        Source:
            None (bookkeeping).
        """
        turned = None if self.turned is None else self.turned[chosen]
        return Landmarks({name: values[chosen] for name, values in self.points.items()}, turned)

    def moved(self, name: str, by: Array) -> Landmarks:
        """The same with one point moved.

        Args:
            name: The point.
            by: Shift, shape (3,) or (n, 3), in [m].

        Returns:
            The points.

        Source:
            None (bookkeeping).
        """
        return replace(self, points={**self.points, name: self.points[name] + by})

    def hand_directions(self) -> Array:
        """Fingers, ulnar and dorsal direction of the hand.

        Fingers: from wrist to hand. Dorsal: at right angles to the fingers and to the line across the hand
        (or, without one, the line across the wrist at right angles to the forearm, which gives the same
        angles of a wrist that bends about two axes). Ulnar: the third.

        Returns:
            Columns, shape (n, 3, 3).

        Source:
            None (definition).
        """
        if self.turned is not None:
            return self.turned
        fingers = _unit(self.hand - self.wrist)
        dorsal = _unit(np.cross(fingers, self._across()))
        return np.stack([fingers, np.cross(dorsal, fingers), dorsal], axis=2)

    def _across(self) -> Array:
        """A line from the radial to the ulnar side of the hand, not yet at right angles to the fingers."""
        radial, ulnar = self.points.get("hand_radial"), self.points.get("hand_ulnar")
        if radial is not None and ulnar is not None:
            return ulnar - radial
        if ulnar is not None:
            return ulnar - self.wrist
        if radial is not None:
            return self.wrist - radial
        forearm = _unit(self.wrist - self.elbow)
        line = self.points["wrist_ulnar"] - self.points["wrist_radial"]
        return np.asarray(line - forearm * np.einsum("ij,ij->i", line, forearm)[:, None])


def tells_hand_turned(points: Mapping[str, object]) -> bool:
    """Whether points say how the hand is turned.

    Args:
        points: Anything by name of the point.

    Returns:
        True with the hand and one side of it, both its sides, or the hand and both sides of the wrist.

    Source:
        None (definition).
    """
    sides = {"hand_radial", "hand_ulnar"} & points.keys()
    across_wrist = {"wrist_radial", "wrist_ulnar"} <= points.keys()
    return len(sides) == 2 or ("hand" in points and (bool(sides) or across_wrist))


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), _TINY))
