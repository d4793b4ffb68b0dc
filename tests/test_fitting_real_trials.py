"""`fit_arm` on the real trials of the UE_ADL database, through the example that reads them."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from example_modules import load_example

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose


@pytest.fixture(scope="module")
def example() -> ModuleType:
    return load_example("09_fit_arm")


@pytest.fixture(scope="module")
def fits(example: ModuleType, recordings: Path) -> list:
    files = sorted(recordings.glob("*.csv"))
    assert len(files) == 27
    return [(example.fit_trial(trial), trial) for trial in map(example.load_trial, files)]


def test_lengths_and_shoulder_agree_with_what_is_published(fits: list) -> None:
    for fit, trial in fits:
        published = trial.facts["quality"]
        for name in ("upper_arm", "forearm"):
            s = fit.lengths[name]
            assert s.mean == pytest.approx(published[f"{name}_m"], abs=0.002)
            assert s.sd == pytest.approx(published[f"{name}_sd_m"], abs=5e-5)
            assert s.range == pytest.approx(published[f"{name}_range_m"], abs=2e-4)
        np.testing.assert_allclose(fit.shoulder_sd, published["shoulder_sd_in_torso_m"], atol=1e-4)
        assert fit.quality.left_out == 0


def test_angles_follow_hand_and_elbow_and_do_not_jump(fits: list) -> None:
    for fit, _ in fits:
        reached = ~fit.out_of_reach
        position, rotation = hand_pose(fit.arm.chain, fit.unlimited.q, fit.arm.lengths)
        assert np.abs(position - fit.path.position)[reached].max() < 1e-9
        assert np.abs(rotation - fit.path.rotation)[reached].max() < 1e-9
        # The largest step, 9.4°, is a jump of recorded hand markers; a change of branch would be 180°.
        assert np.rad2deg(np.abs(np.diff(fit.unlimited.q, axis=0)).max()) < 10


def test_elbow_and_wrist_bend_as_points_and_data_base_say(fits: list) -> None:
    for fit, trial in fits:
        q = np.rad2deg(fit.unlimited.q)
        shoulder, elbow, wrist = (trial.recording.of(name) for name in "sew")
        upper, fore = elbow - shoulder, wrist - elbow
        cosine = np.sum(upper * fore, axis=1) / np.linalg.norm(upper, axis=1) / np.linalg.norm(fore, axis=1)
        bent = np.rad2deg(np.arccos(cosine))
        # The shoulder moves in the recording, not in the fit: the elbow has to make up for it.
        expected = np.rad2deg(fit.quality.angles.total[3])
        assert np.sqrt(np.mean((q[:, 3] - bent) ** 2)) < 1.2 * expected + 0.1
        assert np.corrcoef(q[:, 3], trial.columns["isb_el_flex"])[0, 1] > 0.97
        # Extension here, flexion there, from the same zero.
        assert np.abs(np.mean(q[:, 5] + trial.columns["isb_wr_flex"])) < 15


def test_thumb_and_fingertips_are_where_they_belong(fits: list) -> None:
    for fit, trial in fits:
        origin = trial.recording.of("w")
        for point, low, high in (("th", [0.03, -0.13, -0.10], [0.13, -0.02, 0.03]),
                                 ("ft", [0.10, -0.10, -0.10], [0.20, 0.02, 0.04])):  # fmt: skip
            away = np.stack([trial.columns[point + axis] for axis in "xyz"], axis=1) - origin
            in_hand = np.einsum("nij,ni->nj", fit.path.rotation, away @ fit.to_base.T).mean(axis=0)
            assert np.all(in_hand > low), point
            assert np.all(in_hand < high), point


def test_the_side_is_right_where_the_other_side_is_not_possible(example: ModuleType, fits: list) -> None:
    assert np.mean([fit.outside.mean() for fit, _ in fits]) < 0.4
    for _, trial in fits[::6]:
        wrong = {"left": "right", "right": "left"}[trial.facts["side"]]
        assert example.fit_trial(trial, side=wrong).outside.all()


def test_a_moving_base_takes_the_error_of_the_moving_shoulder_away(example: ModuleType, fits: list) -> None:
    for fit, trial in fits[::4]:
        moving = example.fit_trial(trial, base="moving")
        assert moving.quality.angles.misfit[0] < fit.quality.angles.misfit[0]
        np.testing.assert_array_equal(moving.shoulder_sd, fit.shoulder_sd)


def test_a_marker_set_of_another_laboratory_goes_from_file_to_angles(recordings: Path) -> None:
    pytest.importorskip("ezc3d")
    file = recordings.parent / "formats" / "markers_analogs.c3d"
    if not file.is_file():
        pytest.skip(f"{file} not found: it is not part of this project")
    recording = ak.read_markers(file)
    points = {
        "shoulder": ["CLAV_AC", "SCAP_AA"],
        "elbow": ["EPICl", "EPICm"],
        "wrist_radial": "STYLr",
        "wrist_ulnar": "STYLu",
        "hand_radial": "LATH",
        "hand_ulnar": "MEDH",
    }
    fit = ak.fit_arm(recording, points, "right", "x backward, y right, z up", base="moving")
    used = [recording.of(name) for names in points.values() for name in np.atleast_1d(names)]
    seen = np.isfinite(np.stack(used)).all(axis=(0, 2))
    np.testing.assert_array_equal(fit.sample, np.flatnonzero(seen))
    assert fit.quality.left_out == np.sum(~seen) > 0
    # A box is lifted from the thighs to above the shoulders and put back: the arm hangs, rises, hangs.
    flexion = np.rad2deg(fit.unlimited.q[:, 0])
    assert flexion[0] < 30
    assert flexion.max() > 90
    assert flexion[-1] < 30
    shoulder, elbow, wrist = (sum(used[i : i + 2]) / 2 for i in (0, 2, 4))
    cosine = np.einsum("ni,ni->n", elbow - shoulder, wrist - elbow)[seen]
    cosine /= np.linalg.norm(elbow - shoulder, axis=1)[seen] * np.linalg.norm(wrist - elbow, axis=1)[seen]
    off = np.rad2deg(fit.unlimited.q[:, 3] - np.arccos(cosine))
    # The acromion is no centre of rotation: the upper arm changes its length, and the report says so.
    assert fit.lengths["upper_arm"].range > 0.02
    assert np.sqrt(np.mean(off**2)) < 1.5 * np.rad2deg(fit.quality.angles.total[3])
