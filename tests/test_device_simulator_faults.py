"""Faults of bytes and sensors, and the truth about them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated_devices import BRUSHING, SEVEN, counts_of, device, first_samples

import armik_sym as ak
from armik_sym.device.protocol import FrameParser, Sample, encode_sample
from armik_sym.device.simulator import Fate, Faults, Jump, Silence, SimulatedDevice, Stuck, Truth, sensors_of
from armik_sym.device.simulator.versions import with_version
from armik_sym.errors import OptionError, ProtocolError


def parsed(data: bytes) -> tuple[list[Sample], FrameParser]:
    parser = FrameParser()
    return [frame for frame in parser.feed(data) if isinstance(frame, Sample)], parser


def test_without_faults_every_frame_arrives_and_an_info_comes_every_second() -> None:
    simulated = device(rate=200)
    frames = list(itertools.islice(simulated.frames(), 2010))
    samples, parser = parsed(b"".join(frame.data for frame in frames))
    assert samples == first_samples(simulated, 2000)
    assert (parser.counts.infos, parser.counts.damaged) == (10, 0)
    assert [frame.time for frame in frames if frame.number is None] == list(range(10))
    assert [sample.time_us for sample in samples] == [5000 * k for k in range(2000)]


@settings(max_examples=50)
@given(
    shares=st.tuples(*[st.sampled_from([0.0, 0.0005, 0.01, 0.1])] * 3),
    seed=st.integers(0, 2**32 - 1),
    joints=st.integers(1, 7),
)
def test_untouched_frames_are_parsed_and_touched_ones_never_come_out_changed(
    shares: tuple[float, float, float], seed: int, joints: int
) -> None:
    damaged, lost, inserted = shares
    faults = Faults(damaged_bytes=damaged, lost_bytes=lost, inserted_bytes=inserted)
    simulated = device(sensors=SEVEN[:joints], seed=seed, faults=faults, rate=100)
    frames = list(itertools.islice(simulated.frames(), 202))
    samples, _ = parsed(b"".join(frame.data for frame in frames))
    whole = {frame.number for frame in frames if frame.whole and frame.number is not None}
    assert whole <= {sample.sequence for sample in samples}
    clean = first_samples(simulated, 200)
    assert all(sample == clean[sample.sequence] for sample in samples)


def test_shares_of_damaged_bytes_are_those_asked_for() -> None:
    simulated = device(faults=Faults(damaged_bytes=0.01))
    clean = device()
    pairs = list(zip(itertools.islice(simulated.frames(), 5000), clean.frames(), strict=False))
    different = sum(a != b for got, sent in pairs for a, b in zip(got.data, sent.data, strict=True))
    assert different / sum(len(sent.data) for _, sent in pairs) == pytest.approx(0.01, rel=0.1)
    assert all(got.whole == (got.data == sent.data) for got, sent in pairs)


def test_the_same_seed_gives_the_same_bytes() -> None:
    faults = Faults(damaged_bytes=0.01, lost_bytes=0.01, inserted_bytes=0.01)
    first, again, other = (
        list(itertools.islice(device(faults=faults, seed=seed).frames(), 600)) for seed in (3, 3, 4)
    )
    assert first == again
    assert first != other


def test_stuck_and_jumping_sensors() -> None:
    faults = Faults(
        stuck=(Stuck(2, 1.0, 2.0), Stuck(0, 3.0)), jumps=(Jump(4, 1.5, -300), Jump(1, 2.0, 60_000))
    )
    bad, good = (counts_of(first_samples(device(faults=each, rate=100), 500)) for each in (faults, Faults()))
    assert set(bad[100:200, 2]) == {good[100, 2]}
    assert np.array_equal(np.delete(bad[:, 2], np.s_[100:200]), np.delete(good[:, 2], np.s_[100:200]))
    assert set(bad[300:, 0]) == {good[300, 0]}
    assert np.array_equal(bad[150:, 4], np.clip(good[150:, 4] - 300, 0, 4095))
    assert np.array_equal(bad[200:, 1], (good[200:, 1] + 60_000) % 65536)
    assert np.array_equal(bad[:150, 4], good[:150, 4])


def test_a_restart_begins_anew_with_sequence_clock_and_registers() -> None:
    simulated = device(faults=Faults(restart_at=(1.0, 1.505)), rate=200, first_sequence=50, first_time_us=900)
    samples = first_samples(simulated, 500)
    assert [sample.sequence for sample in samples] == [*range(50, 250), *range(101), *range(199)]
    assert [samples[k].time_us for k in (0, 199, 200, 300, 301)] == [900, 995_900, 0, 500_000, 0]
    starts = {samples[k].counts[0] for k in (0, 200, 301)}
    assert len(starts) == 3
    undisturbed = counts_of(first_samples(device(rate=200), 500))
    quiet = counts_of(samples)
    assert np.abs(quiet[:, 3] - undisturbed[:, 3]).max() < 8
    infos = [frame.time for frame in itertools.islice(simulated.frames(), 400) if frame.number is None]
    assert infos == [0.0, 1.0, 1.505]


def test_sequence_and_clock_wrap_at_32_bits() -> None:
    samples = first_samples(device(rate=1000, first_sequence=2**32 - 3, first_time_us=2**32 - 2500), 6)
    assert [sample.sequence for sample in samples] == [2**32 - 3, 2**32 - 2, 2**32 - 1, 0, 1, 2]
    assert [sample.time_us for sample in samples] == [
        2**32 - 2500,
        2**32 - 1500,
        2**32 - 500,
        500,
        1500,
        2500,
    ]
    assert [len(encode_sample(sample)) for sample in samples] == [33] * 6


def test_another_version_has_a_right_checksum_and_is_not_understood() -> None:
    frames = itertools.islice(device(faults=Faults(version=9)).frames(), 50)
    samples, parser = parsed(b"".join(frame.data for frame in frames))
    assert not samples
    assert parser.versions_seen == {9}
    assert (parser.counts.unknown_version, parser.counts.damaged) == (50, 0)
    with pytest.raises(ProtocolError, match="no frame"):
        with_version(b"\0abc\0", 2)


def test_truth_keeps_the_fate_of_every_sample() -> None:
    truth = Truth(first_sequence=10)
    for number, fate in ((0, Fate.WHOLE), (2, Fate.TOUCHED), (3, Fate.WHOLE), (5, Fate.WHOLE)):
        truth.set(number, fate)
    assert truth.sent.tolist() == [10, 12, 13, 15]
    assert truth.undamaged.tolist() == [10, 13, 15]
    assert truth.damaged.tolist() == [12]
    assert truth.not_sent.tolist() == [11, 14]
    truth.forget_latest(2)
    assert truth.undamaged.tolist() == [10]
    assert truth.count(Fate.UNKNOWN) == 2
    assert (len(truth), truth.count(Fate.NOT_SENT)) == (6, 2)


@pytest.mark.parametrize(
    ("faults", "named"),
    [
        ({"damaged_bytes": 1.5}, "damaged_bytes"),
        ({"lost_bytes": float("nan")}, "lost_bytes"),
        ({"close_at": (-1.0,)}, "close_at"),
        ({"restart_at": (float("inf"),)}, "restart_at"),
        ({"closed_for": 0.0}, "closed_for"),
        ({"silent": (Silence(3.0, 2.0),)}, "start < end"),
        ({"version": 300}, "version"),
        ({"stuck": (Stuck(7, 0.0),)}, "channel 7"),
        ({"jumps": (Jump(-1, 0.0, 5),)}, "channel -1"),
    ],
)
def test_impossible_faults_are_refused(faults: dict[str, object], named: str) -> None:
    with pytest.raises(OptionError, match=named):
        device(faults=Faults(**faults))  # type: ignore[arg-type]


def test_a_motion_with_too_few_joints_is_refused() -> None:
    three = ak.JointMotion(BRUSHING.time, BRUSHING.q[:, :3], BRUSHING.joint_names[:3])
    with pytest.raises(OptionError, match="7 sensors for a motion of 3 joints"):
        SimulatedDevice(three, sensors_of(ak.catalog.ehmcs()))
