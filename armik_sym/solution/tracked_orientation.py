"""What of a path's orientation a solver tracks."""

from __future__ import annotations

from armik_sym.errors import OptionError
from armik_sym.motion.hand_path import HandPath
from armik_sym.symbolic import Orientation


def tracked_orientation(wanted: str | None, path: HandPath) -> Orientation:
    """What of the path's orientation is tracked.

    Args:
        wanted: "full", "pointing" or "none"; None takes "full" if the path has rotations, else "none".
        path: The hand path.

    Returns:
        The orientation mode.

    Raises:
        OptionError: If the choice is unknown, or needs rotations the path does not have.

    Source:
        None (bookkeeping).
    """
    wanted = wanted or ("none" if path.rotation is None else "full")
    valid = [mode.value for mode in Orientation]
    if wanted not in valid:
        raise OptionError(f"orientation is {wanted!r}: valid are {', '.join(valid)}")
    if wanted != "none" and path.rotation is None:
        raise OptionError(
            f'orientation is {wanted!r} but the path has no rotations: give them, or use orientation="none"'
        )
    return Orientation(wanted)
