"""Finding a device again after its cable was pulled: the system may give it another name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from serial.tools import list_ports


class ListedPort(Protocol):
    """What pyserial tells about a port."""

    device: str
    vid: int | None
    pid: int | None
    serial_number: str | None
    location: str | None


@dataclass(frozen=True)
class UsbIdentity:
    """What tells a USB adapter from others, whatever its port is called.

    Attributes:
        vid: Number of the vendor.
        pid: Number of the product.
        serial_number: Its own number, None for cheap adapters, of which any alike is taken then.
    """

    vid: int
    pid: int
    serial_number: str | None


def identity_of(device: str, ports: Iterable[ListedPort] | None = None) -> UsbIdentity | None:
    """The identity of the USB adapter behind a port.

    Args:
        device: Name of the port.
        ports: The ports there are; None: those of this computer now.

    Returns:
        The identity; None if it is no USB adapter.

    Source:
        pyserial 3.5 (`serial.tools.list_ports`).
    """
    for each in list_ports.comports() if ports is None else ports:
        if each.device == device and each.vid is not None and each.pid is not None:
            return UsbIdentity(each.vid, each.pid, each.serial_number)
    return None


def find_again(device: str, identity: UsbIdentity | None, ports: Iterable[ListedPort] | None = None) -> str:
    """The name under which a device can be opened now.

    Args:
        device: Its name before.
        identity: Its identity, if it has one.
        ports: The ports there are; None: those of this computer now.

    Returns:
        The old name if it is there again or nothing better is; else that of the one port with its identity.

    Source:
        pyserial 3.5 (`serial.tools.list_ports`).
    """
    if identity is None:
        return device
    there = [
        each.device
        for each in (list_ports.comports() if ports is None else ports)
        if (each.vid, each.pid, each.serial_number) == (identity.vid, identity.pid, identity.serial_number)
    ]
    return there[0] if device not in there and len(there) == 1 else device
