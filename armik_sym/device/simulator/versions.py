"""Frames of another version of the protocol, as a newer device would send them."""

from __future__ import annotations

from armik_sym.device.protocol import checksum, cobs
from armik_sym.device.protocol.encode import encode_payload
from armik_sym.errors import ProtocolError


def with_version(frame: bytes, version: int) -> bytes:
    """The same frame with another version in its first byte, and the checksum that belongs to it.

    Args:
        frame: Bytes on the wire, both delimiters included.
        version: The other version, 0 to 255.

    Returns:
        Bytes on the wire.

    Raises:
        ProtocolError: If the bytes are no frame.

    Source:
        None (this package); docs/device_protocol.md.
    """
    sealed = cobs.decode(frame[1:-1])
    payload = checksum.unseal(sealed) if sealed is not None else None
    if payload is None:
        raise ProtocolError(f"{len(frame)} bytes that are no frame: expected what encode_sample returns")
    return encode_payload(bytes([version]) + payload[1:])
