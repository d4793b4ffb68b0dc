"""100,000 fuzzed streams: no exception, no wrong checksum, C and Python agree on every frame and counter."""

from __future__ import annotations

import ctypes
import functools
import random
import zlib

import pytest
from compiled_helpers import CC
from device_c import build, c_answers, python_counters
from device_streams import cut, damaged, generator, odd_payload, random_frame, too_long, wire_of
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from armik_sym.device import FrameParser, encode_payload

EXAMPLES, STREAMS = 100, 1000  # hypothesis draws what an example is like; it holds many streams


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL | None:
    """The C parser, or None where there is no compiler: then Python's is tested alone."""
    return build(tmp_path_factory.mktemp("frames")) if CC else None


def some_stream(rng: random.Random, pool: list[bytes], edits: int, garbage: float) -> bytes:
    if rng.random() < garbage:
        letters = rng.choice((bytes(range(256)), b"\0\1\2\3", b"\0\0\0\1\5\xff"))
        return bytes(rng.choices(letters, k=rng.randint(0, 90)))
    return damaged(b"".join(rng.choices(pool, k=rng.randint(1, 3))), rng, rng.randint(0, edits))


@functools.lru_cache(maxsize=200)
def has_right_checksum(wire: bytes) -> bool:
    """Undo the stuffing by its definition and compare the checksum: nothing of the package is used."""
    data, at = bytearray(), 1
    while at < len(wire) - 1:
        data += wire[at + 1 : at + wire[at]] + b"\0"
        at += wire[at]
    return zlib.crc32(data[:-5]) == int.from_bytes(data[-5:-1], "little")


def check(stream: bytes, rng: random.Random) -> tuple[bytes, list[int]]:
    """Parse whole and in pieces; what comes out stands in the stream with a right checksum."""
    whole, in_pieces = FrameParser(keep_others=True), FrameParser(keep_others=True)
    frames = whole.feed(stream)
    if rng.random() < 0.25:
        assert [frame for piece in cut(stream, rng, 3) for frame in in_pieces.feed(piece)] == frames
        assert in_pieces.counts == whole.counts
    wires = [wire_of(frame) for frame in frames]
    for wire in wires:
        assert wire in stream
        assert has_right_checksum(wire)
    joined = b"".join(wires)
    return joined, python_counters(whole, joined)


checked: list[int] = []


# A smaller seed is no simpler example: what fails is shown as it was drawn.
@settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck), phases=[Phase.generate])
@given(seed=st.integers(0, 2**64 - 1), edits=st.integers(0, 6), garbage=st.floats(0, 0.5))
def check_many(library: ctypes.CDLL | None, seed: int, edits: int, garbage: float) -> None:
    rng = generator(seed)
    pool = [wire_of(random_frame(rng)) for _ in range(100)]
    pool += [encode_payload(odd_payload(rng)) for _ in range(30)]
    pool += [too_long(rng) for _ in range(3)]
    streams = [some_stream(rng, pool, edits, garbage) for _ in range(STREAMS)]
    answers = [check(stream, rng) for stream in streams]
    checked.append(len(streams))
    if library is not None:
        frames, counters = c_answers(library, streams)
        assert counters == [counter for _, counter in answers]
        assert frames == b"".join(wire for wire, _ in answers)


def test_100_000_streams(library: ctypes.CDLL | None) -> None:
    checked.clear()
    check_many(library)
    assert sum(checked) >= 100_000
