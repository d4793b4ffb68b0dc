"""The bundled tasks: made reproducibly, marked as synthetic, with the features the paper describes."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

from armik_sym.arm.catalog import by_name
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.errors import MotionFileError, UnknownNameError
from armik_sym.motion import HandPath, JointMotion, bundled, load_task, task_names

NAMES = ("drinking_reach", "drinking_lift", "brushing", "playing_ball", "catching_ball")
DATA = Path(__file__).resolve().parents[1] / "data"


@pytest.fixture(scope="module")
def make_tasks():
    spec = importlib.util.spec_from_file_location("make_tasks", DATA / "make_tasks.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


@pytest.fixture(scope="module", params=NAMES)
def task(request):
    return load_task(request.param)


def speed(task):
    return np.gradient(task.measured.q, task.measured.time, axis=0)


def test_names():
    assert task_names() == NAMES
    with pytest.raises(UnknownNameError, match="unknown task 'drinking': valid are brushing, catching_ball"):
        load_task("drinking")


def test_files_are_what_make_tasks_makes(make_tasks, tmp_path, capsys):
    assert make_tasks.main(["--check"]) == 0
    assert sorted(make_tasks.TASKS) == sorted(NAMES)
    assert make_tasks.main(["--folder", str(tmp_path)]) == 0
    for made in tmp_path.iterdir():
        assert made.read_bytes() == (DATA / "tasks" / made.name).read_bytes()
    changed = tmp_path / "brushing_path.csv"
    changed.write_text(changed.read_text().replace("0.02", "0.03"))
    (tmp_path / "brushing_angles.csv").unlink()
    assert make_tasks.main(["--check", "--folder", str(tmp_path)]) == 1
    assert "brushing_angles.csv, brushing_path.csv" in capsys.readouterr().err


def test_values_near_a_rounding_edge_are_refused(make_tasks):
    with pytest.raises(ValueError, match="rounding edge"):
        make_tasks.rounded(np.array([0.2, 1.5 + 1e-14]), 1.0, 1e-13)


def test_nothing_else_lies_in_the_folder_and_every_file_says_synthetic():
    files = sorted((DATA / "tasks").iterdir())
    assert [f.name for f in files] == sorted(f"{n}_{what}.csv" for n in NAMES for what in ("angles", "path"))
    for file in files:
        comments = [line for line in file.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
        assert any("SYNTHETIC" in line for line in comments), file


def test_what_a_task_is(task):
    arm = by_name(task.arm_name)
    assert isinstance(task.path, HandPath)
    assert isinstance(task.measured, JointMotion)
    assert task.measured.joint_names == arm.joint_names
    assert np.array_equal(task.path.time, task.measured.time)
    assert 100 <= task.path.n <= 650
    assert 1.5 <= task.path.duration <= 6.0
    assert 49 <= (task.path.n - 1) / task.path.duration <= 201


def test_no_joint_leaves_the_search_window_of_the_paper_between_two_samples(task):
    """π/100 per sample (Nguyen 2021, Table 5): else no Pro-ISADE could follow the elbow."""
    assert np.abs(np.diff(task.measured.q, axis=0)).max() < 0.9 * np.pi / 100


def test_the_path_is_the_path_of_the_angles(task):
    arm = by_name(task.arm_name)
    position, rotation = hand_pose(arm.chain, task.measured.q, arm.lengths)
    assert np.abs(position - task.path.position).max() < 1e-9
    assert np.abs(rotation - task.path.rotation).max() < 1e-9


def test_inside_the_range_of_motion_and_not_too_fast(task):
    arm = by_name(task.arm_name)
    assert np.rad2deg(arm.rom.margin(task.measured.q).min()) >= 1.0
    assert np.abs(speed(task)).max() < 6.0
    assert not task.measured.q[:, 5:].any()


@pytest.mark.parametrize("name", ["drinking_reach", "drinking_lift", "brushing"])
def test_q3_and_q5_are_nearly_constant(name):
    assert (np.rad2deg(np.ptp(load_task(name).measured.q, axis=0))[[2, 4]] < 1.5).all()


def test_brushing_oscillates_in_q2_at_the_end():
    task = load_task("brushing")
    q2_speed = speed(task)[:, 1]
    late = q2_speed[task.path.time > 0.5 * task.path.duration]
    assert np.count_nonzero(np.diff(np.sign(late))) >= 3
    swing = np.rad2deg(np.ptp(task.measured.q[task.path.time > 3.0], axis=0))
    assert swing[1] > 5 * swing[[0, 2, 3, 4]].max()


def test_drinking_ends_at_the_mouth_and_its_stages_join():
    reach, lift = load_task("drinking_reach"), load_task("drinking_lift")
    assert 120 <= np.rad2deg(lift.measured.q[-1, 3]) <= 130
    up, right, forward = lift.path.position[-1] - [0.0, 0.0, 0.143]
    assert 0.0 < up < 0.2
    assert 0.1 < right < 0.3
    assert 0.1 < forward < 0.3
    assert np.abs(np.rad2deg(reach.measured.q[-1] - lift.measured.q[0])).max() < 2.0


def test_ball_tasks_move_farther_and_faster():
    for name in ("playing_ball", "catching_ball"):
        task = load_task(name)
        assert (np.rad2deg(np.ptp(task.measured.q, axis=0))[:5] > 20).all()
        assert np.abs(speed(task)).max() > 3.0


def test_bundled_files_are_those_of_the_checkout():
    # An installed wheel carries a copy; a working copy has the folder itself.
    for file in sorted((DATA / "tasks").iterdir()):
        assert (bundled.data_folder() / "tasks" / file.name).read_bytes() == file.read_bytes()


def test_data_folder_of_a_wheel_and_missing_data(monkeypatch, tmp_path):
    package = tmp_path / "armik_sym"
    monkeypatch.setattr(bundled, "__file__", str(package / "motion" / "bundled.py"))
    with pytest.raises(MotionFileError, match=r"bundled data are missing.*install the package again"):
        bundled.data_folder()
    (package / "_data" / "tasks").mkdir(parents=True)
    assert bundled.data_folder() == package / "_data"
