"""Why a port cannot be opened, and what to do about it, on Linux, macOS and Windows."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

from serial.tools import list_ports

from armik_sym.errors import DeviceError

_BUSY = {errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK}
_MISSING = {errno.ENOENT, errno.ENODEV, errno.ENXIO}


def port_error(device: str, error: Exception, baud: int) -> DeviceError:
    """The error to raise for a port that could not be opened.

    Args:
        device: The port.
        error: What pyserial raised.
        baud: The baud rate asked for.

    Returns:
        An error that says what is wrong and what to do.

    Source:
        None (this package); messages of pyserial 3.5.
    """
    number, text = getattr(error, "errno", None), str(error)
    if "://" in device:
        return DeviceError(f"{device}: {_network(device, text)}")
    if number in _MISSING or "FileNotFoundError" in text or "WinError 2" in text:
        return DeviceError(f"{device}: no such port. {found_ports()}")
    if number in _BUSY:
        return DeviceError(f"{device}: the port is busy. {_busy(device)}")
    if number in (errno.EACCES, errno.EPERM) or "PermissionError" in text:
        return DeviceError(f"{device}: {_denied(device, text)}")
    if "baud" in text.lower():
        return DeviceError(f"{device}: does not work at {baud} baud ({text}): give the rate of the firmware")
    if "configure port" in text or number == errno.EISDIR:
        return DeviceError(f"{device}: is no serial port ({text}). {found_ports()}")
    return DeviceError(f"{device}: cannot be opened ({text}). {found_ports()}")


def found_ports() -> str:
    """The serial ports of this computer in words.

    Returns:
        One sentence.
    """
    ports = sorted(list_ports.comports(), key=lambda port: port.device)
    if not ports:
        return (
            "No serial port was found on this computer: plug the device in, look at its cable (some only "
            "charge), or give a URL such as socket://HOST:PORT"
        )
    names = [
        each.device + (f" ({each.description})" if each.description not in ("", "n/a", None) else "")
        for each in ports
    ]
    return f"Found: {', '.join(names)}"


def holders(device: str, processes: Path = Path("/proc")) -> list[str]:
    """Programs that have a device open, as far as this user may see them (Linux).

    Args:
        device: The device node.
        processes: Where the system shows its processes.

    Returns:
        For example ["minicom (process 4711)"].

    Source:
        proc(5).
    """
    target, found = os.path.realpath(device), []
    for handle in processes.glob("[0-9]*/fd/*"):
        try:
            if os.readlink(handle) == target:  # noqa: PTH115 - the plain text, not a path
                process = handle.parent.parent
                name = (process / "comm").read_text(encoding="utf-8", errors="replace").strip()
                found.append(f"{name} (process {process.name})")
        except OSError:
            continue
    return sorted(set(found))


def _busy(device: str) -> str:
    who = holders(device)
    close = f"It is held by {', '.join(who)}: close that program" if who else "Close the program that uses it"
    return f"{close} (serial monitor, another recording); on Linux ModemManager probes new ports for a minute"


def _denied(device: str, text: str) -> str:
    if sys.platform == "win32" or "Access is denied" in text:
        return (
            "access was denied, which on Windows means that another program has the port open: close it "
            "(Arduino's serial monitor, PuTTY, another recording)"
        )
    who = holders(device)
    held = f" It is held by {', '.join(who)}." if who else ""
    return (
        f"permission denied.{held} On Linux ports belong to the group dialout (Debian, Ubuntu, Fedora) or "
        "uucp (Arch): run 'sudo usermod -aG dialout $USER', log out and in again; 'ls -l "
        f"{device}' shows the group"
    )


def _network(device: str, text: str) -> str:
    scheme = device.split("://", 1)[0]
    if "refused" in text:
        return f"nothing listens there ({text}): start the server, look at host and port number"
    if "invalid URL" in text or "expected a string" in text:
        return f"{text}. Valid are /dev/ttyUSB0, COM3, socket://HOST:PORT, rfc2217://HOST:PORT, loop://"
    return f"cannot be opened ({text}): look at {scheme}://HOST:PORT and whether the host can be reached"
