"""Segment lengths of the arm from body height."""

from __future__ import annotations

import math

from armik_sym.errors import UnitError

UPPER_ARM_PER_STATURE = 0.186
FOREARM_PER_STATURE = 0.146
HAND_PER_STATURE = 0.108

_STATURE_RANGE = (0.4, 2.8)


def segment_lengths(stature: float) -> dict[str, float]:
    """Average segment lengths of an adult arm from body height H.

    upper arm = 0.186 H, forearm = 0.146 H, hand = 0.108 H.

    Args:
        stature: Body height H, in [m].

    Returns:
        `{"upper_arm": .., "forearm": .., "hand": ..}`, in [m].

    Raises:
        UnitError: If the height is no plausible number of metres (0.4 to 2.8).

    Source:
        Winter (2009), Biomechanics and Motor Control of Human Movement (after Drillis & Contini).
    """
    low, high = _STATURE_RANGE
    if not math.isfinite(stature) or not low <= stature <= high:
        hint = ""
        if low * 100 <= stature <= high * 100:
            hint = f" (did you mean {stature / 100:g} m?)"
        elif low * 1000 <= stature <= high * 1000:
            hint = f" (did you mean {stature / 1000:g} m?)"
        raise UnitError(f"stature is {stature:g} m, expected {low:g} to {high:g} m{hint}")
    return {
        "upper_arm": UPPER_ARM_PER_STATURE * stature,
        "forearm": FOREARM_PER_STATURE * stature,
        "hand": HAND_PER_STATURE * stature,
    }
