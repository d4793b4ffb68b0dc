"""Which markers are which points of the arm, and what to do where an arm cannot be made of them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.motion.marker_recording import MarkerRecording

_NEEDED = ("shoulder", "elbow")
_NO_ARM = (
    "Without shoulder and elbow no arm can be fitted, and where its base is remains unknown; the path of a "
    "hand alone is solved where it is given in the base frame of the arm: a csv file with time, x, y, z"
)


def own_names(recording: MarkerRecording) -> dict[str, str]:
    """Markers that are called like the points they are.

    Args:
        recording: The recording.

    Returns:
        Names of markers by point.

    Raises:
        OptionError: If shoulder or elbow is not among them.

    Source:
        None (command line).
    """
    from armik_sym.fitting.marker_map import POINTS

    own = {name: name for name in POINTS if name in recording.names}
    if not set(_NEEDED) <= own.keys():
        raise OptionError(
            "--points is missing: a TOML file that says which markers are shoulder, elbow, wrist, hand, as "
            f'in [points] shoulder = "NAME" (markers: {", ".join(recording.names)}). {_NO_ARM}'
        )
    return own


def check_points(file: Path) -> None:
    """Say what is to be done with a hand alone, before the fit says that points are missing.

    Args:
        file: TOML file that says which markers are which points.

    Raises:
        OptionError: If shoulder or elbow is not among them.
        ArmFileError: If the file cannot be read.

    Source:
        None (command line).
    """
    from armik_sym.arm.toml_reader import load_toml, sub_table

    given = sub_table(file, load_toml(file), "points")
    missing = [point for point in _NEEDED if point not in given]
    if missing:
        raise OptionError(f'{file}: [points] has no {missing[0]}, as in {missing[0]} = "NAME". {_NO_ARM}')
