"""Frames: what is written can be read, what does not fit is refused, the codes are the published ones."""

from __future__ import annotations

import random
import zlib

import pytest
from device_streams import random_frame, wire_of
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.device import (
    Channel,
    DeviceInfo,
    FrameParser,
    Sample,
    SensorKind,
    encode_payload,
    encode_sample,
)
from armik_sym.device.protocol import checksum, cobs
from armik_sym.device.protocol.frames import LONGEST_PAYLOAD
from armik_sym.errors import ProtocolError

POTENTIOMETER = Channel(SensorKind.POTENTIOMETER, 4096)


def stuffed_as_published(data: bytes) -> bytes:
    """The encoder of Cheshire & Baker's paper (their Figure 3), for blocks below 254 bytes."""
    out, code_at, code = bytearray([0]), 0, 1
    for byte in data:
        if byte:
            out.append(byte)
            code += 1
        else:
            out[code_at] = code
            code_at, code = len(out), 1
            out.append(0)
    out[code_at] = code
    return bytes(out)


def crc_bit_by_bit(data: bytes) -> int:
    """CRC-32/ISO-HDLC from its polynomial."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


@given(st.binary(max_size=cobs.LONGEST) | st.lists(st.sampled_from([0, 0, 1, 255]), max_size=253).map(bytes))
def test_stuffing_is_the_published_one_and_can_be_undone(data: bytes) -> None:
    chunk = cobs.encode(data)
    assert chunk == stuffed_as_published(data)
    assert 0 not in chunk
    assert len(chunk) == len(data) + 1
    assert cobs.decode(chunk) == data


@given(st.lists(st.sampled_from([1, 2, 3, 255]), max_size=12).map(bytes))
def test_stuffing_is_one_to_one(chunk: bytes) -> None:
    data = cobs.decode(chunk)
    assert data is None or cobs.encode(data) == chunk


def test_wrongly_stuffed_chunks_are_none() -> None:
    assert [cobs.decode(chunk) for chunk in (b"", b"\2", b"\3\1", b"\0", b"\1\0")] == [None] * 5
    with pytest.raises(ProtocolError, match="254 bytes cannot be stuffed"):
        cobs.encode(bytes(254))


@given(st.binary(max_size=80))
def test_checksum_is_the_published_one(data: bytes) -> None:
    sealed = checksum.seal(data)
    assert int.from_bytes(sealed[len(data) :], "little") == crc_bit_by_bit(data) == zlib.crc32(data)
    assert checksum.unseal(sealed) == data
    for bit in range(8 * len(sealed)):
        wrong = bytearray(sealed)
        wrong[bit // 8] ^= 1 << bit % 8
        assert checksum.unseal(bytes(wrong)) is None


def test_check_value_of_the_catalogue_of_checksums() -> None:
    assert crc_bit_by_bit(b"123456789") == zlib.crc32(b"123456789") == 0xCBF43926
    assert [checksum.unseal(bytes(n)) for n in range(5)] == [None, None, None, None, b""]


@given(st.randoms(use_true_random=False))
def test_what_is_written_can_be_read(rng: random.Random) -> None:
    frame = random_frame(rng)
    wire = wire_of(frame)
    assert wire[0] == wire[-1] == 0
    assert 0 not in wire[1:-1]
    assert FrameParser(keep_others=True).feed(wire) == [frame]


@pytest.mark.parametrize("field", ["sequence", "time_us"])
@pytest.mark.parametrize("value", [-1, 1 << 32])
def test_numbers_that_do_not_wrap_are_refused(field: str, value: int) -> None:
    good = {"sequence": 0, "time_us": 0, "counts": (1,)}
    with pytest.raises(ProtocolError, match=rf"{field}={value}.*modulo"):
        encode_sample(Sample(**{**good, field: value}))


@pytest.mark.parametrize(
    ("sample", "words"),
    [
        (Sample(3, 0, ()), "sample 3 has 0 counts: give 1 to 7"),
        (Sample(3, 0, (1,) * 8), "has 8 counts"),
        (Sample(3, 0, (1, 1 << 16)), "counts 16 bits"),
        (Sample(3, 0, (1, -1)), "counts 16 bits"),
        (Sample(3, 0, (1, 2), 4, (5,)), "index flags 0x4 for 2 channels"),
        (Sample(3, 0, (1, 2), -1), "index flags -0x1"),
        (Sample(3, 0, (1, 2), 1), "0 counts at the index: give one count per flag"),
        (Sample(3, 0, (1, 2), 1, (70000,)), "counts 16 bits"),
    ],
)
def test_samples_that_do_not_fit_are_refused(sample: Sample, words: str) -> None:
    with pytest.raises(ProtocolError, match=words):
        encode_sample(sample)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"device_id": 1 << 32}, "device id 4294967296"),
        ({"device_id": -1}, "device id -1"),
        ({"rate": 0}, "rate of 0 Hz"),
        ({"rate": 62.5}, "rate of 62.5 Hz"),
        ({"rate": float("nan")}, "rate of nan Hz"),
        ({"rate": float("inf")}, "rate of inf Hz"),
        ({"channels": ()}, "0 channels"),
        ({"channels": (POTENTIOMETER,) * 8}, "8 channels"),
        ({"firmware": "seventeen letters"}, "at most 16 printable"),
        ({"firmware": "größer"}, "printable ASCII"),
        ({"firmware": "a\n"}, "printable ASCII"),
    ],
)
def test_devices_that_do_not_fit_are_refused(change: dict[str, object], words: str) -> None:
    good = {"device_id": 1, "rate": 500.0, "channels": (POTENTIOMETER,), "firmware": "a 1"}
    with pytest.raises(ProtocolError, match=words):
        DeviceInfo(**{**good, **change})


@pytest.mark.parametrize(
    ("kind", "span"),
    [(SensorKind.POTENTIOMETER, 1), (SensorKind.POTENTIOMETER, 0x10001), (SensorKind.ENCODER, 1 << 32)],
)
def test_spans_that_do_not_fit_are_refused(kind: SensorKind, span: int) -> None:
    with pytest.raises(ProtocolError, match=f"a span of {span} counts is no {kind.name.lower()}'s"):
        Channel(kind, span)


def test_payloads_that_are_too_long_are_refused() -> None:
    assert len(encode_payload(bytes(LONGEST_PAYLOAD))) == 71
    with pytest.raises(ProtocolError, match="payload of 65 bytes: at most 64"):
        encode_payload(bytes(LONGEST_PAYLOAD + 1))
