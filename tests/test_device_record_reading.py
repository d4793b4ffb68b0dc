"""Recordings come back, torn, damaged or foreign; and files that are none are refused."""

from __future__ import annotations

import itertools
from datetime import datetime, timezone
from pathlib import Path

import numpy as np
import pytest
from device_recorders import simulated
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import armik_sym as ak
from armik_sym.device.calibration import calibration_text
from armik_sym.device.channels import SensorKind
from armik_sym.device.protocol import encode_info, encode_payload
from armik_sym.device.recording import GapReason, WarningKind, read_recording
from armik_sym.device.recording.host_frames import (
    EndMark,
    GapMark,
    Header,
    Stamp,
    Topic,
    WarningMark,
    encode_host,
    encode_text,
)
from armik_sym.device.simulator import true_calibration
from armik_sym.errors import CalibrationError, CalibrationWarning, MotionFileError

SECOND = 1_000_000_000
NOON = int(datetime(2026, 5, 4, 12, tzinfo=timezone.utc).timestamp()) * SECOND
HEADER = encode_host(Header(1, NOON, 0)) + encode_text(Topic.PORT, "COM3")


def frames(n: int, **options: object) -> list[bytes]:
    """The first frames of a device: an info frame, and samples."""
    return [each.data for each in itertools.islice(simulated(**options).frames(), n)]


def file_of(folder: Path, *parts: bytes) -> Path:
    file = folder / "a.armikrec"
    file.write_bytes(b"".join(parts))
    return file


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, 400), size=st.integers(1, 400))
def test_a_torn_file_keeps_every_whole_frame(tmp_path: Path, cut: int, size: int) -> None:
    parts = frames(12)
    body = b"".join(parts)
    cut = min(cut, len(body))
    recording = read_recording(file_of(tmp_path, HEADER, body[:cut]))
    # The last delimiter of a frame can be missing.
    ends = [end - 1 for end in itertools.accumulate(map(len, parts))]
    samples = sum(end <= cut for end in ends[1:])
    assert recording.n == samples
    assert recording.damaged == 0
    assert recording.torn == (
        cut > 0 and cut not in ends and cut - 1 not in ends and cut not in _starts(parts)
    )
    assert not recording.complete


def _starts(parts: list[bytes]) -> set[int]:
    """Where a frame, or its first delimiter, has just begun."""
    ends = [0, *itertools.accumulate(map(len, parts))]
    return {end + k for end in ends for k in (0, 1)}


@settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=300), at=st.integers(0, 11))
def test_garbage_anywhere_costs_what_it_hits(tmp_path: Path, data: bytes, at: int) -> None:
    parts = frames(12)
    recording = read_recording(file_of(tmp_path, HEADER, *parts[:at], data, *parts[at:]))
    assert recording.n == 11
    assert recording.lost == 0


def test_foreign_bytes_are_refused_and_captures_are_read(tmp_path: Path) -> None:
    with pytest.raises(MotionFileError, match="no such file"):
        read_recording(tmp_path / "nowhere.armikrec")
    with pytest.raises(MotionFileError, match="is empty"):
        read_recording(file_of(tmp_path))
    with pytest.raises(MotionFileError, match="is no recording of a device"):
        read_recording(file_of(tmp_path, b"time [s],elbow [deg]\n0,1\n" * 30))
    with pytest.raises(MotionFileError, match="protocol version 9 only"):
        read_recording(file_of(tmp_path, encode_payload(bytes([9, 1, 2]))))
    capture = read_recording(file_of(tmp_path, *frames(5)))
    assert (capture.n, capture.port, capture.start) == (4, None, None)
    only_header = read_recording(file_of(tmp_path, HEADER))
    assert (only_header.n, only_header.port, only_header.duration) == (0, "COM3", 0.0)


def test_marks_come_back(tmp_path: Path) -> None:
    parts = frames(6)
    warning = encode_host(WarningMark(WarningKind.JUMP.value, 2, 3, 4, 17.0))
    stamp = encode_host(Stamp(NOON + 5 * SECOND, 5 * SECOND))
    end = encode_host(EndMark(0, NOON, 0, 5, 0, 0))
    later = encode_payload(bytes([1, 200, 7]))
    recording = read_recording(file_of(tmp_path, HEADER, *parts, warning, stamp, later, end))
    (found,) = recording.warnings
    assert (found.kind, found.channel, found.sequence, found.times, found.value) == (
        WarningKind.JUMP, 2, 3, 4, 17.0,
    )  # fmt: skip
    assert recording.complete
    assert recording.start is not None
    # The stamp is behind the fifth sample, measured 8 ms after the first.
    assert (recording.start - datetime(2026, 5, 4, 12, 0, 5, tzinfo=timezone.utc)).total_seconds() == (
        pytest.approx(-0.008, abs=1e-5)
    )


def test_a_restart_is_placed_by_the_clock_of_the_host(tmp_path: Path) -> None:
    first, again = frames(101, first_sequence=5000, first_time_us=10_000_000), frames(101)
    recording = read_recording(
        file_of(
            tmp_path,
            HEADER,
            *first,
            encode_host(Stamp(NOON, 20 * SECOND)),
            encode_host(GapMark(GapReason.PORT_LOST.value, NOON, 20 * SECOND)),
            encode_host(GapMark(GapReason.BACK.value, NOON, 25 * SECOND)),
            *again,
            encode_host(Stamp(NOON, round(25.198 * SECOND))),
        )
    )
    assert (recording.n, recording.lost, recording.restarts) == (200, 0, (100,))
    (gap,) = recording.gaps
    assert (gap.sample, gap.seconds, gap.reason) == (100, 5.0, GapReason.PORT_LOST)
    assert recording.sequence.tolist() == list(range(200))
    np.testing.assert_allclose(recording.time[:100], np.arange(100) / 500, atol=1e-9)
    # Stamped 0.198 s after the sample in front of it at device time 0.198 s.
    np.testing.assert_allclose(recording.time[100:], 5.198 + np.arange(100) / 500, atol=1e-9)
    calibration = true_calibration(simulated(first_sequence=5000))
    with pytest.warns(CalibrationWarning, match="restarted at sample 100: its encoders lost their zero"):
        q, names = recording.joint_angles(calibration)
    encoders = [joint.kind is SensorKind.ENCODER for joint in calibration.joints]
    assert names == calibration.joint_names
    assert np.isfinite(q[:100]).all()
    assert np.isnan(q[100:, encoders]).all()
    assert np.isfinite(q[100:, np.logical_not(encoders)]).all()
    left_out = pytest.warns(CalibrationWarning, match="100 of 200 samples left out")
    with left_out, pytest.warns(CalibrationWarning, match="restarted"):
        assert recording.angles(calibration).n == 100


def test_angles_and_files(tmp_path: Path) -> None:
    device = simulated()
    calibration = true_calibration(device, ak.catalog.ehmcs())
    text = encode_text(Topic.CALIBRATION, calibration_text(calibration))
    recording = read_recording(file_of(tmp_path, HEADER, text, *frames(300)))
    assert recording.calibration == calibration
    motion = recording.angles()
    for ending in (".csv", ".mot"):
        again = ak.read_motion(recording.save(tmp_path / f"angles{ending}"))
        assert again.joint_names == device.joint_names
        np.testing.assert_allclose(again.q, motion.q, atol=1e-9)
    bare = read_recording(file_of(tmp_path, HEADER, *frames(300)))
    with pytest.raises(CalibrationError, match="holds no calibration: give the one of this device"):
        bare.angles()
    np.testing.assert_array_equal(bare.angles(calibration).q, motion.q)
    torn = read_recording(file_of(tmp_path, HEADER, text[:-200], *frames(300)))
    assert torn.calibration is None
    assert "299 samples" in repr(bare)


def test_a_device_that_sent_no_sample_has_its_channels_all_the_same(tmp_path: Path) -> None:
    device, file = simulated(), tmp_path / "a.armikrec"
    file.write_bytes(encode_info(device.info))
    recording = read_recording(file)
    assert recording.counts.shape == recording.at_index.shape == (0, 7)
    angles, names = recording.joint_angles(true_calibration(device, ak.catalog.ehmcs()))
    assert (angles.shape, len(names)) == ((0, 7), 7)
