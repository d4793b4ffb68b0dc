"""Simulated sensors: what they count is what their formulas say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated_devices import BRUSHING, counts_of, device, first_samples, index_counts_of

import armik_sym as ak
from armik_sym.device.channels import SensorKind
from armik_sym.device.simulator import AtEnd, Encoder, OpenWiper, Potentiometer, sensors_of, true_calibration
from armik_sym.device.simulator.playback import Playback
from armik_sym.errors import OptionError

SEED = np.random.SeedSequence(7)


@given(
    direction=st.sampled_from([1, -1]),
    mounting=st.floats(0.5, 5.0),
    bits=st.integers(8, 16),
    angle=st.floats(-1.0, 1.0),
)
def test_quiet_potentiometer_is_off_by_half_a_count_at_most(
    direction: int, mounting: float, bits: int, angle: float
) -> None:
    pot = Potentiometer(direction, mounting, span=1 << bits, noise=0.0)
    shaft = mounting + direction * angle
    if not 0.0 <= shaft <= pot.electrical_angle:
        return
    count = pot.switched_on(SEED).read(np.array([angle])).counts[0]
    assert abs(direction * pot.scale * (count - pot.zero) - angle) <= pot.scale * (0.5 + 1e-6)


def test_noise_has_the_deviation_asked_for_and_comes_from_the_seed() -> None:
    pot = Potentiometer(noise=8.0)
    angles = np.full(20_000, 0.3)
    counts = pot.switched_on(SEED).read(angles).counts
    # Rounding adds a twelfth of a squared count.
    assert counts.std() == pytest.approx(math.sqrt(64 + 1 / 12), rel=0.03)
    assert np.array_equal(counts, pot.switched_on(SEED).read(angles).counts)
    assert not np.array_equal(counts, pot.switched_on(np.random.SeedSequence(8)).read(angles).counts)


@pytest.mark.parametrize("wiper", OpenWiper)
def test_counts_beyond_the_track_say_nothing_of_the_angle(wiper: OpenWiper) -> None:
    pot = Potentiometer(mounting=0.0, noise=0.0, open_wiper=wiper)
    beyond = np.linspace(pot.electrical_angle + 1e-6, 2 * math.pi - 1e-6, 2000)
    counts = pot.switched_on(SEED).read(beyond).counts
    if wiper is OpenWiper.FLOATING:
        assert counts.min() < 100
        assert counts.max() > 3996
        assert abs(np.corrcoef(counts, beyond)[0, 1]) < 0.1
    else:
        assert set(counts) == {0 if wiper is OpenWiper.LOW else 4095}


def test_non_linearity_is_the_share_of_full_scale_asked_for() -> None:
    angles = np.linspace(-2.9, 2.9, 5000)
    straight, bent = (
        Potentiometer(span=65536, noise=0.0, linearity=share).switched_on(SEED).read(angles).counts
        for share in (0.0, 0.01)
    )
    assert np.abs(bent - straight).max() == pytest.approx(0.01 * 65536, rel=0.01)


@given(
    direction=st.sampled_from([1, -1]),
    mounting=st.floats(-3.0, 3.0),
    start=st.integers(0, 65535),
    span=st.sampled_from([40, 4000, 8000]),
    turns=st.floats(0.1, 30.0),
    blocks=st.integers(1, 7),
)
def test_encoder_follows_through_overflow_and_latches_its_index(
    direction: int, mounting: float, start: int, span: int, turns: float, blocks: int
) -> None:
    encoder = Encoder(direction, mounting, span, start)
    angle = turns * 2 * math.pi * np.sin(np.linspace(0, 5, 1200))
    reader = encoder.switched_on(SEED)
    readings = [reader.read(part) for part in np.array_split(angle, blocks)]
    register = np.concatenate([reading.counts for reading in readings])
    assert register[0] == start
    assert register.min() >= 0
    assert register.max() < 65536
    followed = np.unwrap(register.astype(float), period=65536) - start
    moved = direction * (angle - angle[0]) / encoder.scale
    assert np.abs(followed - moved).max() <= 1 + 1e-6

    index = np.concatenate([reading.index for reading in readings])
    shaft = mounting + direction * angle
    turn, edge = np.floor(shaft / (2 * math.pi)), np.abs((shaft + math.pi) % (2 * math.pi) - math.pi)
    # Within rounding of a turn either side is right.
    clear = (edge[1:] > 1e-9) & (edge[:-1] > 1e-9)
    assert np.array_equal(index[1:][clear], (np.diff(turn) != 0)[clear])
    latched = np.concatenate([reading.index_counts for reading in readings])[index]
    back = (latched - register[index] + 32768) % 65536 - 32768
    at_pulse = shaft[index] + back * encoder.scale
    assert (np.abs((at_pulse + math.pi) % (2 * math.pi) - math.pi) <= encoder.scale * (1 + 1e-6)).all()


def test_registers_at_the_index_are_whole_turns_apart() -> None:
    encoder = Encoder(mounting=1.0, span=4000, start=100)
    readings = encoder.switched_on(SEED).read(np.linspace(0.0, 60.0, 5000))
    latched = np.unwrap(readings.index_counts[readings.index].astype(float), period=65536)
    assert len(latched) == 9
    assert set(np.diff(latched)) == {4000.0}


def test_lost_counts_make_the_register_fall_behind() -> None:
    encoder = Encoder(span=4000, start=0, lost=0.01)
    forth = encoder.switched_on(SEED).read(np.linspace(0.0, 2 * math.pi * 10, 5000)).counts[-1]
    assert 40_000 * 0.985 < forth < 40_000 * 0.995


@pytest.mark.parametrize(
    ("build", "named"),
    [
        (lambda: Potentiometer(direction=0), "direction"),
        (lambda: Potentiometer(span=1), "span"),
        (lambda: Potentiometer(noise=-1.0), "noise"),
        (lambda: Potentiometer(noise=math.nan), "noise"),
        (lambda: Potentiometer(electrical_angle=7.0), "401"),
        (lambda: Encoder(span=2), "span"),
        (lambda: Encoder(start=70000), "start"),
        (lambda: Encoder(lost=2.0), "lost"),
        (lambda: sensors_of(ak.catalog.ehmcs(), joints=8), "8 joints"),
        (lambda: sensors_of(ak.catalog.ehmcs(), encoders=["elbow"]), "elbow_flexion"),
    ],
)
def test_impossible_sensors_are_refused(build: object, named: str) -> None:
    with pytest.raises(OptionError, match=named):
        build()  # type: ignore[operator]


@pytest.mark.parametrize("seed", range(20))
def test_layout_is_that_of_the_paper_and_keeps_joints_on_their_track(seed: int) -> None:
    arm = ak.catalog.ehmcs()
    for joints, potentiometers in ((5, 3), (7, 5)):
        sensors = sensors_of(arm, joints, seed)
        kinds = [sensor.channel.kind for sensor in sensors]
        assert kinds.count(SensorKind.POTENTIOMETER) == potentiometers
        assert kinds.count(SensorKind.ENCODER) == 2
        for i, sensor in enumerate(sensors):
            if isinstance(sensor, Potentiometer):
                ends = sensor.mounting + sensor.direction * np.array([arm.rom.lower[i], arm.rom.upper[i]])
                assert ends.min() >= 0
                assert ends.max() <= sensor.electrical_angle


def test_playback_swings_or_holds_and_meets_every_sample() -> None:
    times = BRUSHING.time - BRUSHING.time[0]
    swing, hold = Playback(BRUSHING), Playback(BRUSHING, AtEnd.HOLD)
    end = BRUSHING.duration
    assert swing.angles(times) == pytest.approx(BRUSHING.q, abs=1e-12)
    assert swing.angles(end + times) == pytest.approx(BRUSHING.q[::-1], abs=1e-9)
    assert swing.angles(2 * end + times) == pytest.approx(BRUSHING.q, abs=1e-9)
    assert hold.angles(end + times) == pytest.approx(np.tile(BRUSHING.q[-1], (BRUSHING.n, 1)))
    single = ak.JointMotion([0.0], [[0.5, 0.2]], ("a", "b"))
    assert Playback(single).angles(np.array([0.0, 9.0])).tolist() == [[0.5, 0.2]] * 2


@pytest.mark.parametrize("seed", range(5))
def test_true_calibration_gives_the_true_angles_within_quantisation(seed: int) -> None:
    arm = ak.catalog.ehmcs()
    simulated = device(sensors=sensors_of(arm, seed=seed, noise=0.0), seed=seed)
    samples = first_samples(simulated, 4000)
    calibration = true_calibration(simulated, arm)
    found = calibration.angles(counts_of(samples), index_counts_of(samples))
    truth = simulated.true_angles([sample.sequence for sample in samples])
    half = np.array([sensor.scale for sensor in simulated.sensors]) / 2
    assert (np.abs(found - truth) <= half * 1.001).all()
    assert calibration.joint_names == arm.joint_names
