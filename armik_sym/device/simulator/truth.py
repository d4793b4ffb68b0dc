"""What became of every sample of a simulated device: what a recorder can be held against."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Sequences = NDArray[np.int64]


class Fate(IntEnum):
    """What became of a sample.

    NOT_SENT: the port was closed, nobody had it open, or the device was silent. TOUCHED: sent, with a byte
    changed, lost, or come in between. WHOLE: sent as it was made. UNKNOWN: sent, but perhaps still unread
    when the port closed, because the reader had stopped reading.
    """

    NOT_SENT = 0
    TOUCHED = 1
    WHOLE = 2
    UNKNOWN = 3


class Truth:
    """The fate of every sample so far, one byte each; safe to read while the device runs.

    Samples are numbered through, from the first sequence number on: no wrap, and no new beginning where the
    device restarts. "Sent" means that the operating system took all its bytes while a reader had the port
    open. What a reader leaves behind when it closes the port itself is sent, though nobody read it.
    """

    def __init__(self, first_sequence: int = 0) -> None:
        """Start before the first sample.

        Args:
            first_sequence: Sequence number of the first sample.
        """
        self._first = first_sequence
        self._fates = bytearray()

    def __len__(self) -> int:
        return len(self._fates)

    def set(self, number: int, fate: Fate) -> None:
        """Note the fate of a sample.

        Args:
            number: Which one, from 0, sequence number or not; samples skipped were not sent.
            fate: What became of it.

        Source:
            None (bookkeeping).
        """
        missing = number + 1 - len(self._fates)
        if missing > 0:
            self._fates.extend(bytes(missing))
        self._fates[number] = fate

    def forget_latest(self, samples: int) -> None:
        """Note that the latest samples sent may not have been read before the port closed.

        Args:
            samples: How many, at most.

        Source:
            None (bookkeeping).
        """
        fates = np.frombuffer(bytes(self._fates), dtype=np.uint8)
        for number in np.flatnonzero(fates != Fate.NOT_SENT)[-samples:] if samples else ():
            self._fates[number] = Fate.UNKNOWN

    def count(self, *fates: Fate) -> int:
        """How many samples met one of these fates.

        Args:
            fates: The fates.

        Returns:
            Their number.

        Source:
            None (bookkeeping).
        """
        return sum(self._fates.count(int(fate)) for fate in fates)

    @property
    def sent(self) -> Sequences:
        """Sequence numbers of the samples sent, touched or not, never wrapped, shape (k,)."""
        return self._where(Fate.TOUCHED, Fate.WHOLE, Fate.UNKNOWN)

    @property
    def undamaged(self) -> Sequences:
        """Sequence numbers of the samples sent whose bytes all arrived as they were, shape (k,)."""
        return self._where(Fate.WHOLE)

    @property
    def damaged(self) -> Sequences:
        """Sequence numbers of the samples sent with a byte changed, lost or in between, shape (k,)."""
        return self._where(Fate.TOUCHED)

    @property
    def not_sent(self) -> Sequences:
        """Sequence numbers of the samples that were measured and not sent, shape (k,)."""
        return self._where(Fate.NOT_SENT)

    def _where(self, *fates: Fate) -> Sequences:
        states = np.frombuffer(bytes(self._fates), dtype=np.uint8)
        return np.flatnonzero(np.isin(states, [int(fate) for fate in fates])).astype(np.int64) + self._first
