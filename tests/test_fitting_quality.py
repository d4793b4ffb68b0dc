"""The quality report of `fit_arm`: noise, rigidity, what a fixed arm explains, and the error it predicts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from anatomy import HAND
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from synthetic_markers import FRAME, LENGTHS, POINTS, RATE, known_markers, recording_from_base, with_gaps

import armik_sym as ak
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.fitting.noise import left_by_filter, rotation_noise, white_noise
from armik_sym.fitting.rigid_chain import best_rigid_chain
from armik_sym.fitting.spread import spread
from armik_sym.motion.low_pass import low_pass

HOLES = {"ELB_lat": [(40, 47), (200, 230)], "SHO": [(100, 102)], "MCP5": [(298, 300)]}


def fitted(
    seed: int, noise: float, sway: float, side: str, **options: object
) -> tuple[ak.FittedArm, np.ndarray]:
    """A fit of markers with gaps, and the error it made: root mean square of each joint, in [rad]."""
    known = known_markers(side, seed=seed, noise=noise, sway=sway)
    fit = ak.fit_arm(with_gaps(known.recording, HOLES), POINTS, side, FRAME, **options)
    return fit, np.sqrt(np.mean((fit.unlimited.q - known.q[fit.sample]) ** 2, axis=0))


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("base", ["fixed", "moving"])
@pytest.mark.parametrize(
    ("noise", "sway", "cutoff_hz"),
    [(0.001, 0.0, None), (0.0003, 0.01, None), (0.002, 0.004, None), (0.001, 0.01, 6.0)],
)
def test_the_predicted_error_is_the_error_made_within_a_factor_of_two(
    seed: int, base: str, noise: float, sway: float, cutoff_hz: float | None
) -> None:
    fit, made = fitted(seed, noise, sway, "right" if seed else "left", base=base, cutoff_hz=cutoff_hz)
    predicted = fit.quality.angles.total
    assert np.all(predicted < 2 * made)
    assert np.all(predicted > 0.5 * made)


@pytest.mark.parametrize("base", ["fixed", "moving"])
def test_the_predicted_error_holds_for_markers_that_slide_along_the_hand(base: str) -> None:
    known = known_markers(noise=0.0002)
    recording = known.recording
    position = np.array(recording.position)
    fingers = joint_frames(known.arm.chain, known.q, known.arm.lengths)[:, HAND, :3, 0]
    slide = 0.01 * np.sin(2 * np.pi * 0.4 * recording.time)[:, None] * fingers
    for name in ("MCP2", "MCP5"):
        position[:, recording.index(name)] += slide @ recording_from_base("left").T
    fit = ak.fit_arm(replace(recording, position=position), POINTS, "left", FRAME, base=base)
    made = np.sqrt(np.mean((fit.unlimited.q - known.q) ** 2, axis=0))
    assert made[3] > np.deg2rad(1.0)
    assert fit.lengths["hand"].sd == pytest.approx(0.01 / np.sqrt(2), rel=0.2)
    assert fit.quality.moving_base["hand"].rms > 0.001
    assert np.all(fit.quality.angles.total < 2 * made)
    assert np.all(fit.quality.angles.total > 0.5 * made)


def test_the_predicted_error_holds_for_a_given_orientation() -> None:
    known = known_markers(noise=0.0005)
    hand = joint_frames(known.arm.chain, known.q, known.arm.lengths)[:, HAND, :3, :3]
    turned = recording_from_base("left") @ hand
    trembling = Rotation.from_rotvec(0.02 * np.random.default_rng(8).normal(size=(len(hand), 3)))
    fit = ak.fit_arm(
        known.recording,
        {"shoulder": "SHO", "elbow": ["ELB_lat", "ELB_med"], "wrist": ["WRI_rad", "WRI_uln"]},
        "left",
        FRAME,
        hand_rotation=trembling.as_matrix() @ turned,
    )
    made = np.sqrt(np.mean((fit.unlimited.q - known.q) ** 2, axis=0))
    assert fit.quality.turned_noise == pytest.approx(0.02, rel=0.15)
    assert made[4:].min() > 0.01
    assert np.all(fit.quality.angles.total < 2 * made)
    assert np.all(fit.quality.angles.total > 0.5 * made)


@pytest.mark.parametrize("seed", range(4))
def test_lengths_are_recovered_within_the_noise(seed: int) -> None:
    fit, _ = fitted(seed, 0.001, 0.01, "right")
    for name, s in fit.lengths.items():
        # Four standard errors of the mean, and what noise across a segment adds to its length: σ²/ℓ.
        assert abs(s.mean - LENGTHS[name]) < 4 * s.sd / np.sqrt(s.samples) + 2 * 0.001**2 / LENGTHS[name]
        assert 0.0005 < s.sd < 0.002
        assert s.outlying == 0


def test_noise_of_every_point_is_told() -> None:
    fit, _ = fitted(3, 0.001, 0.01, "left")
    # The elbow is the mean of two markers.
    expected = {"elbow": 0.001 / np.sqrt(2)}
    for point, sigma in fit.quality.noise.items():
        assert sigma == pytest.approx(expected.get(point, 0.001), rel=0.15)


def test_the_moving_shoulder_is_told_and_what_it_costs_a_fixed_base() -> None:
    fit, made = fitted(0, 0.0001, 0.01, "left")
    moving, made_moving = fitted(0, 0.0001, 0.01, "left", base="moving")
    assert np.all(fit.shoulder_sd == pytest.approx(0.01 / np.sqrt(2), rel=0.2))
    assert fit.quality.moving_base["hand"].largest < 0.001
    assert fit.quality.fixed_base["elbow"].rms > 0.003
    assert np.all(made_moving < made)
    assert np.all(moving.quality.angles.misfit < 0.2 * fit.quality.angles.misfit)


def test_uneven_times_leave_the_noise_untold() -> None:
    known = known_markers(noise=0.001)
    time = known.recording.time + np.where(np.arange(300) == 100, 0.004, 0.0)
    uneven = ak.fit_arm(replace(known.recording, time=time), POINTS, "left", FRAME)
    assert np.isnan(list(uneven.quality.noise.values())).all()
    assert np.isfinite(uneven.quality.angles.total).all()


def test_the_text_has_the_numbers_of_the_report() -> None:
    fit, _ = fitted(1, 0.001, 0.01, "right")
    text = str(fit)
    assert "right arm (mirrored" in text
    assert f"{300 - 7 - 30 - 2 - 2} of 300 samples" in text
    assert f"{1000 * fit.lengths['forearm'].mean:.1f} mm" in text
    assert f"elbow flexion {np.rad2deg(fit.quality.angles.total[3]):.2f}°" in text
    assert f"hand {1000 * fit.quality.fixed_base['hand'].rms:.1f}" in text
    assert "0.31 s (elbow)" in text
    assert "FittedArm(right arm" in repr(fit)


def test_white_noise_is_measured_on_top_of_a_movement_and_around_gaps() -> None:
    t = np.arange(4000) / RATE
    movement = 0.2 * np.sin(2 * np.pi * t)[:, None] * np.ones(3)
    noisy = movement + 0.0005 * np.random.default_rng(0).normal(size=(4000, 3))
    noisy[100:140] = np.nan
    assert white_noise(noisy) == pytest.approx(0.0005, rel=0.05)
    assert white_noise(movement) < 1e-5
    assert np.isnan(white_noise(noisy[98:104]))


def test_noise_of_rotations_is_that_of_the_rotation_vector() -> None:
    turns = Rotation.from_rotvec(0.01 * np.random.default_rng(1).normal(size=(5000, 3)))
    R = (turns * Rotation.from_rotvec([0.3, -1.0, 0.5])).as_matrix()
    assert rotation_noise(R) == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize("cutoff_hz", [2.0, 6.0, 20.0])
def test_the_share_of_noise_a_filter_leaves(cutoff_hz: float) -> None:
    noise = np.random.default_rng(2).normal(size=(20000, 3))
    left = low_pass(noise, RATE, cutoff_hz).std()
    assert left_by_filter(RATE, cutoff_hz) == pytest.approx(left, rel=0.05)
    assert left_by_filter(RATE, None) == 1.0


def test_the_mean_length_leaves_out_what_is_far_away_but_keeps_what_skin_does() -> None:
    values = np.full(100, 0.3)
    values[40:70] = 0.31  # a movement between rests
    values[80:83] = 0.6  # another marker
    values[90] = np.nan
    s = spread(values)
    assert s.mean == pytest.approx((66 * 0.3 + 30 * 0.31) / 96)
    assert (s.samples, s.outlying) == (99, 3)
    assert (s.smallest, s.largest) == (0.3, 0.6)
    assert s.range == pytest.approx(0.3)
    assert s.sd == pytest.approx(np.nanstd(values))


@pytest.mark.parametrize("free_base", [True, False])
def test_the_best_rigid_chain_is_the_one_that_a_general_solver_finds(free_base: bool) -> None:
    rng = np.random.default_rng(4)
    n, k = 14, 2
    u = rng.normal(size=(n, k, 3))
    u /= np.linalg.norm(u, axis=2, keepdims=True)
    points = np.cumsum(np.array([0.3, 0.25])[:, None] * u, axis=1) + 0.01 * rng.normal(size=(n, k, 3))
    start = 0.02 * rng.normal(size=3)
    base = start if free_base else np.broadcast_to(start, (n, 3)) + 0.01 * rng.normal(size=(n, 3))
    chain = best_rigid_chain(points, base, free_base)
    mine = np.sum((chain.joints - points) ** 2)

    def residual(x: np.ndarray) -> np.ndarray:
        c, lengths, v = (x[:3] if free_base else base), x[3:5], x[5:].reshape(n, k, 3)
        v = v / np.linalg.norm(v, axis=2, keepdims=True)
        return (np.reshape(c, (-1, 1, 3)) + np.cumsum(lengths[:, None] * v, axis=1) - points).ravel()

    x0 = np.concatenate([np.zeros(3), [0.28, 0.28], u.ravel()])
    general = least_squares(residual, x0, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert mine == pytest.approx(2 * general.cost, rel=1e-6)
    np.testing.assert_allclose(chain.lengths, general.x[3:5], atol=1e-5)
    if free_base:
        np.testing.assert_allclose(chain.base, general.x[:3], atol=1e-5)
    # Segments of the chain are as long in every sample.
    ends = np.concatenate([np.broadcast_to(chain.base, (n, 3))[:, None], chain.joints], axis=1)
    sizes = np.linalg.norm(np.diff(ends, axis=1), axis=2)
    np.testing.assert_allclose(sizes, np.tile(np.abs(chain.lengths), (n, 1)), atol=1e-12)


def test_the_base_of_an_arm_that_does_not_move_stays_where_it_was() -> None:
    points = np.tile(np.array([[0.0, 0.0, -0.3], [0.25, 0.0, -0.3]]), (20, 1, 1))
    chain = best_rigid_chain(points, np.zeros(3), free_base=True)
    np.testing.assert_allclose(chain.joints, points, atol=1e-12)
    np.testing.assert_allclose(chain.base, 0.0, atol=1e-12)
