"""The arm as a stick figure: where shoulder, elbow, wrist and hand are in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import joint_frames

Array = NDArray[np.float64]

_SAME_POINT = 1e-9


@dataclass(frozen=True, eq=False)
class StickFigure:
    """Points of the arm, from the body outwards, for every posture.

    Attributes:
        names: Names of the points.
        points: Positions, shape (n, points, 3), in [m].
    """

    names: tuple[str, ...]
    points: Array


def stick_figure(arm: Arm, q: Array) -> StickFigure:
    """The points at which the arm bends, for some postures.

    An arm with the segment lengths `upper_arm` and `forearm` has a shoulder (where the upper arm
    begins), an elbow and a wrist (where each ends), and a hand if it reaches beyond the wrist. Of any
    other arm the origins of all frames are taken, from base to hand.

    Args:
        arm: The arm.
        q: Postures, shape (n, dof), in [rad].

    Returns:
        The stick figure.

    Source:
        Nguyen 2021, Fig. 1 and Table 4 (frames of the arm).
    """
    origins = joint_frames(arm.chain, q, arm.lengths)[:, :, :3, 3]
    rows = {name: i for i, link in enumerate(arm.chain.links) for name in link.length_names}
    if "upper_arm" in rows and "forearm" in rows:
        # Row i leads from frame i to frame i + 1.
        frames = {"shoulder": rows["upper_arm"], "elbow": rows["upper_arm"] + 1, "wrist": rows["forearm"] + 1}
        last = origins.shape[1] - 1
        if _apart(origins[:, frames["wrist"]], origins[:, last]):
            frames["hand"] = last
        return StickFigure(tuple(frames), origins[:, list(frames.values())])
    kept = [0]
    for i in range(1, origins.shape[1]):
        if _apart(origins[:, kept[-1]], origins[:, i]):
            kept.append(i)
    names = ["base", *("" for _ in kept[2:]), *(["hand"] if len(kept) > 1 else [])]
    return StickFigure(tuple(names), origins[:, kept])


def _apart(a: Array, b: Array) -> bool:
    return bool(np.linalg.norm(a - b, axis=1).max() > _SAME_POINT)
