"""Which markers are which points of the arm."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from armik_sym.arm.toml_reader import check_keys, load_toml, sub_table
from armik_sym.errors import OptionError, RecordingError, UnknownNameError
from armik_sym.motion.marker_recording import MarkerRecording

# Points of the arm. Radial is the side of the thumb, ulnar that of the little finger.
POINTS = (
    "shoulder", "elbow", "wrist", "wrist_radial", "wrist_ulnar", "hand", "hand_radial", "hand_ulnar",
)  # fmt: skip

Names = str | Sequence[str]


@dataclass(frozen=True)
class MarkerMap:
    """Names of the markers of each point; a point is the mean of its markers.

    Attributes:
        points: Markers by point; the points are `shoulder`, `elbow`, `wrist` (or `wrist_radial` and
            `wrist_ulnar`), `hand`, `hand_radial`, `hand_ulnar`.
        side: "left" or "right"; None if not said.
        frame: The axes of the recording, such as "x forward, y up"; None if not said.
        source: The file it comes from, for messages.

    Raises:
        UnknownNameError: If a point has another name.
        OptionError: If a point has no markers, or one is missing.

    Source:
        None (this package).
    """

    points: Mapping[str, Names]
    side: str | None = None
    frame: str | None = None
    source: str = ""

    def __post_init__(self) -> None:
        clean = {}
        for point, names in self.points.items():
            if point not in POINTS:
                raise UnknownNameError(f"point{self._where}", point, POINTS)
            clean[point] = self._markers(point, names)
        if "wrist" not in clean and not {"wrist_radial", "wrist_ulnar"} <= clean.keys():
            self._refuse("wrist (or wrist_radial and wrist_ulnar)", clean)
        for point in ("shoulder", "elbow"):
            if point not in clean:
                self._refuse(point, clean)
        object.__setattr__(self, "points", clean)

    @property
    def _where(self) -> str:
        return f" in {self.source}" if self.source else ""

    @property
    def markers(self) -> tuple[str, ...]:
        """All markers, each once."""
        return tuple(dict.fromkeys(name for point in self.points for name in self.of(point)))

    def of(self, point: str) -> tuple[str, ...]:
        """Markers of one point.

        Args:
            point: The point.

        Returns:
            Names of its markers.

        Source:
            None (bookkeeping).
        """
        return self._markers(point, self.points[point])

    def _markers(self, point: str, names: object) -> tuple[str, ...]:
        listed = (names,) if isinstance(names, str) else names
        if not isinstance(listed, Sequence) or not listed or not all(isinstance(n, str) for n in listed):
            raise OptionError(
                f"points{self._where}: {point} is {names!r}, expected the name of a marker or a list of names"
            )
        return tuple(listed)

    def _refuse(self, point: str, given: Mapping[str, object]) -> None:
        raise OptionError(
            f"points{self._where}: {point} is missing (given: {', '.join(given) or 'nothing'}): say which "
            f"marker it is, as in {{'{point.split()[0]}': 'MARKER'}}"
        )

    def check_names(self, recording: MarkerRecording) -> None:
        """Refuse markers the recording does not have; all of them are listed.

        Args:
            recording: The recording.

        Raises:
            RecordingError: If a marker is not there.

        Source:
            None (bookkeeping).
        """
        missing = []
        for name in self.markers:
            try:
                recording.index(name)
            except UnknownNameError:
                missing.append(name)
        if missing:
            raise RecordingError(
                f"{recording.source or 'the recording'} has no marker {', '.join(map(repr, missing))}"
                f"{f' (wanted by {self.source})' if self.source else ''}: it has {', '.join(recording.names)}"
            )


def read_marker_map(path: str | os.PathLike[str]) -> MarkerMap:
    """Read which markers are which points from a TOML file.

    The table `[points]` has one line per point, `elbow = "RELB"` or `elbow = ["RELB_lat", "RELB_med"]`;
    `side = "right"` and `frame = "x forward, y up"` may stand before it.

    Args:
        path: The file.

    Returns:
        The map.

    Raises:
        ArmFileError: If the file cannot be read or has an unknown key.
        UnknownNameError: If a point has another name than `POINTS`.
        OptionError: If a point is missing or a value is no text.

    Source:
        None (file format of this package).
    """
    file = Path(path)
    table = load_toml(file)
    check_keys(file, "the file", table, ("points", "side", "frame"))
    for key in ("side", "frame"):
        if not isinstance(table.get(key, ""), str):
            raise OptionError(f"{file}: {key} is {table[key]!r}, expected a text")
    return MarkerMap(sub_table(file, table, "points"), table.get("side"), table.get("frame"), str(file))


def as_marker_map(points: MarkerMap | Mapping[str, Names] | str | os.PathLike[str]) -> MarkerMap:
    """A map from what a user may give: a map, names by point, or a TOML file.

    Args:
        points: Any of these.

    Returns:
        The map.

    Raises:
        ArmFileError: If it is a file that cannot be read.
        OptionError: If it is something else, or a point is missing.
        UnknownNameError: If a point has another name than `POINTS`.

    Source:
        None (bookkeeping).
    """
    if isinstance(points, MarkerMap):
        return points
    if isinstance(points, Mapping):
        return MarkerMap(points)
    if isinstance(points, (str, os.PathLike)):
        return read_marker_map(points)
    raise OptionError(f"points is {points!r}, expected names by point, a MarkerMap or a TOML file")
