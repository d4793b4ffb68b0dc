"""The C of the protocol: strict compilers, sanitizers, small processors; its bytes are those of Python."""

from __future__ import annotations

import ctypes
import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from compiled_helpers import CC, STRICT, needs_cc
from device_c import C_FOLDER, FRAME_C, WRAPPER, build
from device_streams import damaged, generator, odd_payload, random_frame, random_info, random_sample, wire_of

from armik_sym.device import DeviceInfo, FrameParser, Sample, encode_payload

_CXX = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
_ZIG = [sys.executable, "-m", "ziglang", "cc"] if importlib.util.find_spec("ziglang") else None


class CSample(ctypes.Structure):
    _fields_ = [
        ("sequence", ctypes.c_uint32),
        ("time_us", ctypes.c_uint32),
        ("channels", ctypes.c_uint8),
        ("index", ctypes.c_uint8),
        ("counts", ctypes.c_uint16 * 7),
        ("index_counts", ctypes.c_uint16 * 7),
    ]


class CInfo(ctypes.Structure):
    _fields_ = [
        ("device_id", ctypes.c_uint32),
        ("rate_hz", ctypes.c_uint16),
        ("channels", ctypes.c_uint8),
        ("kind", ctypes.c_uint8 * 7),
        ("span", ctypes.c_uint32 * 7),
        ("firmware", ctypes.c_char * 17),
    ]


def c_sample(sample: Sample) -> CSample:
    latched = iter(sample.index_counts)
    n = len(sample.counts)
    at_index = [next(latched) if sample.index >> k & 1 else 0 for k in range(n)]
    return CSample(
        sample.sequence, sample.time_us, n, sample.index, (ctypes.c_uint16 * 7)(*sample.counts),
        (ctypes.c_uint16 * 7)(*at_index),
    )  # fmt: skip


def c_info(info: DeviceInfo) -> CInfo:
    return CInfo(
        info.device_id,
        int(info.rate),
        len(info.channels),
        (ctypes.c_uint8 * 7)(*(channel.kind.value for channel in info.channels)),
        (ctypes.c_uint32 * 7)(*(channel.span for channel in info.channels)),
        info.firmware.encode(),
    )


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return build(tmp_path_factory.mktemp("frames"))


def fields(value: CSample | CInfo) -> list[object]:
    """Every field, unused places of its arrays too."""
    every = [getattr(value, name) for name, *_ in value._fields_]
    return [list(field) if isinstance(field, ctypes.Array) else field for field in every]


def encoded(library: ctypes.CDLL, value: CSample | CInfo) -> bytes:
    out = ctypes.create_string_buffer(71)
    encode = library.armik_encode_sample if isinstance(value, CSample) else library.armik_encode_info
    size = encode(ctypes.byref(value), out)
    return out.raw[:size]


def taken(library: ctypes.CDLL, wire: bytes, kind: type) -> CSample | CInfo:
    """What the C parser makes of one frame: the event comes with its last byte, not before."""
    parser, frame = ctypes.create_string_buffer(256), (ctypes.c_uint8 * 128)(*b"\xaa" * 128)
    library.armik_parser_start(parser)
    events = [library.armik_parser_take(parser, ctypes.c_uint8(byte), frame) for byte in wire]
    assert events == [0] * (len(wire) - 1) + [1 if kind is CSample else 2]
    return kind.from_buffer(frame)


@needs_cc
def test_fields_are_the_same_in_both_languages(library: ctypes.CDLL) -> None:
    rng = generator(0)
    for _ in range(500):
        for frame, value in (
            (sample := random_sample(rng), c_sample(sample)),
            (info := random_info(rng), c_info(info)),
        ):
            wire = wire_of(frame)
            assert encoded(library, value) == wire
            assert fields(taken(library, wire, type(value))) == fields(value)


@needs_cc
def test_what_does_not_fit_is_refused(library: ctypes.CDLL) -> None:
    good = c_sample(Sample(1, 2, (3, 4)))
    for field, value in (("channels", 0), ("channels", 8), ("index", 4), ("index", 128)):
        wrong = CSample.from_buffer_copy(good)
        setattr(wrong, field, value)
        assert encoded(library, wrong) == b"", field
    info = c_info(random_info(generator(1)))
    info.kind[0], info.span[0] = 0, 65536
    assert encoded(library, info)
    changes = {"rate_hz": 0, "channels": 8, "firmware": b"seventeen letters"}
    for field, value in {**changes, "kind": 2, "span": 65537}.items():
        wrong = CInfo.from_buffer_copy(info)
        if field in changes:
            setattr(wrong, field, value)
        else:
            getattr(wrong, field)[0] = value
        assert encoded(library, wrong) == b"", field
    for name in (b"\n", b"\x7f", b"\xc3"):
        wrong = CInfo.from_buffer_copy(info)
        wrong.firmware = name
        assert encoded(library, wrong) == b"", name
    assert library.armik_encode_payload(bytes(65), ctypes.c_size_t(65), ctypes.create_string_buffer(80)) == 0


@needs_cc
def test_check_value_of_the_checksum(library: ctypes.CDLL) -> None:
    library.armik_crc32.restype = ctypes.c_uint32
    assert library.armik_crc32(b"123456789", ctypes.c_size_t(9)) == 0xCBF43926


MAIN = """
#include <stdio.h>
#include <stdlib.h>
/* The whole input is one stream; every buffer is as small as it may be, on the heap, where tools watch it. */
int main(void) {
  armik_parser *parser = malloc(sizeof *parser);
  armik_frame *frame = malloc(sizeof *frame);
  int byte;
  if (!parser || !frame) return 2;
  armik_parser_start(parser);
  while ((byte = getchar()) != EOF) {
    uint8_t *out = malloc(ARMIK_LONGEST_WIRE);
    if (!out) return 2;
    fwrite(out, 1, written(armik_parser_take(parser, (uint8_t)byte, frame), frame, out), stdout);
    free(out);
  }
  free(frame);
  free(parser);
  return 0;
}
"""


def sanitizer(folder: Path) -> list[str]:
    """Flags of the strictest sanitizer that works here; a library for it may be missing."""
    file, program = folder / "empty.c", folder / "empty"
    file.write_text("int main(void) { return 0; }\n")
    for flags in (["-fsanitize=address,undefined"], ["-fsanitize=undefined", "-fsanitize-trap=undefined"]):
        command = [str(CC), *flags, "-fno-sanitize-recover=all", "-o", str(program), str(file)]
        if all(
            subprocess.run(step, capture_output=True, check=False).returncode == 0
            for step in (command, [str(program)])
        ):
            return command[1:-3]
    pytest.skip("no sanitizer works with this compiler")


@needs_cc
def test_sanitizers_find_nothing(tmp_path: Path) -> None:
    source, program = tmp_path / "main.c", tmp_path / "main"
    source.write_text(WRAPPER + MAIN)
    flags = [*STRICT, *sanitizer(tmp_path), "-O1", "-g", f"-I{C_FOLDER}"]
    built = subprocess.run(
        [str(CC), *flags, str(source), str(FRAME_C), "-o", str(program)], capture_output=True, text=True
    )
    assert built.returncode == 0, built.stderr
    rng = generator(2)
    sent = b"".join(wire_of(random_frame(rng)) for _ in range(3000))
    odd = b"".join(encode_payload(odd_payload(rng)) for _ in range(1000))
    stream = damaged(sent, rng, 1500) + odd + bytes(rng.choices(b"\0\1\2\3\xff", k=20_000)) + b"\1" * 300
    ran = subprocess.run([str(program)], input=stream, capture_output=True, timeout=120, check=False)
    assert ran.returncode == 0, ran.stderr.decode()
    assert ran.stdout == b"".join(wire_of(frame) for frame in FrameParser(keep_others=True).feed(stream))
    assert 0.3 * len(sent) < len(ran.stdout) < len(sent)


@pytest.mark.skipif(_CXX is None, reason="no C++ compiler")
def test_header_works_in_cpp(tmp_path: Path) -> None:
    source = tmp_path / "main.cpp"
    source.write_text('#include "armik_frame.h"\nint main() { armik_parser p; armik_parser_start(&p); }\n')
    flags = ["-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", f"-I{C_FOLDER}", "-c"]
    built = subprocess.run([str(_CXX), *flags, str(source), "-o", str(tmp_path / "o")], capture_output=True)
    assert built.returncode == 0, built.stderr.decode()


@pytest.mark.skipif(_ZIG is None, reason="the package ziglang is not installed")
@pytest.mark.parametrize(
    "target",
    [
        ["msp430-freestanding-none"],  # int has 16 bits
        ["thumb-freestanding-eabi", "-mcpu=cortex_m0"],
        ["x86_64-windows-gnu"],
    ],
    ids=lambda target: target[0],
)
def test_compiles_for_small_processors_without_a_library(tmp_path: Path, target: list[str]) -> None:
    flags = [*STRICT, "-Wsign-conversion", "-ffreestanding", "-Os", f"-I{C_FOLDER}", "-target", *target, "-c"]
    for file in (FRAME_C, C_FOLDER / "example" / "firmware.c"):
        built = subprocess.run(
            [*(_ZIG or ()), *flags, str(file), "-o", str(tmp_path / "o")], capture_output=True, text=True
        )
        assert built.returncode == 0, built.stderr


def test_no_heap_no_library() -> None:
    text = FRAME_C.read_text() + (C_FOLDER / "armik_frame.h").read_text()
    assert sorted(line for line in text.splitlines() if line.startswith("#include")) == [
        '#include "armik_frame.h"',
        "#include <stddef.h>",
        "#include <stdint.h>",
    ]
