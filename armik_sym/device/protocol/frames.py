"""What travels in a frame: samples, and what a frame is called that is neither sample nor info.

Layout of protocol version 1, all integers little endian. The first byte of a payload is the version, the
second the kind.

    info (0)     u8 version, u8 kind, u32 device id, u16 rate [Hz], u8 n, n x (u8 sensor kind, u32 span),
                 u8 length of the firmware name, the name in ASCII
    sample (1)   u8 version, u8 kind, u32 sequence, u32 time [us], u8 n, u8 index flags, n x u16 count,
                 then one u16 count at the index pulse per flag that is set, lowest channel first

The register of an encoder is latched at its index pulse and sent along: the pulse happens between two
samples, and the count at the sample alone would leave the zero in doubt by the movement of a whole period.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TypeAlias

from armik_sym.device.channels import DeviceInfo

VERSION = 1
"""Version of the protocol this package speaks; first byte of every payload."""

KIND_INFO = 0
KIND_SAMPLE = 1
FIRST_HOST_KIND = 128
"""Kinds from here on are written by hosts into recordings; devices never send them."""

LONGEST_PAYLOAD = 64
"""Bytes of a payload, version and kind included, at most: it bounds the memory of every parser."""

PREAMBLE = struct.Struct("<BB")
INFO_HEAD = struct.Struct("<BBIHB")
INFO_CHANNEL = struct.Struct("<BI")
SAMPLE_HEAD = struct.Struct("<BBIIBB")


@dataclass(frozen=True, slots=True)
class Sample:
    """One reading of all sensors.

    Attributes:
        sequence: Number of the sample, one higher each time, modulo 2^32, from 0 when the device was
            switched on. What is missing was lost, or could not be sent.
        time_us: Clock of the device when the sensors were read, modulo 2^32 (71.6 minutes), in [µs].
        counts: Raw count of each channel, 0 to 65535: ADC value, or register of the quadrature counter.
        index: Bit k is set if the index pulse of channel k came since the sample before.
        index_counts: Register at the latest index pulse of each channel whose bit is set, lowest
            channel first.
    """

    sequence: int
    time_us: int
    counts: tuple[int, ...]
    index: int = 0
    index_counts: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class OtherFrame:
    """A frame of this version with a right checksum whose kind is neither info nor sample.

    Attributes:
        kind: Its kind, 2 to 255; from 128 on it was written by a host into a recording.
        body: What follows the kind.
    """

    kind: int
    body: bytes


Frame: TypeAlias = Sample | DeviceInfo | OtherFrame
