"""Consistent overhead byte stuffing: bytes without zeros, so that a zero can only be the end of a frame.

Frames are shorter than 254 bytes, so every code byte ends in front of a zero of the data, never at a full
block: byte 0 and every zero of the data hold the distance to the next zero, or to the end. The encoding is
one byte longer than the data, always, and one-to-one.
"""

from __future__ import annotations

from armik_sym.errors import ProtocolError

LONGEST = 253
"""Bytes that can be encoded without a full block."""


def encode(data: bytes) -> bytes:
    """Take the zeros out of data.

    Args:
        data: At most 253 bytes.

    Returns:
        One byte more than data, none of them zero.

    Raises:
        ProtocolError: If data is longer.

    Source:
        Cheshire & Baker, Consistent overhead byte stuffing, IEEE/ACM Transactions on Networking 7 (1999).
    """
    if len(data) > LONGEST:
        raise ProtocolError(f"{len(data)} bytes cannot be stuffed in one block: give at most {LONGEST}")
    return b"".join(bytes([len(block) + 1]) + block for block in data.split(b"\0"))


def decode(chunk: bytes) -> bytes | None:
    """Put the zeros back; the inverse of `encode`.

    Args:
        chunk: Bytes between two delimiters, none of them zero.

    Returns:
        The data, or None if the distances do not end where the chunk ends.

    Source:
        Cheshire & Baker, Consistent overhead byte stuffing, IEEE/ACM Transactions on Networking 7 (1999).
    """
    data = bytearray(chunk)
    place, end = 0, len(chunk)
    while place < end:
        distance = chunk[place]
        if not distance:
            return None
        data[place] = 0
        place += distance
    return bytes(data[1:]) if place == end and end else None
