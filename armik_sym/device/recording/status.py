"""How a recording stands, and what it came to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from armik_sym.device.channels import DeviceInfo
from armik_sym.device.protocol import Sample


@dataclass(frozen=True, slots=True)
class RecorderStatus:
    """How a recording stands.

    Attributes:
        seconds: Time since the recording began, in [s].
        connected: Whether the port is open and samples come.
        samples: Samples kept.
        rate: Samples per second, over the latest second, in [Hz].
        lost: Samples missing by their numbers.
        damaged: Pieces that were no frame.
        unknown_version: Frames of another version of the protocol.
        gaps: How often the line was lost or silent.
        restarts: How often the device began anew.
        warnings: How many warnings about sensors.
        info: The device, once it said who it is.
        sample: The latest sample.
    """

    seconds: float = 0.0
    connected: bool = False
    samples: int = 0
    rate: float = 0.0
    lost: int = 0
    damaged: int = 0
    unknown_version: int = 0
    gaps: int = 0
    restarts: int = 0
    warnings: int = 0
    info: DeviceInfo | None = None
    sample: Sample | None = None


@dataclass(frozen=True)
class RecordingSummary:
    """What a recording came to.

    Attributes:
        path: The file.
        status: The counters at its end.
        size: Size of the file, in [byte].
        notices: What was odd, in words; the first hundred.
    """

    path: Path
    status: RecorderStatus
    size: int
    notices: tuple[str, ...]

    def __str__(self) -> str:
        at = self.status
        lines = [
            f"{self.path}: {at.samples:,} samples in {at.seconds:.1f} s, {self.size / 1e6:.2f} MB",
            f"  lost            {_share(at.lost, at.samples + at.lost)}",
            f"  damaged         {at.damaged:,} pieces",
            f"  gaps            {at.gaps}",
        ]
        if at.unknown_version:
            lines.append(f"  other version   {at.unknown_version:,} frames of another protocol version")
        if at.restarts:
            lines.append(f"  restarts        {at.restarts} of the device")
        if at.warnings:
            lines.append(f"  sensor warnings {at.warnings}")
        return "\n".join(lines)


def _share(part: int, whole: int) -> str:
    percent = f" ({100 * part / whole:.2g} %)" if part and whole else ""
    return f"{part:,} samples{percent}"
