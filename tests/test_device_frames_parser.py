"""The parser: any cut gives the same frames, damage costs the frames it hits, nothing wrong comes out."""

from __future__ import annotations

import dataclasses
import random
import tracemalloc

import pytest
from device_streams import cut, damaged, generator, odd_payload, random_frame, too_long, wire_of
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.device import FrameParser, OtherFrame, ParserCounts, Sample, encode_payload, encode_sample
from armik_sym.device.protocol.frames import Frame
from armik_sym.device.protocol.parser import LONGEST_CHUNK

SAMPLE = Sample(7, 2000, (1, 0, 3))
WIRE = encode_sample(SAMPLE)
RNG = st.randoms(use_true_random=False)


def in_order(fewer: list[Frame], more: list[Frame]) -> bool:
    """Whether the first list is the second with some left out."""
    rest = iter(more)
    return all(any(frame == other for other in rest) for frame in fewer)


def mixed_stream(rng: random.Random) -> bytes:
    """Frames, payloads that say something wrong, damage."""
    parts = [
        wire_of(random_frame(rng)) if rng.random() < 0.7 else encode_payload(odd_payload(rng))
        for _ in range(rng.randint(0, 6))
    ]
    return damaged(b"".join(parts), rng, rng.randint(0, 4))


@given(RNG)
def test_any_cut_of_the_stream_gives_the_same(rng: random.Random) -> None:
    stream = mixed_stream(rng)
    whole, in_pieces, in_bytes = (FrameParser(keep_others=True) for _ in range(3))
    frames = whole.feed(stream)
    assert [frame for piece in cut(stream, rng, 5) for frame in in_pieces.feed(piece)] == frames
    assert [frame for byte in stream for frame in in_bytes.feed(bytes([byte]))] == frames
    assert whole.counts == in_pieces.counts == in_bytes.counts
    assert whole.versions_seen == in_pieces.versions_seen == in_bytes.versions_seen
    assert whole.pending == in_pieces.pending == in_bytes.pending


@given(RNG)
def test_no_byte_goes_uncounted(rng: random.Random) -> None:
    stream = mixed_stream(rng)
    parser = FrameParser()
    parser.feed(stream)
    counts = parser.counts
    assert counts.bytes_read == len(stream)
    chunks = [chunk for chunk in stream.split(b"\0")[1:-1] if chunk]
    in_front = len(stream.split(b"\0", 1)[0])
    seen = counts.samples + counts.infos + counts.malformed + counts.unknown_version + counts.unknown_kind
    late = len(stream.rsplit(b"\0", 1)[-1]) > LONGEST_CHUNK and b"\0" in stream
    assert seen + counts.damaged == len(chunks) + late
    whole_bytes = sum(len(chunk) for chunk in chunks if not is_damaged(chunk))
    assert counts.bytes_dropped + parser.pending + stream.count(0) + whole_bytes == len(stream)
    assert counts.bytes_dropped >= in_front


def is_damaged(chunk: bytes) -> bool:
    parser = FrameParser()
    parser.feed(b"\0" + chunk + b"\0")
    return parser.counts.damaged == 1


@st.composite
def hit_streams(draw: st.DrawFn) -> tuple[bytes, list[Frame], list[Frame]]:
    """A stream that was hit, the frames sent, and those of which every byte is as it was."""
    rng = draw(RNG)
    sent = [random_frame(rng) for _ in range(draw(st.integers(1, 8)))]
    hits = draw(st.lists(st.tuples(st.integers(0, 7), st.sampled_from(["change", "lose", "insert"]))))
    between = draw(st.dictionaries(st.integers(0, 7), st.binary(max_size=80), max_size=3))
    stream, whole = bytearray(), []
    for at, frame in enumerate(sent):
        wire = bytearray(wire_of(frame))
        mine = [what for number, what in hits if number == at]
        for what in mine:
            place = rng.randrange(len(wire)) if wire else 0
            if what == "insert":
                wire[place:place] = rng.randbytes(rng.randint(1, 3))
            elif wire:
                wire[place : place + 1] = (
                    b"" if what == "lose" else bytes([wire[place] ^ rng.randint(1, 255)])
                )
        if not mine:
            whole.append(frame)
        stream += wire + between.get(at, b"")
    return bytes(stream), sent, whole


@given(hit_streams())
def test_every_frame_that_was_not_hit_comes_out_and_nothing_that_was_not_sent(
    case: tuple[bytes, list[Frame], list[Frame]],
) -> None:
    stream, sent, whole = case
    frames = FrameParser(keep_others=True).feed(stream)
    assert in_order(whole, frames)
    assert in_order(frames, sent)


def test_each_single_byte_changed_or_lost_costs_one_frame_at_most() -> None:
    sent = [Sample(k, 10 * k, (k, 0, 0xFF00)) for k in range(3)]
    stream = b"".join(encode_sample(sample) for sample in sent)
    size = len(stream) // 3
    for place in range(len(stream)):
        others = [sample for sample in sent if sample.sequence != place // size]
        lost = FrameParser().feed(stream[:place] + stream[place + 1 :])
        assert in_order(others, lost)
        for value in range(256):
            changed = bytearray(stream)
            changed[place] = value
            frames = FrameParser().feed(bytes(changed))
            assert in_order(others, frames)
            assert in_order(frames, sent)


def test_opened_in_the_middle_of_a_frame_counts_nothing_as_damaged() -> None:
    parser = FrameParser()
    assert parser.feed(WIRE[5:] + WIRE) == [SAMPLE]
    assert parser.counts == ParserCounts(samples=1, bytes_read=2 * len(WIRE) - 5, bytes_dropped=len(WIRE) - 6)


def test_what_is_counted_as_what() -> None:
    sealed = {
        "malformed": [b"", b"\1", bytes([1, 1]), bytes([1, 0]), bytes([1, 1, *bytes(8), 2, 4, *bytes(6)])],
        "unknown_version": [b"\2\1", b"\0\0rest"],
        "unknown_kind": [b"\1\2", b"\1\xffbody"],
    }
    parser = FrameParser(keep_others=True)
    frames = parser.feed(b"".join(encode_payload(payload) for many in sealed.values() for payload in many))
    assert frames == [OtherFrame(2, b""), OtherFrame(255, b"body")]
    for name, payloads in sealed.items():
        assert getattr(parser.counts, name) == len(payloads), name
    assert parser.counts.damaged == parser.counts.bytes_dropped == 0
    assert parser.versions_seen == {0, 1, 2}
    assert FrameParser().feed(encode_payload(b"\1\2")) == []


def test_every_byte_value_in_the_lengths_of_a_frame_is_refused_or_right() -> None:
    """No payload is half understood: whatever comes out says the same bytes when written again."""
    info = bytes([1, 0, 9, 0, 0, 0, 244, 1, 2, 0, 0, 16, 0, 0, 1, 160, 15, 0, 0, 3]) + b"abc"
    sample = bytes([1, 1, *range(8), 2, 2, 10, 11, 12, 13, 14, 15])
    for payload in (info, sample):
        for place in range(2, len(payload)):
            for value in range(256):
                wire = encode_payload(payload[:place] + bytes([value]) + payload[place + 1 :])
                parser = FrameParser()
                frames = parser.feed(wire)
                assert [wire_of(frame) for frame in frames] == [wire] * (1 - parser.counts.malformed)
        assert FrameParser().feed(encode_payload(payload)) != []


def test_memory_stays_bounded() -> None:
    parser = FrameParser()
    parser.feed(WIRE)
    noise = bytes(1 + k % 255 for k in range(1000))
    tracemalloc.start()
    try:
        for _ in range(1000):
            parser.feed(noise)
            assert parser.pending <= LONGEST_CHUNK
            parser.feed(noise[:3])
        held, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert held < 5000
    assert parser.counts.damaged == 1
    assert parser.counts.bytes_dropped == 1000 * 1003
    assert parser.feed(WIRE) == [SAMPLE]


def test_a_chunk_is_too_long_at_the_70th_byte() -> None:
    for size, damaged_now in ((LONGEST_CHUNK, 0), (LONGEST_CHUNK + 1, 1)):
        parser = FrameParser()
        parser.feed(b"\0" + b"\1" * size)
        assert (parser.counts.damaged, parser.pending) == (damaged_now, size * (1 - damaged_now))


def test_a_frame_that_is_right_but_too_long_is_damaged() -> None:
    for seed in range(20):
        wire = too_long(generator(seed))
        whole, in_bytes = FrameParser(keep_others=True), FrameParser(keep_others=True)
        assert whole.feed(wire) == [frame for byte in wire for frame in in_bytes.feed(bytes([byte]))] == []
        assert whole.counts == in_bytes.counts
        assert (whole.counts.damaged, whole.counts.bytes_dropped) == (1, len(wire) - 2)


def test_restart_forgets_half_a_frame() -> None:
    parser = FrameParser()
    parser.feed(WIRE[:9])
    parser.restart()
    assert (parser.pending, parser.counts.bytes_dropped) == (0, 8)
    assert parser.feed(WIRE[9:] + WIRE) == [SAMPLE]
    assert parser.counts.damaged == 0


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview])
def test_anything_that_holds_bytes_can_be_fed(kind: type) -> None:
    assert FrameParser().feed(kind(WIRE)) == [SAMPLE]


def test_frames_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        SAMPLE.sequence = 3  # type: ignore[misc]
