"""Random frames, and byte streams with frames, damage and garbage in them, for the tests of the protocol."""

from __future__ import annotations

import random

from armik_sym.device import (
    Channel,
    DeviceInfo,
    OtherFrame,
    Sample,
    SensorKind,
    encode_info,
    encode_payload,
    encode_sample,
)
from armik_sym.device.protocol import checksum, cobs
from armik_sym.device.protocol.frames import Frame

_WORDS = (0, 1, 0xFF, 0x100, 0xFFFF)
_LONG_WORDS = (0, 1, 0xFFFFFFFF, 0x80000000, 0x100)


def generator(seed: int) -> random.Random:
    """Random numbers, the same for the same seed; `randbytes` makes these a better choice than NumPy's."""
    return random.Random(seed)  # noqa: S311 - nothing here is secret


def wire_of(frame: Frame) -> bytes:
    """The bytes of any frame."""
    if isinstance(frame, Sample):
        return encode_sample(frame)
    if isinstance(frame, DeviceInfo):
        return encode_info(frame)
    return encode_payload(bytes([1, frame.kind]) + frame.body)


def random_sample(rng: random.Random) -> Sample:
    """Any sample, corner values often."""
    n = rng.randint(1, 7)
    index = rng.randrange(1 << n) if rng.random() < 0.5 else 0

    def counts(size: int) -> tuple[int, ...]:
        return tuple(rng.choice((*_WORDS, rng.randrange(1 << 16))) for _ in range(size))

    long = [rng.choice((*_LONG_WORDS, rng.randrange(1 << 32))) for _ in range(2)]
    return Sample(long[0], long[1], counts(n), index, counts(index.bit_count()))


def random_info(rng: random.Random) -> DeviceInfo:
    """Any device."""

    def channel() -> Channel:
        kind = rng.choice(list(SensorKind))
        most = 0x10000 if kind is SensorKind.POTENTIOMETER else 0xFFFFFFFF
        return Channel(kind, rng.choice((2, most, rng.randint(2, most))))

    name = "".join(chr(rng.randint(0x20, 0x7E)) for _ in range(rng.randint(0, 16)))
    channels = tuple(channel() for _ in range(rng.randint(1, 7)))
    return DeviceInfo(rng.randrange(1 << 32), rng.randint(1, 0xFFFF), channels, name)


def random_other(rng: random.Random) -> OtherFrame:
    """Any frame of a kind that devices do not send."""
    return OtherFrame(rng.randint(2, 255), rng.randbytes(rng.randint(0, 62)))


def random_frame(rng: random.Random) -> Frame:
    """Any frame the parser hands out."""
    return rng.choices((random_sample, random_info, random_other), (6, 2, 2))[0](rng)


def odd_payload(rng: random.Random) -> bytes:
    """A payload that gets a right checksum, and says something wrong or nothing this version knows."""
    if rng.random() < 0.3:
        return oversized_payload(rng)
    payload = bytearray(rng.choice((rng.randbytes(rng.randint(0, 64)), _payload(random_frame(rng)))))
    for _ in range(rng.randint(1, 2)):
        place = rng.randrange(len(payload)) if payload else 0
        if rng.random() < 0.3:
            payload[:2] = bytes((rng.choice((0, 1, 1, 1, 2, 255)), rng.choice((0, 1, 2))))[: len(payload)]
        elif rng.random() < 0.5:
            payload[place : place + 1] = bytes((rng.choice((0, 1, 7, 8, 16, 17, 127, 255)),))
        else:
            del payload[place:]
    return bytes(payload[:64])


def oversized_payload(rng: random.Random) -> bytes:
    """A sample or info with more channels or letters than there may be; its lengths agree with each other."""
    if rng.random() < 0.3:
        n = rng.choice((0, 8, 9, 20, 26))
        return bytes([1, 1, *rng.randbytes(8), n, 0]) + rng.randbytes(2 * n)
    n = rng.choice((0, 1, 2, 7, 8, 9, 10))
    name = rng.randint(0 if n > 7 else 17, 54 - 5 * n)
    channels = b"".join(bytes([rng.randint(0, 1), 0, 1, 0, 0]) for _ in range(n))
    return bytes([1, 0, *b"\1\0\0\0\1\0", n]) + channels + bytes([name]) + b"x" * name


def too_long(rng: random.Random) -> bytes:
    """The bytes of a frame that is right but for its length."""
    return b"\0" + cobs.encode(checksum.seal(b"\1" + rng.randbytes(rng.choice((64, 65, 90))))) + b"\0"


def _payload(frame: Frame) -> bytes:
    chunk = wire_of(frame)[1:-1]
    data = bytearray(chunk)
    place = 0
    while place < len(chunk):
        data[place] = 0
        place += chunk[place]
    return bytes(data[1:-4])


def damaged(stream: bytes, rng: random.Random, edits: int) -> bytes:
    """The stream with bytes changed, lost, inserted, or garbage put in."""
    data = bytearray(stream)
    for _ in range(edits):
        place = rng.randrange(len(data) + 1)
        what = rng.randrange(4)
        if what == 0:
            data[place : place + 1] = bytes((rng.randrange(256),))
        elif what == 1:
            del data[place : place + rng.choice((1, 1, 3, 40))]
        elif what == 2:
            data[place:place] = rng.randbytes(rng.choice((1, 2, 5, 90)))
        else:
            data[place:place] = bytes(rng.choice((0, 1, 2, 3)) for _ in range(rng.randint(1, 9)))
    return bytes(data)


def cut(stream: bytes, rng: random.Random, cuts: int) -> list[bytes]:
    """The stream in pieces."""
    places = sorted(rng.randrange(len(stream) + 1) for _ in range(cuts))
    return [stream[a:b] for a, b in zip([0, *places], [*places, len(stream)], strict=True)]
