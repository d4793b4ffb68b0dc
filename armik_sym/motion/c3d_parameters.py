"""The parameter section of a c3d file."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError

BLOCK = 512
_SIZES = {-1: 1, 1: 1, 2: 2, 4: 4}
_MOST_DIMENSIONS = 7
_LONGEST_SECTION = 16_000_000


@dataclass(frozen=True)
class Parameter:
    """One parameter.

    Attributes:
        at: Byte of the file at which its values start.
        numbers: Its values, if they are numbers.
        texts: Its values, if they are texts, without the blanks at their ends.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """

    at: int
    numbers: tuple[float, ...] = ()
    texts: tuple[str, ...] = ()


def read_parameters(
    path: Path, file: BinaryIO, start: int, end: int, order: str, dec: bool
) -> dict[str, Parameter]:
    """Read the parameter section, never past its end.

    Args:
        path: The file, for messages.
        file: The open file.
        start: Byte at which the section starts.
        end: Byte at which the data start, or the file ends.
        order: Order of bytes, "<" or ">".
        dec: Whether floating-point numbers are those of DEC.

    Returns:
        The parameters by "GROUP:NAME", in capitals.

    Raises:
        MotionFileError: If a length field points out of the section; names the byte.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    file.seek(start)
    raw = file.read(min(end - start, _LONGEST_SECTION))
    walk = _Walk(path, raw, start, order, dec)
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Parameter]] = []
    position = 4
    while position + 2 <= len(raw) and raw[position] != 0:
        length, group = (
            abs(struct.unpack_from("b", raw, position)[0]),
            struct.unpack_from("b", raw, position + 1)[0],
        )
        name = walk.text(position + 2, length, "the name").upper()
        link = position + 2 + length
        step = struct.unpack(f"{order}H", walk.part(link, 2, "the offset to the next one"))[0]
        if group < 0:
            groups[-group] = name
            tail = link + 2
        elif group > 0:
            parameter, tail = walk.parameter(link + 2, name)
            found.append((group, name, parameter))
        else:
            raise walk.error(position + 1, f"the group of {name!r} is 0")
        about = f"the description of {name!r}"
        size = walk.part(tail, 1, about)[0]
        walk.text(tail + 1, size, about)
        tail += 1 + size
        if step and link + step < tail:
            raise walk.error(
                link, f"{name!r} ends at byte {start + tail}, the next one is said to start before it"
            )
        if not step:
            break
        position = link + step
        if position > len(raw):
            raise walk.error(link, f"the one after {name!r} is said to start at byte {start + position}")
    return {f"{groups.get(group, group)}:{name}": parameter for group, name, parameter in found}


class _Walk:
    """Bytes of the section, by position, with errors that name the byte of the file."""

    def __init__(self, path: Path, raw: bytes, start: int, order: str, dec: bool) -> None:
        self.path, self.raw, self.start, self.order, self.dec = path, raw, start, order, dec

    def error(self, position: int, said: str) -> MotionFileError:
        return MotionFileError(
            f"{self.path}: byte {self.start + position}: {said}: the parameters are damaged"
        )

    def part(self, position: int, count: int, what: str) -> bytes:
        if position + count > len(self.raw):
            end = self.start + len(self.raw)
            raise self.error(position, f"{what} takes {count} bytes, the section ends at byte {end}")
        return self.raw[position : position + count]

    def text(self, position: int, count: int, what: str) -> str:
        raw = self.part(position, count, what)
        try:
            return raw.decode("utf-8").strip(" \0")
        except UnicodeDecodeError:
            return raw.decode("latin-1").strip(" \0")

    def parameter(self, position: int, name: str) -> tuple[Parameter, int]:
        kind = struct.unpack("b", self.part(position, 1, f"the type of {name!r}"))[0]
        if kind not in _SIZES:
            raise self.error(position, f"the type of {name!r} is {kind}, expected -1, 1, 2 or 4")
        many = self.part(position + 1, 1, f"the number of dimensions of {name!r}")[0]
        if many > _MOST_DIMENSIONS:
            raise self.error(
                position + 1, f"{name!r} has {many} dimensions, at most {_MOST_DIMENSIONS} exist"
            )
        shape = tuple(self.part(position + 2, many, f"the dimensions of {name!r}"))
        at = position + 2 + many
        count = math.prod(shape)
        data = self.part(at, count * _SIZES[kind], f"{name!r} of shape {shape}")
        where = self.start + at
        if kind == -1:
            width = shape[0] if shape else 1
            places = range(at, at + len(data), width) if width else ()
            texts = tuple(self.text(place, width, name) for place in places)
            return Parameter(where, texts=texts), at + len(data)
        return Parameter(where, numbers=self.numbers(data, kind, count)), at + len(data)

    def numbers(self, data: bytes, kind: int, count: int) -> tuple[float, ...]:
        if kind == 4 and self.dec:
            return tuple(from_dec(np.frombuffer(data, dtype="<u2")).tolist())
        return struct.unpack(f"{self.order}{count}{ {1: 'B', 2: 'h', 4: 'f'}[kind] }", data)


def from_dec(words: NDArray[np.uint16]) -> NDArray[np.float64]:
    """Floating-point numbers of DEC machines: the halves swapped, the exponent larger by 2.

    Args:
        words: Words of 16 bits in the order of the file, last axis of even length 2·k.

    Returns:
        The numbers, last axis of length k.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    pairs = words.reshape(*words.shape[:-1], -1, 2)
    bits = pairs[..., 0].astype(np.uint32) << 16 | pairs[..., 1]
    return bits.view(np.float32).astype(np.float64) / 4.0
