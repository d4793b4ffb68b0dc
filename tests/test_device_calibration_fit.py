"""Calibration recovers what simulated sensors were built with, within the errors it states."""

from __future__ import annotations

import math

import numpy as np
import pytest
from calibrations import ENCODER, POT, device, held
from hypothesis import given, settings
from hypothesis import strategies as st

from armik_sym.device.calibration import JointSetup, Posture, ScaleSource, datasheet_scale, fit_calibration
from armik_sym.device.simulator import Encoder, Potentiometer


def test_errors_over_many_devices_have_the_spread_that_is_stated() -> None:
    """Normalised errors are those of a unit normal distribution: over 300 devices, of scale and zero."""
    random = np.random.default_rng(1)
    scales, zeros = [], []
    for seed in range(300):
        sensor = Potentiometer(
            1 if random.random() < 0.5 else -1,
            mounting=math.radians(random.uniform(120, 220)),
            electrical_angle=math.radians(random.uniform(320, 355)),
            noise=random.uniform(0.8, 4.0),
        )
        angles = [-40.0, *random.uniform(-40, 60, random.integers(0, 5)), 60.0]
        postures = held([sensor], [[angle] for angle in angles], ["elbow"], seed=seed)
        joint = fit_calibration(device(POT), postures, [JointSetup("elbow", 0)]).joint("elbow")
        assert joint.direction == sensor.direction
        scales.append((joint.scale - sensor.scale) / joint.quality.scale_error)
        zeros.append((joint.zero - sensor.zero) / joint.quality.zero_error)
    for normalised in (np.array(scales), np.array(zeros)):
        # The standard deviation of 300 unit normals is 1 ± 0.04, their mean 0 ± 0.06; errors are enlarged
        # where residuals ask for it, which makes the spread a little smaller.
        assert 0.75 < normalised.std() < 1.15
        assert abs(normalised.mean()) < 0.25
        assert np.abs(normalised).max() < 5


@settings(max_examples=60)
@given(
    scale=st.floats(250, 358),
    mounting=st.floats(0, 1),
    direction=st.sampled_from([1, -1]),
    noise=st.floats(0, 6),
    angles=st.lists(st.floats(-55, 65), min_size=0, max_size=6),
    seed=st.integers(0, 2**31),
)
def test_any_potentiometer_is_recovered(
    scale: float, mounting: float, direction: int, noise: float, angles: list[float], seed: int
) -> None:
    middle = math.radians(80 + mounting * (scale - 160))
    sensor = Potentiometer(direction, middle, electrical_angle=math.radians(scale), noise=noise)
    postures = held([sensor], [[angle] for angle in (-60.0, 70.0, *angles)], ["elbow"], seed=seed)
    joint = fit_calibration(device(POT), postures, [JointSetup("elbow", 0)]).joint("elbow")
    assert joint.direction == direction
    assert abs(joint.scale - sensor.scale) < 6 * joint.quality.scale_error
    assert abs(joint.zero - sensor.zero) < 6 * joint.quality.zero_error
    assert joint.quality.residual_max < math.radians(0.5)
    assert (joint.quality.postures, joint.quality.samples) == (2 + len(angles), 500 * (2 + len(angles)))


@settings(max_examples=60)
@given(
    direction=st.sampled_from([1, -1]),
    span=st.sampled_from([40, 400, 1440, 4000, 8000]),
    start=st.integers(0, 0xFFFF),
    mounting=st.floats(-3, 3),
    angles=st.lists(st.floats(-90, 170), min_size=2, max_size=6),
)
def test_any_encoder_is_recovered_wherever_its_register_overflows(
    direction: int, span: int, start: int, mounting: float, angles: list[float]
) -> None:
    sensor = Encoder(direction, mounting, span, start)
    postures = held([sensor], [[angle] for angle in (-90.0, 170.0, *angles)], ["flexion"], samples=3)
    info = device(type(ENCODER)(ENCODER.kind, span))
    calibration = fit_calibration(info, postures, [JointSetup("flexion", 0, middle=0.7)])
    joint = calibration.joint("flexion")
    assert joint.direction == direction
    assert abs(joint.scale - sensor.scale) < 4 * joint.quality.scale_error
    for posture in postures:
        # A count is rounded once by the sensor, and the line is as good as a count.
        error = calibration.angles(posture.table)[:, 0] - posture.angles["flexion"]
        assert np.abs(error).max() < 1.5 * sensor.scale


def test_joints_are_fitted_from_their_own_postures_only() -> None:
    pot, encoder = Potentiometer(-1, noise=1.0), Encoder(1, start=65500)
    everything = held([pot, encoder], [(0, 0), (90, 5), (3, 80)], ["elbow", "flexion"])
    zero, bent, lifted = everything
    postures = [
        zero,
        Posture(bent.name, {"elbow": math.radians(90)}, bent.counts),
        Posture(lifted.name, {"flexion": math.radians(80)}, lifted.counts),
    ]
    setups = [JointSetup("elbow", 0), JointSetup("flexion", 1)]
    calibration = fit_calibration(device(POT, ENCODER), postures, setups)
    for posture in everything:
        truth = [posture.angles["elbow"], posture.angles["flexion"]]
        np.testing.assert_allclose(calibration.angles(posture.table).mean(axis=0), truth, atol=2e-3)
    assert calibration.device_id == 7
    assert calibration.date[:2] == "20"


def test_zero_pose_alone_uses_the_scale_given_and_says_so() -> None:
    sensor = Potentiometer(-1, mounting=2.0, noise=1.0)
    postures = held([sensor], [[0.0]], ["elbow"])
    setup = JointSetup("elbow", 0, scale=datasheet_scale(POT), direction=-1)
    calibration = fit_calibration(device(POT), postures, [setup])
    joint = calibration.joint("elbow")
    assert abs(joint.zero - sensor.zero) < 5 * joint.quality.zero_error
    assert (joint.scale_source, joint.scale, joint.quality.scale_error) == (
        ScaleSource.GIVEN,
        datasheet_scale(POT),
        0.0,
    )
    assert any("not measured" in note for note in calibration.notes)


def test_dead_zone_inside_the_range_is_recognised_and_reported() -> None:
    """The gap of the track lies at 50°: postures on both sides of it are one straight line, a turn apart."""
    sensor = Potentiometer(1, mounting=math.radians(345 - 50), noise=0.8)
    postures = held([sensor], [[0], [30], [80], [110]], ["elbow"])
    calibration = fit_calibration(device(POT), postures, [JointSetup("elbow", 0, middle=1.0)])
    joint = calibration.joint("elbow")
    assert abs(joint.scale - sensor.scale) < 5 * joint.quality.scale_error
    assert any("dead zone" in note for note in calibration.notes)
    for posture in postures:
        np.testing.assert_allclose(
            calibration.angles(posture.table).mean(), posture.angles["elbow"], atol=1e-3
        )


def test_bent_characteristic_is_reported_with_its_size() -> None:
    sensor = Potentiometer(1, mounting=math.radians(90), noise=0.8, linearity=0.01)
    postures = held([sensor], [[angle] for angle in range(-60, 61, 15)], ["elbow"])
    calibration = fit_calibration(device(POT), postures, [JointSetup("elbow", 0)])
    (note,) = [note for note in calibration.notes if "bent" in note]
    size = float(note.split("up to ")[1].rstrip("°.\n").split("°")[0])
    assert 0.5 < size < 3.45
    straight = held([Potentiometer(noise=0.8)], [[angle] for angle in range(-60, 61, 15)], ["elbow"])
    assert not fit_calibration(device(POT), straight, [JointSetup("elbow", 0)]).notes


def test_angle_error_enters_the_standard_errors() -> None:
    postures = held([Potentiometer(noise=1.0)], [[0], [90]], ["elbow"])
    quiet = fit_calibration(device(POT), postures, [JointSetup("elbow", 0)]).joint("elbow").quality
    sd = math.radians(2)
    loud = fit_calibration(device(POT), postures, [JointSetup("elbow", 0)], angle_error=sd)
    scale = loud.joint("elbow").scale
    # Slope over two points: sd √2 / (90° / scale).
    expected = sd * math.sqrt(2) / (math.radians(90) / scale)
    assert loud.joint("elbow").quality.scale_error == pytest.approx(expected, rel=0.01)
    assert quiet.scale_error < expected / 50
