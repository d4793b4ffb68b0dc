"""Device angles as human angles, endpoint and swivel angle; live as recorded."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.device.angles import LiveAngles, full_posture, human_angles, human_motion, swivel_angle
from armik_sym.device.calibration import Calibration, sample_arrays
from armik_sym.device.simulator import SimulatedDevice, sensors_of, true_calibration
from armik_sym.errors import CalibrationError, ShapeError
from armik_sym.motion.joint_motion import JointMotion

ARM = ak.catalog.ehmcs(5)
INSIDE = st.tuples(*(st.floats(low, high) for low, high in zip(ARM.rom.lower, ARM.rom.upper, strict=True)))


def moving(seed: int) -> JointMotion:
    time = np.arange(0, 3, 0.01)
    lower, upper = ARM.rom.lower, ARM.rom.upper
    middle, half = (lower + upper) / 2, (upper - lower) / 2.5
    phase = np.random.default_rng(seed).uniform(0, 6, 5)
    return JointMotion(time, middle + half * np.sin(time[:, np.newaxis] * 1.5 + phase), ARM.joint_names)


@pytest.mark.parametrize("seed", range(4))
def test_from_simulated_bytes_to_human_angles_live_and_recorded(seed: int) -> None:
    """Truth → counts → device angles → human angles: within counts, and the same bits live as recorded."""
    device = SimulatedDevice(moving(seed), sensors_of(ARM, seed=seed, noise=0.3), seed=seed)
    samples = list(itertools.islice(device.samples(), 1200))
    calibration = true_calibration(device, ARM)
    truth = device.true_angles(np.arange(1200))
    counts, at_index = sample_arrays(samples)
    recorded = calibration.angles(counts, at_index)
    known = np.isfinite(recorded)
    assert known.mean() > 0.9
    scales = [joint.scale for joint in calibration.joints]
    assert (np.abs(recorded - truth) / scales)[known].max() < 3
    live = LiveAngles(calibration)
    parts = [live.take(samples[at : at + 7]) for at in range(0, 1200, 7)]
    np.testing.assert_array_equal(np.concatenate([part.device for part in parts]), recorded)
    np.testing.assert_array_equal(np.concatenate([part.human for part in parts]), human_angles(recorded))
    whole = LiveAngles(calibration).take(samples)
    for name in ("endpoint", "swivel"):
        np.testing.assert_array_equal(
            np.concatenate([getattr(part, name) for part in parts]), getattr(whole, name)
        )
    rows = known.all(axis=1)
    position, _ = hand_pose(ARM.chain, truth, ARM.lengths)
    assert np.linalg.norm(whole.endpoint - position, axis=1)[rows].max() < 0.01
    assert np.isnan(whole.endpoint[~rows]).any(axis=1).all()
    assert live.lost_counts == {}


@given(st.lists(INSIDE, min_size=1, max_size=10))
def test_human_angles_are_those_of_eq_8_and_keep_gaps(rows: list[tuple[float, ...]]) -> None:
    q = np.array(rows)
    expected = ak.elbow.human_posture(q)
    np.testing.assert_array_equal(human_angles(q), expected)
    np.testing.assert_array_equal(human_angles(q[0]), expected[0])
    q[0, 1], q[-1, 4] = math.nan, math.nan
    found = human_angles(q)
    assert np.isnan(found[0, :3]).all()
    assert np.isnan(found[-1, 4])
    np.testing.assert_array_equal(found[1:, :4], expected[1:, :4])


def test_human_motion_has_the_names_of_the_human_arm() -> None:
    motion = moving(0)
    person = human_motion(motion)
    assert person.joint_names == ak.catalog.human().joint_names[:5]
    np.testing.assert_array_equal(person.q, ak.elbow.human_posture(motion.q))
    with pytest.raises(ShapeError, match="expected the first three or more of"):
        human_motion(JointMotion(motion.time, motion.q, ("a", "b", "c", "d", "e")))
    with pytest.raises(ShapeError, match="k ≥ 3"):
        human_angles([1.0, 2.0])


@settings(max_examples=60)
@given(INSIDE, st.floats(-3.1, 3.1))
def test_turning_the_arm_about_the_line_to_the_wrist_adds_to_the_swivel_angle(
    row: tuple[float, ...], turn: float
) -> None:
    """The elbow's direction from "down", turned by hand about the line from shoulder to wrist."""
    q = np.array([row])
    points = joint_frames(ARM.chain, q, ARM.lengths)[0, :, :3, 3]
    shoulder, elbow, wrist = points[1], points[3], points[5]
    line = (wrist - shoulder) / np.linalg.norm(wrist - shoulder)
    angle = swivel_angle(ARM, q)[0]
    e = elbow - shoulder - line * (line @ (elbow - shoulder))
    down = -ARM.up + line * (line @ ARM.up)
    if np.linalg.norm(e) < 0.01 or np.linalg.norm(down) < 0.01:
        assert np.isnan(angle)
        return
    turned = Rotation.from_rotvec(line * angle).apply(down / np.linalg.norm(down))
    np.testing.assert_allclose(turned, e / np.linalg.norm(e), atol=1e-9)


def test_swivel_angle_of_a_left_arm_stretched_forwards_grows_outwards() -> None:
    def swivel(*angles_deg: float) -> float:
        return math.degrees(swivel_angle(ARM, np.radians([angles_deg]))[0])

    assert swivel(0, 90, 0, 30, 0) == pytest.approx(0)
    assert swivel(0, 90, 40, 60, 0) > 30
    assert swivel(30, 90, 0, 60, 0) > 30
    assert math.isnan(swivel(0, 90, 0, 0, 0))


def test_joints_that_the_arm_does_not_have() -> None:
    device = SimulatedDevice(moving(0), sensors_of(ARM, seed=0))
    calibration = true_calibration(device, ARM)
    with pytest.raises(CalibrationError, match="'shoulder_abduction' is none of arm 'alfaiz'"):
        LiveAngles(calibration, ak.catalog.alfaiz())
    np.testing.assert_array_equal(full_posture(ARM, ("elbow_flexion",), [[0.5]]), [[0, 0, 0, 0.5, 0]])
    two = Calibration(7, "", calibration.joints[:2])
    pose = LiveAngles(two).take(list(itertools.islice(device.samples(), 3)))
    assert np.isnan(pose.human).all()
    assert np.isfinite(pose.endpoint).all()
    assert LiveAngles(calibration).take([]).endpoint.shape == (0, 3)
