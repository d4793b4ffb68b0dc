"""A solution in a few lines of text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from armik_sym.arm.display_units import joint_units

if TYPE_CHECKING:
    from armik_sym.solution.lower_bound import LowerBound
    from armik_sym.solution.solution import Solution


def summary(solution: Solution) -> str:
    """A short, honest summary for people: degrees and millimetres.

    Args:
        solution: The solution.

    Returns:
        Text of five to a dozen lines, one more for each alternative.

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
    if s.cost is not None:
        gap = "" if s.bound is None else f", certified: {_certificate(s.bound)}"
        lines.append(f"  cost            {s.cost:.6g} 1/s{gap}")
    lines += _other_choices(s)
    lines += [f"  because         {reason}" for reason in s.reasons]
    return lines


def _certificate(bound: LowerBound) -> str:
    """How much cheaper any other trajectory can be, rounded up."""
    given = " with this start" if bound.known_first else ""
    percent = 100 * bound.gap
    digits = 10.0 ** (np.floor(np.log10(percent)) - 1) if percent > 0 else 1.0
    return f"none{given} is more than {digits * np.ceil(percent / digits - 1e-9):.2g} % cheaper"


def _other_choices(s: Solution) -> list[str]:
    """One line for every alternative: what it costs, and by how much and where it differs from the best."""
    names, units = s.arm.joint_names, joint_units(s.arm)
    lines = []
    for number, other in enumerate(s.alternatives, start=2):
        away = np.abs(other.q - s.q).max(axis=0)
        widest, tightest = int(np.argmax(away)), int(np.argmin(other.rom_margin))
        cost = "" if other.cost is None else f"cost {other.cost:.6g} 1/s, "
        differs = f"differs by up to {units[widest].text(away[widest])} ({names[widest]})"
        margin = f"margin {units[tightest].text(other.rom_margin[tightest])} ({names[tightest]})"
        against = "" if other.ok else f", NOT ok: {'; '.join(other.reasons)}"
        lines.append(f"  choice {number:<8d} {cost}{differs}, {margin}{against}")
    return lines
