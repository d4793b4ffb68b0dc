"""docs/device_protocol.md says what the code does: vectors, tables, sender, promises of the checksum."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from device_streams import generator, random_info, random_sample

from armik_sym.device import (
    Channel,
    DeviceInfo,
    FrameParser,
    ParserCounts,
    Sample,
    SensorKind,
    encode_info,
    encode_sample,
)
from armik_sym.device.protocol.frames import Frame

PAGE = Path(__file__).resolve().parent.parent / "docs" / "device_protocol.md"
TEXT = PAGE.read_text(encoding="utf-8")
DAMAGE = [name for name in ParserCounts.__slots__ if not name.startswith("bytes")]


def block(language: str) -> str:
    (text,) = re.findall(rf"^```{language}\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    return text


def numbers(text: str) -> tuple[int, ...]:
    return tuple(int(number) for number in text.split(",")) if text else ()


def vectors() -> Iterator[tuple[Frame, bytes]]:
    """What the page says is sent, and the bytes it says."""
    for paragraph in block("vectors").strip().split("\n\n"):
        first, _, wire = paragraph.partition("\n")
        field = dict(re.findall(r"(\w+)=(.*?)(?= \w+=|$)", first))
        frame: Frame
        if first.startswith("sample "):
            frame = Sample(
                int(field["sequence"]),
                int(field["time"]),
                numbers(field["counts"]),
                int(field.get("index", "0")),
                numbers(field.get("index_counts", "")),
            )
        else:
            pairs = [pair.split(":") for pair in field["channels"].split(",")]
            channels = tuple(Channel(SensorKind(int(kind)), int(span)) for kind, span in pairs)
            frame = DeviceInfo(int(field["device_id"]), float(field["rate"]), channels, field["firmware"])
        yield frame, bytes.fromhex(wire)


def sender() -> dict[str, object]:
    """The functions of the sender on the page."""
    names: dict[str, object] = {}
    exec(compile(block("python"), PAGE.name, "exec"), names)  # noqa: S102 - the page is ours
    return names


def sent(names: dict[str, object], frame: Sample | DeviceInfo) -> bytes:
    if isinstance(frame, Sample):
        return names["sample"](frame.sequence, frame.time_us, frame.counts, frame.index, frame.index_counts)
    channels = [(channel.kind.value, channel.span) for channel in frame.channels]
    return names["info"](frame.device_id, int(frame.rate), channels, frame.firmware)


def test_vectors() -> None:
    names, found = sender(), list(vectors())
    assert len(found) == 5
    for frame, wire in found:
        assert (encode_sample if isinstance(frame, Sample) else encode_info)(frame) == wire
        assert FrameParser().feed(wire) == [frame]
        assert sent(names, frame) == wire


def test_the_sender_on_the_page_sends_what_ours_sends() -> None:
    rng, names = generator(3), sender()
    for _ in range(300):
        for frame in (random_sample(rng), random_info(rng)):
            assert FrameParser().feed(sent(names, frame)) == [frame]


@pytest.mark.parametrize("line", block("refused").splitlines())
def test_refused_frames_are_counted_as_the_page_says(line: str) -> None:
    counter, _, wire = line.partition(" ")
    parser = FrameParser()
    assert parser.feed(bytes.fromhex(wire)) == []
    assert {name: getattr(parser.counts, name) for name in DAMAGE} == {
        name: int(name == counter) for name in DAMAGE
    }


def test_every_counter_is_on_the_page() -> None:
    assert all(f"`{name}`" in TEXT for name in DAMAGE)


def cells(line: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", line)]


def test_bandwidths() -> None:
    rows = [cells(line) for line in TEXT.splitlines() if re.match(r"\| \d+ \| \d+ \(\d+\)", line)]
    assert [row[0] for row in rows] == [5, 7]
    for n, *found in rows:
        plain = len(encode_sample(Sample(0, 0, (1,) * n)))
        flagged = len(encode_sample(Sample(0, 0, (1,) * n, (1 << n) - 1, (1,) * n)))
        info = len(encode_info(DeviceInfo(1, 1, (Channel(SensorKind.ENCODER, 8),) * n, "x" * 16)))
        bytes_left = [baud // 10 - info for baud in (115_200, 500_000, 1_000_000)]
        fit = [left // size for left in bytes_left for size in (plain, flagged)]
        assert found == [plain, flagged, info, *fit]
        assert plain == 19 + 2 * n


def test_checksum_finds_four_wrong_bits_anywhere_and_bursts_of_32() -> None:
    """Wrong bits pass if the XOR of what each does to the checksum is 0: no four of them, or fewer, do."""
    size = 8 * (64 + 4)
    zero = zlib.crc32(bytes(64))
    effects = []
    for bit in range(8 * 64):
        payload = bytearray(64)
        payload[bit // 8] = 1 << bit % 8
        effects.append(zlib.crc32(bytes(payload)) ^ zero)
    effect = np.array(effects + [1 << bit for bit in range(32)], dtype=np.uint64)
    first, second = np.triu_indices(size, 1)
    pairs = effect[first] ^ effect[second]
    assert len(np.unique(effect)) == size
    assert len(np.unique(pairs)) == len(pairs)  # two different pairs: four bits, or two that share one
    assert not np.intersect1d(pairs, effect).size  # three bits
    for at in range(size - 31):  # bursts: the effects of 32 neighbours are linearly independent
        assert rank(effect[at : at + 32].tolist()) == 32


def rank(words: list[int]) -> int:
    """Rank over the field of two elements."""
    basis: list[int] = []
    for word in words:
        for other in basis:
            word = min(word, word ^ other)
        if word:
            basis.append(word)
    return len(basis)
