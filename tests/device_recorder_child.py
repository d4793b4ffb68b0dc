"""What runs in a process that is killed; imports little, so that many can be started."""

from __future__ import annotations

from multiprocessing.sharedctypes import Synchronized

from armik_sym.device.recording import Port, Recorder


def record_and_tell(port: str, file: str, received: Synchronized[int]) -> None:
    """Record, and say in shared memory how many bytes the port has handed over."""
    read = Port.read

    def counted(self: Port) -> bytes:
        data = read(self)
        received.value += len(data)
        return data

    Port.read = counted  # type: ignore[method-assign]
    Recorder(port, file).run()
