"""Bytes damaged, lost or inserted on their way, and which frames that touched."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from armik_sym.device.simulator.faults import Faults

_MOST_GARBAGE = 8


class ByteDamage:
    """A line that damages bytes, the same ones for the same seed and the same frames.

    A frame counts as touched if one of its bytes, delimiters included, was changed or lost, or if garbage
    came between two of them. Garbage between two frames touches neither.
    """

    def __init__(self, faults: Faults, random: np.random.SeedSequence) -> None:
        """Prepare a line.

        Args:
            faults: Shares of the bytes.
            random: What decides which.
        """
        self._faults = faults
        self._random = np.random.default_rng(random)

    def carry(self, frames: Sequence[bytes]) -> list[tuple[bytes, bool]]:
        """Carry some frames.

        Args:
            frames: Their bytes, delimiters included.

        Returns:
            For each what arrives, with garbage behind it, and whether it is untouched.

        Source:
            None (this package).
        """
        faults = self._faults
        if not faults.touch_bytes:
            return [(frame, True) for frame in frames]
        ends = np.cumsum([len(frame) for frame in frames])
        drawn = self._random.random((3, int(ends[-1]) if len(ends) else 0))
        shares = (faults.damaged_bytes, faults.lost_bytes, faults.inserted_bytes)
        hits = drawn < np.array(shares)[:, np.newaxis]
        owners = set(np.searchsorted(ends, np.flatnonzero(hits.any(axis=0)), side="right").tolist())
        return [
            self._touched(frame, hits[:, ends[i] - len(frame) : ends[i]]) if i in owners else (frame, True)
            for i, frame in enumerate(frames)
        ]

    def _touched(self, frame: bytes, hits: NDArray[np.bool_]) -> tuple[bytes, bool]:
        """What arrives of a frame, given which of its bytes are damaged, lost, or followed by garbage."""
        damaged, lost, followed = hits
        arrived = bytearray()
        for place, byte in enumerate(frame):
            if damaged[place]:
                byte ^= int(self._random.integers(1, 256))
            if not lost[place]:
                arrived.append(byte)
            if followed[place]:
                arrived += self._random.bytes(int(self._random.integers(1, _MOST_GARBAGE + 1)))
        untouched = not (damaged.any() or lost.any() or followed[:-1].any())
        return bytes(arrived), untouched
