"""The C of the protocol as a library, and its answers to streams as Python's parser would give them."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from importlib import resources
from pathlib import Path

import numpy as np
from compiled_helpers import build_strictly

from armik_sym.device import FrameParser, ParserCounts

C_FOLDER = Path(str(resources.files("armik_sym.device.protocol"))) / "c"
FRAME_C = C_FOLDER / "armik_frame.c"
COUNTERS = list(ParserCounts.__slots__)

WRAPPER = """\
#include "armik_frame.h"
#include <string.h>
size_t run_stream(const uint8_t *data, size_t size, uint8_t *out, uint32_t *counts);
size_t run_streams(const uint8_t *data, const int64_t *sizes, int64_t n, uint8_t *out, uint32_t *counts);

static size_t written(armik_event event, const armik_frame *frame, uint8_t *out) {
  uint8_t payload[ARMIK_LONGEST_PAYLOAD];
  if (event == ARMIK_SAMPLE) return armik_encode_sample(&frame->sample, out);
  if (event == ARMIK_INFO) return armik_encode_info(&frame->info, out);
  if (event != ARMIK_OTHER) return 0;
  payload[0] = ARMIK_VERSION;
  payload[1] = frame->other.kind;
  memcpy(payload + 2, frame->other.body, frame->other.size);
  return armik_encode_payload(payload, 2u + frame->other.size, out);
}

size_t run_stream(const uint8_t *data, size_t size, uint8_t *out, uint32_t *counts) {
  armik_parser parser;
  armik_frame frame;
  size_t used = 0;
  armik_parser_start(&parser);
  for (size_t i = 0; i < size; ++i) {
    const armik_event event = armik_parser_take(&parser, data[i], &frame);
    used += written(event, &frame, out + used);
  }
  memcpy(counts, &parser.counts, sizeof parser.counts);
  counts[8] = parser.length;
  counts[9] = (uint32_t)used;
  return used;
}

size_t run_streams(const uint8_t *data, const int64_t *sizes, int64_t n, uint8_t *out, uint32_t *counts) {
  size_t used = 0;
  for (int64_t i = 0; i < n; data += sizes[i++], counts += 10)
    used += run_stream(data, (size_t)sizes[i], out + used, counts);
  return used;
}
"""


def build(folder: Path, *flags: str) -> ctypes.CDLL:
    """Compile the frame code with the wrapper, every warning an error."""
    return build_strictly(WRAPPER, folder, "-Wsign-conversion", f"-I{C_FOLDER}", str(FRAME_C), *flags)


def c_answers(library: ctypes.CDLL, streams: Sequence[bytes]) -> tuple[bytes, list[list[int]]]:
    """All frames the C parser found, written by the C encoder, and per stream its counters."""
    data, sizes = b"".join(streams), np.array([len(stream) for stream in streams], dtype=np.int64)
    out, counts = ctypes.create_string_buffer(len(data) + 128), np.zeros((len(streams), 10), dtype=np.uint32)
    library.run_streams.restype = ctypes.c_size_t
    used = library.run_streams(
        data,
        sizes.ctypes.data_as(ctypes.c_void_p),
        ctypes.c_int64(len(streams)),
        out,
        counts.ctypes.data_as(ctypes.c_void_p),
    )
    return out.raw[:used], counts.tolist()


def python_counters(parser: FrameParser, wire: bytes) -> list[int]:
    """The same counters of a Python parser that found these frames."""
    return [*(getattr(parser.counts, name) for name in COUNTERS), parser.pending, len(wire)]
