"""The real trials of the UE_ADL database through the example that documents them."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from example_modules import load_example

import armik_sym as ak
from armik_sym.comparison.elbow import elbow_position


@pytest.fixture(scope="module")
def example() -> ModuleType:
    return load_example("05_real_trials")


def test_all_trials_are_solved_inside_the_range_of_motion(example: ModuleType, recordings: Path) -> None:
    files = sorted(recordings.glob("*.csv"))
    assert len(files) == 27
    followed = 0
    for file in files:
        trial = example.load_trial(file)
        solution = ak.solve(trial.arm, trial.path, tracking="soft")
        assert np.all(solution.q >= trial.arm.rom.lower)
        assert np.all(solution.q <= trial.arm.rom.upper)
        assert solution.max_speed.max() <= 10.0
        # The recorded shoulder moves by up to 19 mm: a fixed arm cannot be asked for less.
        assert solution.position_error.max() < 0.02
        followed += solution.ok
        elbow = np.linalg.norm(elbow_position(solution.arm, solution.q) - trial.elbow, axis=1)
        assert np.median(elbow) < 0.2
    # 24 of 27 at the time of writing; a wrong side, axis or sign of a joint would lose most of them.
    assert followed >= 20


def test_hand_frame_of_the_example_is_a_rotation_and_points_along_the_fingers(
    example: ModuleType, recordings: Path
) -> None:
    for file in (recordings / "drink_R_ADL001_3.csv", recordings / "drink_L_ADL002_2.csv"):
        trial = example.load_trial(file)
        data = np.genfromtxt(file, delimiter=",", names=True)
        right = "_R_" in file.name
        to_base = (example.MIRROR if right else np.eye(3)) @ example.BASE_FROM_TORSO
        fingers = np.stack([data["ft" + a] - data["w" + a] for a in "xyz"], axis=1) @ to_base.T
        fingers /= np.linalg.norm(fingers, axis=1, keepdims=True)
        assert trial.path.rotation is not None
        along = np.einsum("ij,ij->i", fingers, trial.path.rotation[:, :, 0])
        assert np.median(along) > 0.7
