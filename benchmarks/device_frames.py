"""What a frame from the device costs to parse and to write: Python, and the C for microcontrollers here.

Run: python benchmarks/device_frames.py [--quick]

All candidates take turns in every round, on the same stream of samples with 7 channels, an info every
500; the table gives the median round. "1,000 Hz" is the part of one core that 1,000 frames a second take.
"""

from __future__ import annotations

import argparse
import ctypes
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from armik_sym.compiled.compiler import Compiler, find_compiler
from armik_sym.device import (
    Channel,
    DeviceInfo,
    FrameParser,
    Sample,
    SensorKind,
    encode_info,
    encode_sample,
    write_firmware,
)

CHUNK = 512  # bytes that come at once at 500,000 baud in some 10 ms
TIMER = """\
#include "armik_frame.h"
size_t parse_all(const uint8_t *data, size_t size);
size_t write_all(size_t n, uint8_t *out);
size_t parse_all(const uint8_t *data, size_t size) {
  armik_parser parser;
  armik_frame frame;
  size_t found = 0;
  armik_parser_start(&parser);
  for (size_t i = 0; i < size; ++i) found += armik_parser_take(&parser, data[i], &frame) == ARMIK_SAMPLE;
  return found;
}
size_t write_all(size_t n, uint8_t *out) {
  armik_sample sample = {0};
  size_t bytes = 0;
  sample.channels = 7;
  for (uint32_t i = 0; i < n; ++i) {
    sample.sequence = i;
    sample.time_us = 1000 * i;
    for (int k = 0; k < 7; ++k) sample.counts[k] = (uint16_t)(i * (unsigned)(k + 1));
    bytes += armik_encode_sample(&sample, out);
  }
  return bytes;
}
"""


def samples(n: int) -> list[Sample]:
    """Samples of seven sensors."""
    counts = np.random.default_rng(0).integers(4096, size=(n, 7)).tolist()
    return [Sample(k, 1000 * k, tuple(row)) for k, row in enumerate(counts)]


def stream_of(frames: list[Sample]) -> bytes:
    """Their bytes, with an info every 500."""
    info = encode_info(DeviceInfo(1, 1000, (Channel(SensorKind.POTENTIOMETER, 4096),) * 7, "benchmark"))
    return b"".join((info if k % 500 == 0 else b"") + encode_sample(s) for k, s in enumerate(frames))


def python_parser(stream: bytes, chunk: int) -> Callable[[], int]:
    """Feed the stream in chunks."""

    def run() -> int:
        parser = FrameParser()
        for start in range(0, len(stream), chunk):
            parser.feed(stream[start : start + chunk])
        return parser.counts.samples

    return run


def library(compiler: Compiler, folder: Path) -> ctypes.CDLL:
    """The C of the protocol with a loop around it."""
    write_firmware(folder)
    (folder / "timer.c").write_text(TIMER)
    files = [str(folder / "timer.c"), str(folder / "armik_frame.c")]
    subprocess.run(
        [*compiler.command, "-std=c99", "-O2", "-fPIC", "-shared", "-o", str(folder / "timer.so"), *files],
        check=True,
    )
    return ctypes.CDLL(str(folder / "timer.so"))


def candidates(frames: list[Sample], folder: Path) -> dict[str, Callable[[], object]]:
    """What is measured, by name; each handles all frames once."""
    stream = stream_of(frames)
    found: dict[str, Callable[[], object]] = {
        f"parse, Python, {CHUNK} bytes at once": python_parser(stream, CHUNK),
        "parse, Python, frame by frame": python_parser(stream, len(encode_sample(frames[0]))),
        "write, Python": lambda: [encode_sample(sample) for sample in frames],
    }
    compiler = find_compiler()
    if compiler is None:
        print("no C compiler found: Python alone")
        return found
    c, size, out = library(compiler, folder), ctypes.c_size_t(len(stream)), ctypes.create_string_buffer(80)
    if c.parse_all(stream, size) != len(frames):
        raise SystemExit("the C parser does not find all samples")
    return {
        "parse, C, byte by byte": lambda: c.parse_all(stream, size),
        "write, C": lambda: c.write_all(ctypes.c_size_t(len(frames)), out),
        **found,
    }


def measure(run: Callable[[], object]) -> float:
    """Seconds of one call."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer frames and rounds")
    quick = parser.parse_args().quick
    n, rounds = (2_000, 5) if quick else (20_000, 15)
    with tempfile.TemporaryDirectory() as folder:
        runs = candidates(samples(n), Path(folder))
        times: dict[str, list[float]] = {name: [] for name in runs}
        for _ in range(rounds):
            for name, run in runs.items():
                times[name].append(measure(run) / n)
    print(f"{n} samples of 7 channels, {rounds} rounds\n")
    print(f"{'':34}{'per frame':>12}{'over C':>9}{'1,000 Hz':>10}")
    for name, seconds in times.items():
        rival = times.get("parse, C, byte by byte" if name.startswith("parse") else "write, C", seconds)
        ratio = statistics.median(a / b for a, b in zip(seconds, rival, strict=True))
        middle = statistics.median(seconds)
        print(f"{name:34}{1e6 * middle:9.3f} us{ratio:9.1f}{1e5 * middle:9.3f}%")


if __name__ == "__main__":
    main()
