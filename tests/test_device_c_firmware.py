"""The firmware example, built for a computer: what it sends is what its sensors did."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from compiled_helpers import CC, STRICT, needs_cc

from armik_sym.device import Channel, DeviceInfo, FrameParser, Sample, SensorKind, write_firmware
from armik_sym.errors import OptionError

SECONDS = 5
PERIOD_US = 2000
TURN = 4000
START_US = 0xFFFFFFFF - 1_500_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Written out and built there, as its user would."""
    folder = write_firmware(tmp_path_factory.mktemp("firmware") / "new")
    files = sorted(str(file) for file in folder.glob("*.c"))
    flags = [*STRICT, "-Wsign-conversion", "-O1"]
    command = [str(CC), *flags, *files, "-o", str(folder / "board")]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    return folder


@pytest.fixture(scope="module")
def sent(folder: Path) -> tuple[list[Sample], list[DeviceInfo], FrameParser]:
    """Its frames of some seconds."""
    command = [str(folder / "board"), str(SECONDS), str(START_US)]
    ran = subprocess.run(command, capture_output=True, timeout=60, check=True)
    parser = FrameParser()
    frames = parser.feed(ran.stdout)
    samples = [frame for frame in frames if isinstance(frame, Sample)]
    return samples, [frame for frame in frames if isinstance(frame, DeviceInfo)], parser


def swing(elapsed_us: np.ndarray, height: int, period_us: int) -> np.ndarray:
    phase = elapsed_us % period_us
    return height * np.minimum(phase, period_us - phase) // (period_us // 2)


@needs_cc
def test_every_frame_is_whole_and_the_device_says_who_it_is(sent) -> None:
    samples, infos, parser = sent
    counts = parser.counts
    assert (counts.damaged, counts.malformed, counts.bytes_dropped, parser.pending) == (0, 0, 0, 0)
    potentiometer, encoder = Channel(SensorKind.POTENTIOMETER, 4096), Channel(SensorKind.ENCODER, TURN)
    wanted = DeviceInfo(2021, 500.0, (potentiometer,) * 3 + (encoder,) * 2, "example 1.0")
    assert infos == [wanted] * SECONDS  # at the start, then once a second
    assert len(samples) == SECONDS * 500
    assert [sample.sequence for sample in samples] == list(range(len(samples)))


@needs_cc
def test_time_passes_evenly_through_the_wrap_of_its_clock(sent) -> None:
    time = [sample.time_us for sample in sent[0]]
    steps = np.diff(time) % 2**32
    assert np.all(np.abs(steps - PERIOD_US) <= 20)
    assert abs(sum(steps.tolist()) - PERIOD_US * len(steps)) <= 20
    assert max(time) - min(time) > 2**31  # it did wrap


@needs_cc
def test_counts_are_those_of_its_sensors(sent) -> None:
    elapsed = np.array([(sample.time_us - START_US) % 2**32 for sample in sent[0]])
    counts = np.array([sample.counts for sample in sent[0]])
    for k in range(3):
        assert np.array_equal(counts[:, k], 300 + swing(elapsed, 3400, 2_000_000 + 700_000 * k))
    for k, period in ((3, 4_000_000), (4, 8_000_000)):
        assert np.array_equal(counts[:, k], (swing(elapsed, 140_000, period) - 2000) % 2**16)
    overflows = np.diff(counts[:, 3:].astype(int), axis=0) < -50_000
    assert overflows.any(axis=0).all()


@needs_cc
def test_index_pulses_come_once_a_turn_with_the_register_latched_there(sent) -> None:
    elapsed = np.array([(sample.time_us - START_US) % 2**32 for sample in sent[0]])
    for k, period in ((3, 4_000_000), (4, 8_000_000)):
        turns = np.concatenate([[-1], (swing(elapsed, 140_000, period) - 2000) // TURN])
        before, now = turns[:-1], turns[1:]
        flagged = np.array([sample.index >> k & 1 for sample in sent[0]], dtype=bool)
        assert np.array_equal(flagged, now != before)
        assert flagged.sum() >= 35
        latched = [
            sample.index_counts[k == 4 and sample.index >> 3 & 1]
            for sample in sent[0]
            if sample.index >> k & 1
        ]
        assert latched == (np.maximum(now, before)[flagged] * TURN % 2**16).tolist()
    assert all(sample.index < 1 << 5 and not sample.index & 7 for sample in sent[0])


@needs_cc
def test_switched_on_it_begins_with_its_info_and_sample_0_near_time_0(folder: Path) -> None:
    ran = subprocess.run([str(folder / "board"), "0.1"], capture_output=True, timeout=60, check=True)
    info, sample, *more = FrameParser().feed(ran.stdout)
    assert isinstance(info, DeviceInfo)
    assert isinstance(sample, Sample)
    assert (sample.sequence, len(more)) == (0, 49)
    assert 0 <= sample.time_us < PERIOD_US


SLOW_BOARD = """
#include <stdio.h>
#include "board.h"
#include "firmware.h"
const armik_info board_info = {.device_id = 1, .rate_hz = 1000, .channels = 1, .span = {4096}};
static uint32_t now = 0;
uint32_t board_micros(void) { return now; }
uint16_t board_adc(uint8_t channel) { return channel; }
uint16_t board_quadrature(uint8_t channel) { return channel; }
uint8_t board_index(uint8_t channel, uint16_t *latched) { *latched = 0; return channel; }
void board_write(uint8_t byte) { putchar(byte); }
int main(void) {
  firmware_start();
  for (int k = 0; k < 10; ++k) { firmware_step(); firmware_step(); now += k == 4 ? 7300 : 1000; }
  return 0;
}
"""


@needs_cc
def test_samples_there_was_no_time_for_keep_their_numbers(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "slow.c").write_text(SLOW_BOARD)
    files = [str(folder / "firmware.c"), str(folder / "armik_frame.c"), str(tmp_path / "slow.c")]
    command = [str(CC), *STRICT, f"-I{folder}", *files, "-o", str(tmp_path / "slow")]
    assert subprocess.run(command, check=False).returncode == 0
    ran = subprocess.run([str(tmp_path / "slow")], capture_output=True, timeout=60, check=True)
    samples = [frame for frame in FrameParser().feed(ran.stdout) if isinstance(frame, Sample)]
    assert [sample.sequence for sample in samples] == [0, 1, 2, 3, 4, 11, 12, 13, 14, 15]
    assert [sample.time_us for sample in samples][4:7] == [4000, 11300, 12300]


def test_files_are_written_again_but_changed_ones_are_kept(tmp_path: Path) -> None:
    folder = write_firmware(tmp_path / "a" / "b")
    assert write_firmware(str(folder)) == folder
    names = {"armik_frame.c", "armik_frame.h", "board.h", "board_host.c", "firmware.c", "firmware.h"}
    assert {file.name for file in folder.iterdir()} == names
    (folder / "firmware.c").write_text("/* mine */")
    (folder / "board.h").unlink()
    with pytest.raises(OptionError, match=r"firmware\.c was changed.*name another folder"):
        write_firmware(folder)
    assert not (folder / "board.h").exists()
    assert (folder / "firmware.c").read_text() == "/* mine */"


def test_a_folder_that_cannot_be_written_to_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OptionError, match="cannot write the firmware to"):
        write_firmware(tmp_path / "file" / "below")
