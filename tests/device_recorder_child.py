"""What runs in a process that is killed; imports little, so that many can be started."""

from __future__ import annotations

from collections.abc import MutableSequence

from armik_sym.device.recording import Port, Recorder


def record_and_tell(port: str, file: str, received: MutableSequence[int]) -> None:
    """Record, and say in shared memory how many bytes the port had handed over before and with the last read.

    The memory has no lock: kill -9 would leave it locked for ever.
    """
    read = Port.read

    def counted(self: Port) -> bytes:
        data = read(self)
        received[0] = received[1]
        received[1] += len(data)
        return data

    Port.read = counted  # type: ignore[method-assign]
    Recorder(port, file).run()
