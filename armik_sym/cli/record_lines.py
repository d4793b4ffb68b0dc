"""A running recording in a few lines of text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from armik_sym.device.angles import LiveAngles
    from armik_sym.device.protocol import Sample
    from armik_sym.device.recording import RecorderStatus

_NONE = "--"


def status_line(status: RecorderStatus) -> str:
    """The counters of a recording.

    Args:
        status: How it stands.

    Returns:
        One line.

    Source:
        None (command line).
    """
    words = [
        f"{status.seconds:.1f} s",
        f"{status.rate:.0f} samples/s",
        f"{status.samples} samples",
        f"lost {status.lost}",
        f"damaged {status.damaged}",
        f"gaps {status.gaps}",
    ]
    if status.warnings:
        words.append(f"warnings {status.warnings}")
    if not status.connected:
        words.append("NOTHING COMES")
    return "  ".join(words)


def pose_lines(
    live: LiveAngles, names: Sequence[str], samples: Sequence[Sample], wanted: frozenset[str]
) -> list[str]:
    """Angles of device and human arm, and on request swivel angle and endpoint, at the latest sample.

    Args:
        live: Turns samples into angles.
        names: Joints measured. Human angles are shown if they are those of `catalog.ehmcs`.
        samples: All samples since the last call.
        wanted: "swivel", "endpoint" or both.

    Returns:
        A few lines.

    Source:
        Nguyen 2021, eq. 8 (human angles).
    """
    from armik_sym.arm.catalog import ehmcs, human
    from armik_sym.errors import ShapeError

    try:
        pose = live.pose(live.angles(samples)[-1:])
    except ShapeError as error:
        return [f"no angles: {error}"]
    n = len(names)
    lines = ["device [deg]  " + _angles(names, pose.device[0])]
    if n >= 3 and tuple(names) == ehmcs().joint_names[:n]:
        lines.append("human [deg]   " + _angles(human().joint_names[:n], pose.human[0]))
    if "swivel" in wanted:
        lines.append(f"swivel [deg]  {_number(np.degrees(pose.swivel[0]))}")
    if "endpoint" in wanted:
        x, y, z = (_number(1000 * value) for value in pose.endpoint[0])
        lines.append(f"endpoint [mm]  x {x}  y {y}  z {z}")
    return lines


def _angles(names: Sequence[str], q: Sequence[float]) -> str:
    pairs = zip(names, np.degrees(q), strict=True)
    return "  ".join(f"{name} {_number(angle)}" for name, angle in pairs)


def _number(value: float) -> str:
    return f"{value:.1f}" if np.isfinite(value) else _NONE
