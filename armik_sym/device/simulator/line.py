"""What a simulated device sends through: a port that one reader at a time can open."""

from __future__ import annotations

from typing import Protocol


class ReaderGoneError(Exception):
    """The reader closed the port while bytes were written to it; no error of anybody, so no ArmikError."""


class Line(Protocol):
    """A port seen from the device's end. Nothing here blocks longer than it is told to."""

    @property
    def port(self) -> str:
        """What a reader opens; the same after closing and opening again."""
        ...

    def open(self) -> None:
        """Let readers open the port.

        Raises:
            DeviceError: If the system does not give one.
        """
        ...

    def ready(self) -> bool:
        """Whether a reader has the port open and gets all that is written from now on."""
        ...

    def write(self, data: memoryview) -> int:
        """Write what fits at once.

        Args:
            data: Bytes.

        Returns:
            How many of them were taken; 0 if there is no room.

        Raises:
            ReaderGoneError: If the reader closed the port.

        Source:
            None (definition).
        """
        ...

    def wait(self, seconds: float) -> None:
        """Wait until there may be room.

        Args:
            seconds: At most this long, in [s].

        Source:
            None (definition).
        """
        ...

    def unread(self) -> int:
        """How many bytes written are still unread, at most; closing the port now would lose them."""
        ...

    def close(self) -> None:
        """Close the port, so that its reader notices; again does nothing."""
        ...
