"""A solution in a few lines of text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from armik_sym.arm.display_units import joint_units

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
    fastest = int(np.argmax(s.max_speed))
    names, units = s.arm.joint_names, joint_units(s.arm)
    all_turn = all(unit.si == "rad" for unit in units)
    verdict = "ok" if s.ok else "NOT ok"
    rotation = (
        "" if s.orientation.value == "none" else f", rotation {np.rad2deg(s.rotation_error.max()):.3g}°"
    )
    lines = [
        f"{verdict}: arm {s.arm.name}, {len(s.q)} samples over {s.path.duration:.3g} s, method {s.method}",
        f"  largest error   position {1000 * s.position_error.max():.3g} mm{rotation}",
        f"  margin to range {units[tightest].text(s.rom_margin[tightest])} at the least ({names[tightest]})",
        f"  largest step    {units[widest].text(s.max_step[widest])} ({names[widest]}), "
        f"speed {units[fastest].text(s.max_speed[fastest], per='/s')} ({names[fastest]})",
        *([f"  way in joints   {np.rad2deg(s.arc_length):.4g}°"] if all_turn else []),
        f"  solver          {s.status}, {s.iterations} iterations; build {s.timing.build:.2g} s, "
        f"compile {s.timing.compile:.2g} s, solve {s.timing.solve:.2g} s",
    ]
    lines += [f"  because         {reason}" for reason in s.reasons]
    return lines
