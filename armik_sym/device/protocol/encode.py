"""From samples and infos to the bytes on the wire."""

from __future__ import annotations

import struct

from armik_sym.device.channels import MOST_CHANNELS, DeviceInfo
from armik_sym.device.protocol import checksum, cobs
from armik_sym.device.protocol.frames import (
    INFO_CHANNEL,
    INFO_HEAD,
    KIND_INFO,
    KIND_SAMPLE,
    LONGEST_PAYLOAD,
    SAMPLE_HEAD,
    VERSION,
    Sample,
)
from armik_sym.errors import ProtocolError

DELIMITER = b"\0"


def encode_payload(payload: bytes) -> bytes:
    """Put a payload on the wire: delimiter, COBS(payload + CRC-32), delimiter.

    Args:
        payload: Version, kind and what follows, at most 64 bytes.

    Returns:
        The bytes on the wire.

    Raises:
        ProtocolError: If the payload is longer than 64 bytes.

    Source:
        None (this package); docs/device_protocol.md.
    """
    if len(payload) > LONGEST_PAYLOAD:
        raise ProtocolError(f"a payload of {len(payload)} bytes: at most {LONGEST_PAYLOAD} fit a frame")
    return DELIMITER + cobs.encode(checksum.seal(payload)) + DELIMITER


def encode_sample(sample: Sample) -> bytes:
    """Put a sample on the wire.

    Args:
        sample: The sample.

    Returns:
        The bytes on the wire, both delimiters included.

    Raises:
        ProtocolError: If a value does not fit its field, or flags and counts contradict each other.

    Source:
        None (this package); docs/device_protocol.md.
    """
    n = len(sample.counts)
    if not 1 <= n <= MOST_CHANNELS:
        raise ProtocolError(f"sample {sample.sequence} has {n} counts: give 1 to {MOST_CHANNELS}")
    if not 0 <= sample.index < 1 << n or sample.index.bit_count() != len(sample.index_counts):
        raise ProtocolError(
            f"sample {sample.sequence} has index flags {sample.index:#x} for {n} channels and "
            f"{len(sample.index_counts)} counts at the index: give one count per flag"
        )
    counts = sample.counts + sample.index_counts
    try:
        head = SAMPLE_HEAD.pack(VERSION, KIND_SAMPLE, sample.sequence, sample.time_us, n, sample.index)
        return encode_payload(head + struct.pack(f"<{len(counts)}H", *counts))
    except struct.error as error:
        raise ProtocolError(
            f"{sample} does not fit a frame ({error}): sequence and time have 32 bits, counts 16 bits; "
            "reduce them modulo 2^32 and 2^16"
        ) from error


def encode_info(info: DeviceInfo) -> bytes:
    """Put what a device says about itself on the wire.

    Args:
        info: The device.

    Returns:
        The bytes on the wire, both delimiters included.

    Source:
        None (this package); docs/device_protocol.md.
    """
    head = INFO_HEAD.pack(VERSION, KIND_INFO, info.device_id, int(info.rate), len(info.channels))
    channels = b"".join(INFO_CHANNEL.pack(channel.kind.value, channel.span) for channel in info.channels)
    name = info.firmware.encode("ascii")
    return encode_payload(head + channels + bytes([len(name)]) + name)
