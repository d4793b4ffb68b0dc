"""What is typed during and for `armik calibrate`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import typer

from armik_sym.cli.console import say
from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.device.calibration import JointSetup
    from armik_sym.device.channels import DeviceInfo


class TypedDialogue:
    """Talks to the person over the terminal."""

    def say(self, text: str) -> None:
        """Tell something."""
        say(text)

    def ready(self) -> None:
        """Wait for the Enter key."""
        typer.prompt("Press Enter when it is held still", default="", show_default=False)

    def angle_deg(self, joint: str, proposed_deg: float) -> float:
        """Ask until an angle is typed that a joint can have."""
        while True:
            typed = float(typer.prompt(f"Angle of {joint} in degrees, when held still", default=proposed_deg))
            if math.isfinite(typed) and abs(typed) <= 360:
                return typed
            say(f"{typed:g}° is no angle of a joint: type degrees between -360 and 360.")


def channels_typed(text: str | None) -> list[int] | None:
    """Channels separated by commas."""
    if text is None:
        return None
    try:
        return [int(cell) for cell in text.split(",")]
    except ValueError:
        raise OptionError(
            f"--channels is {text!r}, expected whole numbers separated by commas, such as 0,2,1"
        ) from None


def setups_typed(setups: Sequence[JointSetup], info: DeviceInfo, signs: str) -> tuple[JointSetup, ...]:
    """Setups with the scales of datasheets and the directions typed."""
    from armik_sym.device.calibration import datasheet_scale

    directions = {"+": 1, "-": -1, "+1": 1, "-1": -1, "1": 1}
    cells = [cell.strip() for cell in signs.split(",")]
    if len(cells) != len(setups) or any(cell not in directions for cell in cells):
        raise OptionError(
            f"--datasheet is {signs!r}, expected {len(setups)} signs + or - separated by commas, one for "
            f"each of {', '.join(setup.joint for setup in setups)}: + if its counts grow with its angle"
        )
    return tuple(
        replace(setup, scale=datasheet_scale(info.channels[setup.channel]), direction=directions[cell])
        for setup, cell in zip(setups, cells, strict=True)
    )
