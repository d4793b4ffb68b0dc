"""Counts as angles: overflow, dead zone, wrap, index pulse; blocks of any size give the same bits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from calibrations import ENCODER, POT, TURN, device, encoder_joint, pot_joint
from hypothesis import given, settings
from hypothesis import strategies as st

from armik_sym.device.calibration import AngleConverter, Calibration, EncoderZero, sample_arrays
from armik_sym.device.protocol import Sample
from armik_sym.device.simulator import Encoder, Potentiometer
from armik_sym.errors import CalibrationError, CalibrationWarning, ShapeError, UnknownNameError


def of(*joints: object) -> Calibration:
    return Calibration(7, "2026-01-01", joints)  # type: ignore[arg-type]


@settings(max_examples=150)
@given(st.data())
def test_blocks_of_any_size_give_the_same_bits(data: st.DataObject) -> None:
    n = data.draw(st.integers(1, 60))
    random = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    walk = np.cumsum(random.integers(-3000, 3001, n)) % 65536
    pots = random.integers(0, 4096, (n, 2))
    pulses = np.where(random.random(n) < data.draw(st.floats(0, 1)), (walk + 3) % 65536, -1)
    counts = np.column_stack([pots, walk])
    at_index = np.column_stack([np.full((n, 2), -1), pulses])
    calibration = of(
        pot_joint("a", 0, largest_step=data.draw(st.sampled_from([0.1, 1.0, math.inf])), zero=500.0),
        pot_joint("b", 1, direction=-1),
        encoder_joint("c", 2, index=100.0, zero=700.0, middle=0.5),
    )
    zero = data.draw(st.sampled_from(EncoderZero))
    whole = AngleConverter(calibration, zero).convert(counts, at_index)
    cuts = sorted(data.draw(st.lists(st.integers(0, n), max_size=5)))
    live = AngleConverter(calibration, zero)
    parts = [
        live.convert(c, p) for c, p in zip(np.split(counts, cuts), np.split(at_index, cuts), strict=True)
    ]
    np.testing.assert_array_equal(np.concatenate(parts), whole)
    one = AngleConverter(calibration, zero)
    rows = [one.convert(c, p) for c, p in zip(counts, at_index, strict=True)]
    np.testing.assert_array_equal(np.array(rows), whole)
    samples = [
        Sample(k, 0, tuple(map(int, row)), 4 * (p >= 0), (int(p),) if p >= 0 else ())
        for k, (row, p) in enumerate(zip(counts, pulses, strict=True))
    ]
    np.testing.assert_array_equal(AngleConverter(calibration, zero).samples(samples), whole)
    np.testing.assert_array_equal(sample_arrays(samples)[1], at_index)


@given(
    start=st.integers(0, 65535),
    direction=st.sampled_from([1, -1]),
    steps=st.lists(st.integers(-32767, 32767), min_size=1, max_size=50),
)
def test_overflow_is_undone_in_both_directions(start: int, direction: int, steps: list[int]) -> None:
    position = start + np.cumsum([0, *steps])
    joint = encoder_joint(direction=direction, zero=float(start))
    angles = of(joint).angles(position[:, np.newaxis] % 65536)[:, 0]
    np.testing.assert_allclose(angles, direction * (position - start) * joint.scale, rtol=1e-12, atol=1e-9)


def test_first_register_is_read_with_the_overflow_that_is_nearest_the_middle() -> None:
    joint = encoder_joint(zero=100.0)
    assert of(joint).angles([[65500]])[0, 0] == pytest.approx(-136 * joint.scale)
    far = replace(joint, zero=65000.0, middle=1.0)
    assert of(far).angles([[10]])[0, 0] == pytest.approx(546 * joint.scale)


@settings(max_examples=60)
@given(
    mounting=st.floats(0, 1),
    direction=st.sampled_from([1, -1]),
    seed=st.integers(0, 999),
    speed=st.floats(0.2, 5),
)
def test_dead_zone_has_no_angle_and_its_wrap_is_no_motion(
    mounting: float, direction: int, seed: int, speed: float
) -> None:
    """An input that floats over the gap of the track; the joint sweeps 300° and back over it."""
    sensor = Potentiometer(direction, mounting * TURN, noise=1.0)
    angle = math.radians(150) * np.sin(np.arange(0, TURN / speed, 0.002) * speed)
    counts = sensor.switched_on(np.random.SeedSequence(seed)).read(angle).counts[:, np.newaxis]
    joint = pot_joint(
        scale=sensor.scale, direction=direction, zero=sensor.zero, largest_step=30 / 500 + math.radians(0.5)
    )
    found = of(joint).angles(counts)[:, 0]
    on_track = np.mod(sensor.mounting + direction * angle, TURN) < sensor.electrical_angle
    if not on_track[0]:
        # The first reading has none before it and is believed.
        found[0] = np.nan
    # A floating input can happen to continue the motion for a reading; it cannot carry it away.
    assert (np.abs(found - angle) > math.radians(1)).sum() <= 0.01 * len(angle)
    assert np.nanmax(np.abs(found - angle)) < math.radians(15)
    assert np.isnan(found[~on_track]).mean() > 0.9 if (~on_track).any() else True
    # Beyond the ends of the track, noise and the moment it takes to trust it again, all angles are there.
    assert np.isnan(found[on_track]).sum() < 0.1 * len(angle)


def test_pulled_down_dead_zone_is_not_a_number_to_the_sample() -> None:
    counts = np.array([2000, 4000, 4060, 0, 0, 60, 100])[:, np.newaxis]
    found = of(pot_joint()).angles(counts)[:, 0]
    np.testing.assert_array_equal(np.isnan(found), [False, False, True, True, True, False, False])
    # Beyond the gap the angle goes on growing: it is not 340° back.
    assert found[5] > found[1] > 0


def test_single_wrong_reading_has_no_lasting_effect() -> None:
    truth = np.array([3900.0] * 20)
    spiked = truth.astype(int)
    spiked[8] = 300
    joint = pot_joint()
    found = of(joint).angles(spiked[:, np.newaxis])[:, 0]
    expected = (truth - joint.zero) * joint.scale
    np.testing.assert_allclose(np.delete(found, 8), np.delete(expected, 8))
    guarded = of(replace(joint, largest_step=0.1)).angles(spiked[:, np.newaxis])[:, 0]
    assert np.isnan(guarded[8])
    np.testing.assert_allclose(guarded[14:], expected[14:])
    np.testing.assert_allclose(guarded[:8], expected[:8])


@settings(max_examples=60)
@given(
    direction=st.sampled_from([1, -1]),
    mounting=st.floats(-3, 3),
    first=st.floats(-1.2, 2.0),
    start=st.integers(0, 65535),
)
def test_index_gives_the_zero_after_any_power_up(
    direction: int, mounting: float, first: float, start: int
) -> None:
    """Calibrated in one power-up, used in the next: absolute as soon as the index was passed."""
    sensor = Encoder(direction, mounting, start=0)
    reader = sensor.switched_on(np.random.SeedSequence(0))
    # The edge at which it was switched on holds register 0.
    edge = math.floor(mounting / sensor.scale)
    reader.read(np.zeros(1))
    joint = encoder_joint(
        direction=direction, zero=mounting / sensor.scale - edge - 0.5, index=float(-edge), middle=0.5
    )
    motion = np.concatenate([np.linspace(first, -2.6, 600), np.linspace(-2.6, 3.6, 1500)])
    readings = Encoder(direction, mounting, start=start).switched_on(np.random.SeedSequence(1)).read(motion)
    counts = readings.counts[:, np.newaxis]
    at_index = np.where(readings.index, readings.index_counts, -1)[:, np.newaxis]
    found = of(joint).angles(counts, at_index, zero=EncoderZero.INDEX)[:, 0]
    passed = int(np.argmax(readings.index))
    assert np.isnan(found[:passed]).all()
    assert readings.index.any()
    np.testing.assert_allclose(found[passed:], motion[passed:], atol=1.01 * sensor.scale)


def test_lost_counts_and_a_power_up_are_noticed_at_the_index() -> None:
    joint = encoder_joint(index=1000.0)
    counts = np.arange(0, 9001, 100)[:, np.newaxis]
    pulses = np.full_like(counts, -1)
    pulses[11], pulses[51] = 1000, 5003
    calibration = of(joint)
    np.testing.assert_allclose(calibration.angles(counts, pulses)[:, 0], counts[:, 0] * joint.scale)
    pulses[51] = 5040
    with pytest.warns(
        CalibrationWarning, match=r"'flexion': the register at the index pulse is 40 counts \(3.6°\) off"
    ):
        calibration.angles(counts, pulses)
    with pytest.warns(CalibrationWarning, match="counts were lost: check the cable"):
        calibration.angles(counts, pulses, zero=EncoderZero.INDEX)
    converter = calibration.converter()
    converter.convert(counts[:20], pulses[:20])
    assert converter.lost_counts == {}
    converter.convert(counts[20:], pulses[20:])
    assert converter.lost_counts == {"flexion": 40}


def test_zero_taken_again_after_power_up() -> None:
    calibration = of(encoder_joint("a", 0, zero=100.0, index=300.0), pot_joint("b", 1))
    again = calibration.rezeroed([[65534, 2100], [65535, 2100], [0, 2100], [1, 2100]])
    assert again.joint("a").zero == 65535.5
    assert again.joint("a").index == 65735.5
    assert again.joint("b") == calibration.joint("b")
    both = calibration.rezeroed([[5, 2100]], ["b"])
    assert (both.joint("a").zero, both.joint("b").zero) == (100.0, 2100.0)
    with pytest.raises(UnknownNameError):
        calibration.rezeroed([[5, 2100]], ["c"])


def test_what_cannot_be_converted() -> None:
    calibration = of(pot_joint("a", 1))
    for wrong, what in (
        ([[1]], "1 channels, but the calibration needs 2"),
        ([[0.5, 1.0]], "whole numbers"),
        ([[1, 70000]], "sample 0, channel 1 is 70000"),
        ([[-1, 0]], "channel 0 is -1"),
    ):
        with pytest.raises(ShapeError, match=what):
            calibration.angles(wrong)
    with pytest.raises(ShapeError, match="at_index has shape"):
        calibration.angles([[1, 2]], [[1, 2], [3, 4]])
    with pytest.raises(CalibrationError, match="'flexion': its index pulse was not passed"):
        of(encoder_joint()).converter(EncoderZero.INDEX)
    with pytest.raises(ShapeError, match="sample 1 has 1 channels, expected 2"):
        calibration.converter().samples([Sample(0, 0, (1, 2)), Sample(1, 0, (1,))])
    assert calibration.converter().samples([]).shape == (0, 1)


def test_calibration_of_another_device_is_refused() -> None:
    calibration = of(pot_joint("a", 0), encoder_joint("b", 1))
    calibration.check_device(device(POT, ENCODER))
    for other, what in (
        (device(POT, ENCODER, device_id=8), "belongs to device 7.*come from device 8"),
        (device(POT), "'b' is on channel 1, but device 7 has channels 0 to 0"),
        (device(ENCODER, ENCODER), "'a': channel 0 of device 7 is now an? encoder of 4000"),
    ):
        with pytest.raises(CalibrationError, match=what):
            calibration.check_device(other)


def test_memory_does_not_grow() -> None:
    import tracemalloc

    converter = of(pot_joint("a", 0), encoder_joint("b", 1)).converter()
    block = np.tile([[2000, 3]], (500, 1))
    converter.convert(block)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for _ in range(300):
        converter.convert(block)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20_000
