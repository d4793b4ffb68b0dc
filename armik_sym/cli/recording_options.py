"""Options about recordings, the same for every command that reads them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

Points = Annotated[
    Path | None,
    typer.Option(
        help="Markers: TOML file that says which are shoulder, elbow, wrist, hand. Default: markers so named."
    ),
]
Side = Annotated[
    str | None, typer.Option(help="Markers: left or right, if --points does not say it; a right is mirrored.")
]
Frame = Annotated[
    str | None,
    typer.Option(help="Markers: axes of the recording, as 'x forward, y up', if --points does not say."),
]
Base = Annotated[
    str | None,
    typer.Option(help="Markers: fixed, at the mean shoulder, or moving, as recorded. Default: fixed."),
]
Rom = Annotated[
    str | None,
    typer.Option(
        help="Markers: range of motion, model (that of the arm) or widened (where the person needs more). "
        "Default: model."
    ),
]
Cutoff = Annotated[
    float | None, typer.Option(help="Markers: low-pass filter at this many Hz (zero-phase Butterworth).")
]
Fill = Annotated[float | None, typer.Option(help="Markers: longest gap to fill, in s (cubic spline).")]
Unit = Annotated[
    str | None,
    typer.Option(
        help="Markers: unit of lengths of a .bvh file, which has none: m, cm, mm, or metres a unit."
    ),
]
Begin = Annotated[float | None, typer.Option(help="Markers: first time to use, in s.")]
End = Annotated[float | None, typer.Option(help="Markers: last time to use, in s.")]
Calibration = Annotated[
    Path | None, typer.Option(help="Device: calibration (TOML); default: the one in the recording.")
]


@dataclass(frozen=True)
class RecordingOptions:
    """What was typed about recorded markers; None where nothing was.

    Attributes:
        points: TOML file that says which markers are which points.
        side: "left" or "right".
        frame: Axes of the recording.
        base: "fixed" or "moving".
        rom: "model" or "widened".
        cutoff: Cut-off of the low-pass filter, in [Hz].
        fill: Longest gap to fill, in [s].
        unit: Unit of lengths of a file that has none.
        begin: First time to use, in [s].
        end: Last time to use, in [s].
    """

    points: Path | None
    side: str | None
    frame: str | None
    base: str | None
    rom: str | None
    cutoff: float | None
    fill: float | None
    unit: str | None
    begin: float | None
    end: float | None

    @property
    def typed(self) -> dict[str, object]:
        """The options by their name on the command line, None where they were not given."""
        return {f"--{name}": value for name, value in vars(self).items()}
