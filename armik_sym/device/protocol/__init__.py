"""The wire format between a measuring device and the host, version 1; docs/device_protocol.md explains it."""

from armik_sym.device.protocol.encode import encode_info, encode_payload, encode_sample
from armik_sym.device.protocol.frames import Frame, OtherFrame, Sample
from armik_sym.device.protocol.parser import FrameParser, ParserCounts

__all__ = [
    "Frame",
    "FrameParser",
    "OtherFrame",
    "ParserCounts",
    "Sample",
    "encode_info",
    "encode_payload",
    "encode_sample",
]
