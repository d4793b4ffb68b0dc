"""A servo check in a few lines of text."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from armik_sym.servo.check import ServoCheck
    from armik_sym.servo.verdict import JointVerdict

_HEAD = "  joint                         speed [°/s]      torque [Nm]        RMS [Nm]       off [°]   margins"


def summary(check: ServoCheck) -> str:
    """What a check found: a verdict, one line per joint with limits in brackets, and the reasons.

    Args:
        check: The check.

    Returns:
        The text.

    Source:
        None (reporting).
    """
    t, setup = check.tracking, check.setup
    o = setup.options
    verdict = "ok: the drives can follow" if check.ok else "NOT ok: the drives cannot follow"
    lines = [
        f"{verdict}: arm {setup.arm.name}, drive {setup.drive.name}, {t.time[-1]:.3g} s",
        f"  controller      {o.controller}, {o.bandwidth:g} Hz, {math.degrees(o.margin):.3g}°, feed-forward "
        f"{o.feedforward}, gravity {'compensated' if o.gravity else 'not compensated'}, {setup.rate:g} Hz",
        f"  hand            {1000 * t.hand_rms:.3g} mm RMS, {1000 * t.hand_peak:.3g} mm at most",
        _HEAD,
        *(_row(joint) for joint in check.joints),
    ]
    if not t.settled:
        lines.append(
            f"  note            the last of {t.passes} passes over the load still moved joints by "
            f"{math.degrees(t.change):.2g}°"
        )
    lines += [f"  because         {reason}" for reason in check.reasons]
    return "\n".join(lines)


def _row(v: JointVerdict) -> str:
    def pair(value: float, limit: float) -> str:
        return f"{value:.3g} ({limit:.3g})"

    m = v.margins
    speed = pair(math.degrees(v.speed), math.degrees(v.speed_limit))
    return (
        f"  {v.name:28} {speed:>13} {pair(v.torque, v.torque_limit):>16} "
        f"{pair(v.torque_rms, v.torque_rated):>15} {math.degrees(v.error_peak):>13.3g}   "
        f"{math.degrees(m.phase):.0f}°, {20 * math.log10(m.gain):.0f} dB, "
        f"Ms {m.sensitivity:.2f}{'' if v.ok else '  not ok'}"
    )
