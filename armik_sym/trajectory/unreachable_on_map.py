"""Saying which samples have no posture at all, and which joint stands in the way."""

from __future__ import annotations

from armik_sym.errors import UnreachablePathError
from armik_sym.solution.tracking_error import tracking_errors
from armik_sym.swivel.map_class import SwivelMap
from armik_sym.swivel.postures_at import postures_at
from armik_sym.symbolic import Orientation

_LISTED = 4


def raise_unreachable_on_map(map_: SwivelMap) -> None:
    """Raise the error that names the samples without any posture, the joints that block and what is missing.

    Args:
        map_: The swivel map, with samples that are blocked on every branch.

    Raises:
        UnreachablePathError: Always; its distances are those of the posture that misses the range of motion
            least, put back inside.

    Source:
        None (reporting).
    """
    arm, path, samples = map_.arm, map_.path, map_.blocked
    why = map_.why_blocked(samples)
    q = arm.rom.clip(postures_at(map_.intervals.curves, samples, why.branch, why.psi, backend=map_.backend).q)
    rotation = None if path.rotation is None else path.rotation[samples]
    shift, turn = tracking_errors(arm, q, path.position[samples], rotation, Orientation.FULL)
    lines = map_.explain_blocked()
    left = len(lines) - _LISTED
    more = f"; and {left} more stretch{'es' if left > 1 else ''}" if left > 0 else ""
    raise UnreachablePathError(
        f"{len(samples)} of {len(path)} samples cannot be reached by arm {arm.name!r} inside its range of "
        f'motion: {"; ".join(lines[:_LISTED])}{more}. Use tracking="soft" for the nearest continuous motion, '
        f"or check units, shoulder position, segment lengths (reach {arm.reach:.3g} m) and range of motion.",
        samples,
        shift,
        turn,
    )
