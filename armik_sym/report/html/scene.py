"""What the page needs to draw and play the arm: postures, references, directions in words."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.display_units import joint_units
from armik_sym.arm.model import Arm
from armik_sym.report.html.chapter import Chapter
from armik_sym.report.html.chart import SOLVED_LINE, styles_of
from armik_sym.report.stick_figure import stick_figure
from armik_sym.report.words import joint_title

Array = NDArray[np.float64]

_FORWARD = "z forward"
# A schematic body beside the shoulder, for orientation: along outward and up, in [m].
_BODY = ((0.0, 0.0), (-0.18, 0.03), (-0.18, -0.5), (-0.18, 0.03), (-0.36, 0.0), (-0.18, 0.03), (-0.18, 0.1))
_HEAD, _HEAD_RADIUS = (-0.18, 0.22), 0.11


def scene_of(chapter: Chapter, kinematics: int) -> dict[str, Any]:
    """Everything the player of a chapter needs.

    Args:
        chapter: The chapter.
        kinematics: Which of the page's kinematics moves its arm.

    Returns:
        Plain dictionaries; arrays as base64, the other motions in single precision.

    Source:
        None (this package).
    """
    s, styles = chapter.solution, styles_of(chapter.motions)
    motions = [{"name": "solved", "style": _look(SOLVED_LINE), "q": packed(s.q)}]
    motions += [
        {"name": name, "style": _look(styles[name]), **_points(s.arm, q)}
        for name, q in chapter.motions.items()
    ]
    reference = None if chapter.map is None else packed(chapter.map.reference)
    return {
        "kinematics": kinematics,
        "time": packed(s.time),
        "motions": motions,
        "reference": reference,
        "path": packed(s.path.position, "<f4") if chapter.path_known else None,
        "jointTitles": [joint_title(name) for name in s.arm.joint_names],
        "units": [{"symbol": unit.symbol, "factor": unit.factor} for unit in joint_units(s.arm)],
        **_directions(s.arm),
        "body": None if s.arm.up is None or s.arm.outward is None else _body(s.arm),
    }


def _points(arm: Arm, q: Array) -> dict[str, Any]:
    """Where another motion has the points of the arm; it is only drawn, so no kinematics is needed for it."""
    points = stick_figure(arm, q).points
    return {"points": packed(points, "<f4"), "count": points.shape[1]}


def packed(values: ArrayLike, kind: str = "<f8") -> str:
    """Numbers as text.

    Args:
        values: Any shape.
        kind: "<f8" for all digits, "<f4" for what is only drawn.

    Returns:
        Base64 of the numbers, little endian, row by row.

    Source:
        RFC 4648.
    """
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def _look(style: dict[str, Any]) -> dict[str, Any]:
    return {"color": style["color"], "width": style["width"], "dash": style.get("dash", "")}


def _directions(arm: Arm) -> dict[str, Any]:
    """How the base frame is drawn: rows of a rotation, names of the axes, where the front is, views.

    The rows are across, outward and up: a proper rotation, so that a left arm stays a left arm.
    """
    if arm.up is None or arm.outward is None:
        names = ["x [mm]", "y [mm]", "z [mm]"]
        views = {"front": "Along x", "side": "Along y", "top": "Along z"}
        return {"view": np.eye(3).ravel().tolist(), "axes": names, "front": 1, "views": views}
    up = np.asarray(arm.up)
    outward = arm.outward - up * (arm.outward @ up)
    outward = outward / np.linalg.norm(outward)
    across = np.cross(outward, up)
    known = _FORWARD in arm.description
    front = 1 if across[2] >= 0 or not known else -1
    word = ("forward" if front > 0 else "backward") if known else "across"
    return {
        "view": np.array([across, outward, up]).ravel().tolist(),
        "axes": [f"{word} [mm]", "outward [mm]", "up [mm]"],
        "front": front,
        "views": {
            "front": "From the front" if known else "From one end",
            "side": "From the side",
            "top": "From above",
        },
    }


def _body(arm: Arm) -> list[list[float]]:
    """A stick figure without arms, from the shoulder, along the base frame, shape (k, 3)."""
    up, outward = np.asarray(arm.up), np.asarray(arm.outward)
    centre = _HEAD[0] * outward + _HEAD[1] * up
    turn = np.linspace(-0.5 * np.pi, 1.5 * np.pi, 25)[:, None]
    head = centre + _HEAD_RADIUS * (np.cos(turn) * outward + np.sin(turn) * up)
    trunk = np.array([a * outward + b * up for a, b in _BODY])
    points: list[list[float]] = np.concatenate([trunk, head]).tolist()
    return points
