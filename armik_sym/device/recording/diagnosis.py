"""What to tell somebody whose device sends nothing that can be used."""

from __future__ import annotations

import string

from armik_sym.device.protocol import FrameParser
from armik_sym.device.protocol.frames import VERSION

_PRINTABLE = frozenset(string.printable.encode())
_TEXT_SHARE = 0.95
_FEW = 16


def why_no_samples(parser: FrameParser, received: int, first_bytes: bytes, baud: int, device: str) -> str:
    """Why no sample came, as far as the bytes tell, and what to check.

    Args:
        parser: What was counted.
        received: How many bytes came.
        first_bytes: The first of them.
        baud: The baud rate of the port.
        device: Its name.

    Returns:
        One or two sentences.

    Source:
        None (this package).
    """
    counts = parser.counts
    others = sorted(parser.versions_seen - {VERSION})
    if not received:
        return (
            "no byte came: check that the device has power and sends, that its cable carries data, and that "
            f"{device} is its port"
        )
    if others:
        return (
            f"the device speaks protocol version {', '.join(map(str, others))}, this package speaks version "
            f"{VERSION}: update the firmware or armik_sym, whichever is older"
        )
    if counts.infos:
        return "the device says who it is but sends no samples: start it, or look at its firmware"
    came = f"{received:,} bytes came, but no whole frame"
    if _is_text(first_bytes):
        start = first_bytes[:40].decode("ascii", "replace").strip()
        return f"{came}; they are text ({start!r}): another device, or a firmware without this protocol"
    if "://" in device:
        return f"{came}: check that the device behind {device} speaks this protocol, and its baud rate there"
    return (
        f"{came}: most likely the baud rate is wrong (this port runs at {baud}; give the firmware's with "
        "--baud), or it is another device"
    )


def _is_text(data: bytes) -> bool:
    return len(data) >= _FEW and sum(byte in _PRINTABLE for byte in data) >= _TEXT_SHARE * len(data)
