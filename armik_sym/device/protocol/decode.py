"""From a payload with a right checksum to what it says."""

from __future__ import annotations

import struct

from armik_sym.device.channels import MOST_CHANNELS, Channel, DeviceInfo, SensorKind
from armik_sym.device.protocol.frames import INFO_CHANNEL, INFO_HEAD, SAMPLE_HEAD, Sample
from armik_sym.errors import ProtocolError

_COUNTS = tuple(struct.Struct(f"<{n}H") for n in range(2 * MOST_CHANNELS + 1))


def decode_sample(payload: bytes) -> Sample | None:
    """Read a sample.

    Args:
        payload: Payload of version 1 and kind 1, its checksum taken off.

    Returns:
        The sample, or None if the payload contradicts itself: a wrong length, no channel or too many,
        a flag without a channel.

    Source:
        None (this package); docs/device_protocol.md.
    """
    if len(payload) < SAMPLE_HEAD.size:
        return None
    _, _, sequence, time_us, n, index = SAMPLE_HEAD.unpack_from(payload)
    if not 1 <= n <= MOST_CHANNELS or index >> n:
        return None
    every = n + index.bit_count()
    if len(payload) != SAMPLE_HEAD.size + 2 * every:
        return None
    counts = _COUNTS[every].unpack_from(payload, SAMPLE_HEAD.size)
    return Sample(sequence, time_us, counts[:n], index, counts[n:])


def decode_info(payload: bytes) -> DeviceInfo | None:
    """Read what a device says about itself.

    Args:
        payload: Payload of version 1 and kind 0, its checksum taken off.

    Returns:
        The device, or None if the payload contradicts itself: a wrong length, an unknown kind of
        sensor, a value out of range.

    Source:
        None (this package); docs/device_protocol.md.
    """
    if len(payload) < INFO_HEAD.size:
        return None
    _, _, device_id, rate, n = INFO_HEAD.unpack_from(payload)
    at_name = INFO_HEAD.size + n * INFO_CHANNEL.size
    if len(payload) <= at_name or len(payload) != at_name + 1 + payload[at_name]:
        return None
    try:
        channels = tuple(
            Channel(SensorKind(kind), span)
            for kind, span in INFO_CHANNEL.iter_unpack(payload[INFO_HEAD.size : at_name])
        )
        return DeviceInfo(device_id, float(rate), channels, payload[at_name + 1 :].decode("ascii"))
    except (ProtocolError, ValueError):
        return None
