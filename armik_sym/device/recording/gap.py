"""A time in which nothing came from the device."""

from __future__ import annotations

from dataclasses import dataclass

from armik_sym.device.recording.host_frames import GapReason


@dataclass(frozen=True, slots=True)
class Gap:
    """A time in which nothing came from the device.

    Attributes:
        sample: Row of the first sample behind it; the number of samples if none came any more.
        reason: PORT_LOST if the port was gone (a cable was pulled), SILENCE if it stayed open.
        seconds: How long, by the clock of the host, in [s]; NaN if it did not end.
        lost: Samples missing by their numbers. Of a device that was switched off meanwhile only those it
            measured since it was on again.
    """

    sample: int
    reason: GapReason
    seconds: float
    lost: int
