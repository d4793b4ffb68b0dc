"""The checksum behind every payload: CRC-32 as in zlib, PNG and Ethernet."""

from __future__ import annotations

import zlib

SIZE = 4
"""Bytes of the checksum."""


def seal(payload: bytes) -> bytes:
    """Append the checksum to a payload.

    Args:
        payload: Any bytes.

    Returns:
        The payload and its CRC-32, little endian.

    Source:
        CRC-32/ISO-HDLC: reflected polynomial 0x04C11DB7, initial value and final XOR 0xFFFFFFFF.
    """
    return payload + zlib.crc32(payload).to_bytes(SIZE, "little")


def unseal(sealed: bytes) -> bytes | None:
    """Check the checksum and take it off.

    Args:
        sealed: What `seal` made, or anything else.

    Returns:
        The payload, or None if the checksum is wrong or there is none.

    Source:
        CRC-32/ISO-HDLC: reflected polynomial 0x04C11DB7, initial value and final XOR 0xFFFFFFFF.
    """
    payload = sealed[:-SIZE]
    if len(sealed) < SIZE or zlib.crc32(payload) != int.from_bytes(sealed[-SIZE:], "little"):
        return None
    return payload
