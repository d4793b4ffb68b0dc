"""A solution in a few lines of text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from armik_sym.solution.solution import Solution


def summary(solution: Solution) -> str:
    """A short, honest summary for people: degrees and millimetres.

    Args:
        solution: The solution.

    Returns:
        Text of five to a dozen lines.

    Source:
        None (reporting).
    """
    with np.errstate(invalid="ignore"):  # angles that are not finite are told, not stumbled over
        return "\n".join(_lines(solution))


def _lines(s: Solution) -> list[str]:
    tightest, widest = int(np.argmin(s.rom_margin)), int(np.argmax(s.max_step))
    names = s.arm.joint_names
    verdict = "ok" if s.ok else "NOT ok"
    rotation = (
        "" if s.orientation.value == "none" else f", rotation {np.rad2deg(s.rotation_error.max()):.3g}°"
    )
    lines = [
        f"{verdict}: arm {s.arm.name}, {len(s.q)} samples over {s.path.duration:.3g} s, method {s.method}",
        f"  largest error   position {1000 * s.position_error.max():.3g} mm{rotation}",
        f"  margin to range {np.rad2deg(s.rom_margin[tightest]):.3g}° at the least ({names[tightest]})",
        f"  largest step    {np.rad2deg(s.max_step[widest]):.3g}° ({names[widest]}), "
        f"speed {np.rad2deg(s.max_speed.max()):.3g}°/s",
        f"  way in joints   {np.rad2deg(s.arc_length):.4g}°",
        f"  solver          {s.status}, {s.iterations} iterations; build {s.timing.build:.2g} s, "
        f"compile {s.timing.compile:.2g} s, solve {s.timing.solve:.2g} s",
    ]
    lines += [f"  because         {reason}" for reason in s.reasons]
    return lines
