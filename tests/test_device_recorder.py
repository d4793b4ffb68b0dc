"""Recording over real serial paths: nothing that came through whole is lost."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from device_recorders import SERVERS, recorded, sequences, simulated

import armik_sym as ak
from armik_sym.device.recording import GapReason, WarningKind, read_recording
from armik_sym.device.simulator import Faults, Jump, Silence, true_calibration


@pytest.mark.parametrize("serve", SERVERS)
def test_no_frame_is_lost_at_500_per_second(serve: Any, tmp_path: Path) -> None:
    device, file = simulated(), tmp_path / "a.armikrec"
    calibration = true_calibration(device, ak.catalog.ehmcs())
    with serve(device, seconds=2.0) as served:
        _, summary = recorded(served, file, calibration=calibration)
        sent = served.truth.sent
    assert len(sent) == 1000
    recording = read_recording(file)
    assert np.array_equal(recording.sequence, sent)
    assert (recording.lost, recording.damaged, recording.gaps) == (0, 0, ())
    assert (summary.status.samples, summary.status.lost, summary.status.damaged) == (1000, 0, 0)
    assert recording.complete
    assert not recording.torn
    assert recording.info == device.info
    assert recording.port == served.port
    np.testing.assert_allclose(recording.time, np.arange(1000) / 500, atol=1e-12)
    motion = recording.angles()
    assert motion.joint_names == device.joint_names
    # Half a count of potentiometers is 0.04°, their noise 0.5 counts; encoders give 0.09° a count.
    assert np.abs(motion.q - device.true_angles(recording.sequence)).max() < np.radians(0.4)


@pytest.mark.parametrize("serve", SERVERS)
def test_damage_and_a_port_closed_twice_cost_nothing_but_what_they_hit(serve: Any, tmp_path: Path) -> None:
    faults = Faults(damaged_bytes=0.01, close_at=(0.6, 1.4), closed_for=0.4)
    device, file = simulated(faults), tmp_path / "a.armikrec"
    with serve(device, seconds=2.2) as served:
        recorder, summary = recorded(served, file)
        truth = served.truth
        undamaged, damaged = truth.undamaged, truth.damaged
    kept = sequences(file)
    assert kept == sorted(set(kept))
    assert set(undamaged.tolist()) <= set(kept)
    # A frame that lost only its last delimiter to the end of the line is whole all the same.
    assert set(kept) - set(undamaged.tolist()) <= set(damaged.tolist())
    recording = read_recording(file)
    first = kept[0]
    assert (recording.sequence + first).tolist() == kept
    assert recording.lost == kept[-1] - first + 1 - len(kept)
    # A damaged byte that becomes a zero makes two pieces of one frame; info frames are damaged, too.
    assert 0.95 * len(damaged) <= recording.damaged <= 1.2 * len(damaged) + 10
    assert [gap.reason for gap in recording.gaps] == [GapReason.PORT_LOST] * 2
    assert all(0.3 < gap.seconds < 3.0 and gap.lost >= 0.3 * device.rate for gap in recording.gaps)
    assert recording.restarts == ()
    status = summary.status
    assert (status.samples, status.lost, status.damaged, status.gaps) == (
        recording.n, recording.lost, recording.damaged, 2,
    )  # fmt: skip
    np.testing.assert_allclose(recording.time, recording.sequence / device.rate, atol=1e-9)
    assert sum("lost" in notice for notice in summary.notices) == 2
    assert not recorder.status().connected


def test_silence_within_a_frame_is_a_gap_and_costs_no_frame(tmp_path: Path) -> None:
    device, file = simulated(Faults(silent=(Silence(0.5, 2.0),))), tmp_path / "a.armikrec"
    with SERVERS[1].values[0](device, seconds=2.5) as served:
        _, summary = recorded(served, file)
        undamaged = served.truth.undamaged
    recording = read_recording(file)
    assert sequences(file) == undamaged.tolist()
    (gap,) = recording.gaps
    assert gap.reason is GapReason.SILENCE
    assert gap.seconds == pytest.approx(1.5, abs=0.4)
    assert gap.lost == recording.lost == 750
    assert recording.time[-1] == pytest.approx(2.498)
    assert "no byte" in summary.notices[0]


def test_jumps_are_marked_and_kept(tmp_path: Path) -> None:
    device, file = simulated(Faults(jumps=(Jump(0, 0.5, 400),))), tmp_path / "a.armikrec"
    with SERVERS[1].values[0](device, seconds=1.0) as served:
        _, summary = recorded(served, file)
    recording = read_recording(file)
    assert recording.n == 500
    found = [each for each in recording.warnings if each.kind is WarningKind.JUMP]
    assert [(each.channel, each.sequence) for each in found] == [(0, 250)]
    assert abs(found[0].value) == pytest.approx(400, abs=10)
    assert summary.status.warnings == len(recording.warnings)
    assert any("channel 0 jumped" in notice for notice in summary.notices)


def test_a_device_whose_counters_wrap_loses_nothing(tmp_path: Path) -> None:
    device = simulated(first_sequence=2**32 - 300, first_time_us=2**32 - 400_000)
    file = tmp_path / "a.armikrec"
    with SERVERS[1].values[0](device, seconds=1.2) as served:
        recorded(served, file)
    recording = read_recording(file)
    assert (recording.n, recording.lost, recording.restarts) == (600, 0, ())
    assert np.array_equal(recording.sequence, np.arange(600))
    np.testing.assert_allclose(recording.time, np.arange(600) / 500, atol=1e-9)
