"""`fit_arm` on markers of a known arm: lengths, path, angles, limits, gaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from anatomy import ELBOW, HAND
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from synthetic_markers import (
    FRAME,
    LENGTHS,
    ORIGIN,
    POINTS,
    RATE,
    Known,
    known_markers,
    recording_from_base,
    with_gaps,
)

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.motion.marker_recording import MarkerRecording

EXACT = 1e-9
SIDES = ("left", "right")


def fitted(known: Known, side: str = "left", **options: object) -> ak.FittedArm:
    return ak.fit_arm(known.recording, POINTS, side, FRAME, **options)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("base", ["fixed", "moving"])
def test_lengths_path_and_angles_are_exact_without_noise(side: str, base: str) -> None:
    known = known_markers(side, sway=0.01 if base == "moving" else 0.0)
    fit = fitted(known, side, base=base)
    assert {name: s.mean for name, s in fit.lengths.items()} == pytest.approx(LENGTHS, abs=EXACT)
    assert all(s.sd < EXACT for s in fit.lengths.values())
    assert dict(fit.arm.lengths) == pytest.approx(LENGTHS, abs=EXACT)
    assert np.abs(fit.unlimited.q - known.q).max() < EXACT
    assert np.abs(fit.measured.q - known.q).max() < EXACT
    assert np.abs(fit.path.position - known.hand).max() < EXACT
    if base == "fixed":
        np.testing.assert_allclose(fit.shoulder, ORIGIN, atol=EXACT)
        assert fit.shoulder_sd.max() < EXACT
    for flags in (fit.outside, fit.out_of_reach, fit.straight):
        assert not flags.any()
    assert fit.mirrored is (side == "right")
    assert np.linalg.det(fit.to_base) == pytest.approx(-1 if fit.mirrored else 1)
    best = fit.quality.moving_base if base == "moving" else fit.quality.fixed_base
    assert max(misfit.largest for misfit in best.values()) < 1e-8


def test_forward_kinematics_of_the_measured_angles_are_hand_and_elbow() -> None:
    fit = fitted(known_markers("right"), "right")
    position, rotation = hand_pose(fit.arm.chain, fit.measured.q, fit.arm.lengths)
    assert np.abs(position - fit.path.position).max() < EXACT
    assert np.abs(rotation - fit.path.rotation).max() < EXACT
    elbow = joint_frames(fit.arm.chain, fit.measured.q, fit.arm.lengths)[:, ELBOW, :3, 3]
    assert np.abs(elbow - fit.elbow).max() < EXACT


def test_an_exoskeleton_whose_base_is_not_the_shoulder_is_fitted_too() -> None:
    known = known_markers()
    fit = fitted(known, arm=ak.catalog.ehmcs(), rom="widened")
    assert dict(fit.arm.lengths) == pytest.approx(
        {"upper_arm": LENGTHS["upper_arm"], "forearm": LENGTHS["forearm"]}
    )
    position, _ = hand_pose(fit.arm.chain, fit.measured.q, fit.arm.lengths)
    assert np.abs(position - fit.path.position).max() < EXACT
    # It ends at the wrist, and the same turns of forearm and wrist belong to the same hand.
    assert np.abs(position - fit.wrist).max() < EXACT
    assert np.abs(fit.measured.q[:, 3:] - known.q[:, 3:]).max() < EXACT


@pytest.mark.parametrize(
    "points",
    [
        {"wrist": ["WRI_rad", "WRI_uln"], "hand": ["MCP2", "MCP5"], "hand_radial": "MCP2"},
        {"wrist": ["WRI_rad", "WRI_uln"], "hand": ["MCP2", "MCP5"], "hand_ulnar": "MCP5"},
        {"wrist": ["WRI_rad", "WRI_uln"], "hand_radial": "MCP2", "hand_ulnar": "MCP5"},
        {"wrist_radial": "WRI_rad", "wrist_ulnar": "WRI_uln", "hand": ["MCP2", "MCP5"]},
    ],
)
@pytest.mark.parametrize("side", SIDES)
def test_every_set_of_points_that_tells_how_the_hand_is_turned(points: dict[str, object], side: str) -> None:
    known = known_markers(side)
    named = {"shoulder": "SHO", "elbow": ["ELB_lat", "ELB_med"], **points}
    fit = ak.fit_arm(known.recording, named, side, FRAME)
    assert np.abs(fit.measured.q - known.q).max() < EXACT


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("quaternions", [False, True])
def test_an_orientation_that_was_recorded_takes_the_place_of_points(side: str, quaternions: bool) -> None:
    known = known_markers(side)
    hand = joint_frames(known.arm.chain, known.q, known.arm.lengths)[:, HAND, :3, :3]
    columns = recording_from_base(side) @ hand  # fingers, ulnar, dorsal: left-handed for a right hand
    recorded = np.stack([columns[..., 1], -columns[..., 0], columns[..., 2]], axis=2)
    if side == "right":
        recorded[..., 2] *= -1
    axes = f"x ulnar, y proximal, z {'dorsal' if side == 'left' else 'palmar'}"
    given = Rotation.from_matrix(recorded).as_quat()[:, [3, 0, 1, 2]] if quaternions else recorded
    points = {"shoulder": "SHO", "elbow": ["ELB_lat", "ELB_med"], "wrist": ["WRI_rad", "WRI_uln"]}
    options = {"hand_rotation": given, "hand_axes": axes}
    fit = ak.fit_arm(known.recording, points, side, FRAME, **options)
    assert np.abs(fit.measured.q - known.q).max() < EXACT
    assert fit.arm.lengths["hand"] == 0.0
    assert np.abs(fit.path.position - fit.wrist).max() < EXACT
    with_hand = ak.fit_arm(known.recording, {**points, "hand": ["MCP2", "MCP5"]}, side, FRAME, **options)
    assert np.abs(with_hand.path.position - known.hand).max() < EXACT


def test_the_frame_may_be_a_rotation_matrix() -> None:
    known = known_markers("right")
    rows = recording_from_base("left").T
    by_matrix = ak.fit_arm(known.recording, POINTS, "right", rows)
    assert np.abs(by_matrix.to_base - fitted(known, "right").to_base).max() < 1e-15
    assert np.abs(by_matrix.measured.q - known.q).max() < EXACT


@given(seed=st.integers(0, 10_000), side=st.sampled_from(SIDES), base=st.sampled_from(["fixed", "moving"]))
@settings(max_examples=15)
def test_any_movement_of_any_arm_is_recovered_from_any_axes(seed: int, side: str, base: str) -> None:
    rng = np.random.default_rng(seed)
    lengths = dict(zip(LENGTHS, rng.uniform([0.15, 0.15, 0.03], [0.4, 0.35, 0.2]), strict=True))
    known = known_markers(side, n=60, seed=seed, sway=0.02 * (base == "moving"), lengths=lengths)
    turn = Rotation.random(random_state=seed).as_matrix()
    position = known.recording.position @ turn.T + rng.uniform(-3, 3, 3)
    recording = replace(known.recording, position=position)
    # Back to the axes of `FRAME`, and from there to the base of the left arm.
    frame = recording_from_base("left").T @ turn.T
    fit = ak.fit_arm(recording, POINTS, side, frame, base=base)
    assert np.abs(fit.measured.q - known.q).max() < EXACT
    assert dict(fit.arm.lengths) == pytest.approx(lengths, abs=EXACT)


def test_wrong_axes_are_found_suspicious() -> None:
    known = known_markers("right")
    assert "check" not in str(fitted(known, "right"))
    wrong = ak.fit_arm(known.recording, POINTS, "right", "x backward, y up")
    assert wrong.outside.mean() > 0.5
    assert "check" in str(wrong)
    assert "side" in str(wrong)


def test_gaps_are_left_out_and_the_other_samples_stay_as_they_are() -> None:
    known = known_markers()
    holes = {"SHO": [(0, 3)], "ELB_med": [(50, 58)], "MCP2": [(55, 60), (299, 300)]}
    fit = ak.fit_arm(with_gaps(known.recording, holes), POINTS, "left", FRAME)
    expected = np.setdiff1d(np.arange(300), [0, 1, 2, *range(50, 60), 299])
    np.testing.assert_array_equal(fit.sample, expected)
    np.testing.assert_array_equal(fit.path.time, known.recording.time[expected])
    assert np.abs(fit.measured.q - known.q[expected]).max() < EXACT
    quality = fit.quality
    assert (quality.samples, quality.left_out) == (286, 14)
    assert quality.longest_hole == pytest.approx(11 / RATE)
    gaps = {gap.name: gap for gap in quality.gaps}
    assert (gaps["elbow"].missing, gaps["hand_radial"].missing, gaps["hand_ulnar"].missing) == (8, 6, 0)
    assert gaps["elbow"].fraction == pytest.approx(8 / 300)
    assert gaps["elbow"].longest == pytest.approx(9 / RATE)
    assert quality.processing == ""
    assert "nothing filled" in str(fit)


def test_gaps_are_filled_and_noise_filtered_only_on_request_and_it_is_said() -> None:
    known = known_markers(noise=0.001)
    holes = {"ELB_med": [(50, 58)], "MCP2": [(150, 190)]}
    recording = with_gaps(known.recording, holes)
    fit = ak.fit_arm(recording, POINTS, "left", FRAME, fill_gaps=0.1, cutoff_hz=8.0)
    assert fit.quality.left_out == 40
    assert "cubic" in fit.quality.processing
    assert "8 samples, the longest 0.09 s" in fit.quality.processing
    assert "8 Hz" in fit.quality.processing
    assert fit.quality.processing in str(fit)
    plain = ak.fit_arm(recording, POINTS, "left", FRAME)
    assert plain.quality.left_out == 48

    def error(of: ak.FittedArm) -> np.ndarray:
        return np.sqrt(np.mean((of.unlimited.q - known.q[of.sample]) ** 2, axis=0))

    assert np.all(error(fit) < 0.75 * error(plain))


def test_start_and_end_cut_the_recording() -> None:
    known = known_markers()
    fit = fitted(known, start=0.5, end=1.5)
    np.testing.assert_array_equal(fit.sample, np.arange(50, 151))
    assert fit.path.time[0] == 0.5
    assert np.abs(fit.measured.q - known.q[50:151]).max() < EXACT
    assert fit.quality.left_out == 0


def test_angles_outside_the_range_are_stopped_and_flagged_or_the_range_is_widened() -> None:
    known = known_markers()
    rom = known.arm.rom
    upper = rom.upper.copy()
    upper[3] = np.median(known.q[:, 3])
    fit = fitted(known, rom=(rom.lower, upper))
    beyond = known.q[:, 3] > upper[3] + 1e-6
    assert 100 < beyond.sum() < 200
    np.testing.assert_array_equal(fit.outside, beyond)
    np.testing.assert_allclose(fit.measured.q[:, 3], np.minimum(known.q[:, 3], upper[3]), atol=EXACT)
    assert np.abs(fit.unlimited.q - known.q).max() < EXACT
    assert f"{beyond.sum()} samples outside" in str(fit)
    narrow = replace(known.arm, rom=fit.arm.rom)
    wide = fitted(known, arm=narrow, rom="widened")
    assert not wide.outside.any()
    np.testing.assert_array_equal(wide.measured.q, wide.unlimited.q)
    np.testing.assert_allclose(wide.arm.rom.upper[3], known.q[:, 3].max(), atol=EXACT)
    np.testing.assert_array_equal(wide.arm.rom.lower, rom.lower)


def markers_of(q: np.ndarray) -> MarkerRecording:
    """Points of the elbow, wrist and hand for angles of the model's left arm, in its base frame."""
    arm = ak.catalog.human().with_lengths(**LENGTHS)
    frames = joint_frames(arm.chain, q, arm.lengths)
    hand, ulnar = frames[:, HAND, :3, 3], frames[:, HAND, :3, 1]
    wrist = hand - LENGTHS["hand"] * frames[:, HAND, :3, 0]
    points = [np.zeros((len(q), 3)), frames[:, ELBOW, :3, 3], wrist, hand, hand - 0.04 * ulnar]
    return MarkerRecording(np.arange(len(q)) / RATE, ("s", "e", "w", "h", "r"), np.stack(points, axis=1))


BY_LETTER = {"shoulder": "s", "elbow": "e", "wrist": "w", "hand": "h", "hand_radial": "r"}
OWN_AXES = "x up, y right, z forward"


def sweep(joint: int, first_deg: float, last_deg: float, n: int = 101) -> np.ndarray:
    q = np.tile(np.deg2rad([30.0, 20.0, 15.0, 60.0, 10.0, 12.0, 7.0]), (n, 1))
    q[:, joint] = np.deg2rad(np.linspace(first_deg, last_deg, n))
    return q


def test_angles_go_on_through_the_pole_of_the_shoulder() -> None:
    q = sweep(1, 60.0, 121.3)
    fit = ak.fit_arm(markers_of(q), BY_LETTER, "left", OWN_AXES)
    assert np.abs(fit.unlimited.q - q).max() < 1e-7
    assert not fit.outside.any()


def test_angles_go_on_beyond_180_degrees_and_are_flagged_there() -> None:
    q = sweep(0, 150.0, 200.0)
    fit = ak.fit_arm(markers_of(q), BY_LETTER, "left", OWN_AXES)
    assert np.abs(fit.unlimited.q - q).max() < EXACT
    np.testing.assert_array_equal(fit.outside, q[:, 0] > np.pi + 1e-9)


def test_a_branch_outside_the_range_is_not_left_by_a_jump() -> None:
    # 30° more pronation than the range holds; the wrist's other branch would be a jump of 180°.
    q = sweep(4, -100.0, -140.0)
    fit = ak.fit_arm(markers_of(q), BY_LETTER, "left", OWN_AXES)
    assert np.abs(fit.unlimited.q - q).max() < EXACT
    assert fit.measured.q[:, 4].min() == fit.arm.rom.lower[4]


def test_a_straight_arm_is_flagged() -> None:
    fit = ak.fit_arm(markers_of(sweep(3, 0.0, 60.0)), BY_LETTER, "left", OWN_AXES)
    assert fit.straight[0]
    assert not fit.straight[20:].any()
    assert "straight" in str(fit)


@pytest.mark.parametrize("seed", range(6))
def test_an_arm_that_is_straight_for_a_while_is_recovered_on_both_sides_of_it(seed: int) -> None:
    # Noise turns the elbow of the straight arm anyhow: the turns it makes must not stay in the angles.
    known = known_markers(n=300, seed=seed, noise=0.001, straight=(0.4, 0.6))
    fit = fitted(known)
    assert fit.straight.sum() > 30
    bent = np.r_[0:50, 250:300]
    assert not fit.outside[bent].any()
    assert np.rad2deg(np.abs(fit.unlimited.q - known.q)[bent].max()) < 10.0


def test_what_noise_leaves_open_is_said_to_be_open() -> None:
    still = known_markers(n=50, noise=0.0002, straight=(-1.0, 2.0))
    text = str(fitted(still))
    assert "shoulder internal rotation > 60°" in text
    assert "elbow flexion > 60°" not in text
