"""The frames of a device, taken as their time comes."""

from __future__ import annotations

from armik_sym.device.simulator.simulated_device import SimulatedDevice, WireFrame


class FrameQueue:
    """What a device has yet to send."""

    def __init__(self, device: SimulatedDevice) -> None:
        """Start at its first frame.

        Args:
            device: The device.
        """
        self._frames = device.frames()
        self._next = next(self._frames)

    def take(self) -> WireFrame:
        """Take the next frame, due or not."""
        frame, self._next = self._next, next(self._frames)
        return frame

    def due(self, until: float) -> list[WireFrame]:
        """Take the frames up to a device time.

        Args:
            until: The device time; a frame of that very time stays, in [s].

        Returns:
            The frames in their order.

        Source:
            None (bookkeeping).
        """
        frames = []
        while self._next.time < until:
            frames.append(self.take())
        return frames
