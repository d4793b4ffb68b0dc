"""Every pointwise method through `ak.solve`: one type of answer, exact limits, failures told one by one."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.cli import app
from armik_sym.pointwise.methods import METHODS

ALFAIZ = ak.catalog.alfaiz()
BACKENDS = ("c", "vm")


def smooth_path(arm, n=25, seed=0, turned=True, speed=2.0):
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, n)
    width = np.minimum(arm.rom.width, 2.0)
    q = arm.rom.middle + 0.2 * width * np.sin(speed * t[:, None] + rng.uniform(0, 6, arm.dof))
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    return q, ak.HandPath(t, position, rotation if turned else None)


def test_all_methods_are_there():
    assert set(METHODS) == {"pro-isade", "isade", "lm", "sugihara", "alfaiz"}
    assert ak.methods() == ("trajectory", *METHODS)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("method", ["pro-isade", "lm", "sugihara", "alfaiz"])
def test_a_smooth_path_is_followed_by(method, backend):
    n = 25 if backend == "c" else 6
    q, path = smooth_path(ALFAIZ, n, speed=0.03 * n)
    solution = ak.solve(ALFAIZ, path, method, start=q[0], backend=backend)
    assert solution.ok, solution.reasons
    assert solution.method == method
    assert solution.reached.all()
    assert (solution.rom_margin >= 0).all()
    assert solution.sample_iterations.shape == (len(path),)
    assert solution.iterations == solution.sample_iterations.sum()
    assert ("compiled" if backend == "c" else "NumPy") in solution.status
    assert "samples reached" in str(solution)


def test_isade_reaches_the_hand_but_jumps():
    arm = ak.catalog.ehmcs(dof=5)
    _, path = smooth_path(arm, 30, turned=False)
    solution = ak.solve(arm, path, "isade")
    assert solution.reached.mean() > 0.9
    assert solution.max_step.max() > 0.5
    assert not solution.ok
    assert any("moves at" in reason for reason in solution.reasons)


@pytest.mark.parametrize("method", ["pro-isade", "isade", "lm", "sugihara"])
def test_a_target_out_of_reach_is_told_and_nothing_is_lost(method):
    arm = ak.catalog.ehmcs()
    q, path = smooth_path(arm, 8)
    position = np.array(path.position)
    position[5] *= 3
    solution = ak.solve(arm, ak.HandPath(path.time, position, path.rotation), method, start=q[0])
    assert not solution.ok
    assert not solution.reached[5]
    assert np.isfinite(solution.q).all()
    assert (solution.rom_margin >= 0).all()
    assert "samples ended before the method's stop criterion was met" in solution.reasons[0]
    assert "sample" in solution.reasons[0]


def test_pro_isade_never_leaves_its_window():
    arm = ak.catalog.ehmcs(dof=5)
    q, path = smooth_path(arm, 12, turned=False)  # moves faster than a window per sample
    assert np.abs(np.diff(q, axis=0)).max() > np.pi / 100
    solution = ak.solve(arm, path, "pro-isade", start=q[0], seed=3)
    assert solution.max_step.max() <= np.pi / 100 + 1e-15
    assert not solution.ok
    followed = ak.solve(arm, path, "pro-isade", start=q[0], seed=3, moving_window=True)
    assert followed.reached.all()


def test_the_seed_is_kept_and_decides():
    arm = ak.catalog.ehmcs(dof=5)
    q, path = smooth_path(arm, 40, turned=False)
    path = ak.HandPath(path.time, path.position[0] + 0.2 * (path.position - path.position[0]))
    one, same, other = (ak.solve(arm, path, "pro-isade", start=q[0], seed=s) for s in (5, 5, 6))
    np.testing.assert_array_equal(one.q, same.q)
    assert one.seed == 5
    assert np.abs(one.q - other.q).max() > 1e-6


def test_progress_counts_samples():
    q, path = smooth_path(ALFAIZ, 100)
    for method in ("lm", "alfaiz"):
        told = []
        ak.solve(ALFAIZ, path, method, start=q[0], progress=told.append)
        assert told[-1].iteration == 100


def test_the_method_of_al_faiz_refuses_other_arms_and_positions_only():
    arm = ak.catalog.ehmcs()
    _, path = smooth_path(arm)
    with pytest.raises(ak.ArmikError, match="arm 'ehmcs' has others: use"):
        ak.solve(arm, path, "alfaiz")
    with pytest.raises(ak.ArmikError, match="needs the rotation of the hand"):
        ak.solve(ALFAIZ, smooth_path(ALFAIZ, turned=False)[1], "alfaiz")


@pytest.mark.parametrize(
    ("method", "options", "message"),
    [
        ("pro-isade", {"population": 4}, "population is 4, expected a whole number ≥ 5"),
        ("pro-isade", {"window": 0}, "window is 0, expected a finite number > 0"),
        ("isade", {"window": 0.1}, "unknown option of method 'isade' 'window'"),
        ("lm", {"residual": "best"}, "residual is 'best': valid are corrected, printed"),
        ("sugihara", {"max_iterations": 0}, "max_iterations is 0"),
        ("alfaiz", {"grid": 1}, "grid is 1"),
        ("lm", {"orientation": "pointing"}, "orientation is 'pointing': valid are full, none"),
        ("lm", {"max_speed": -1}, "max_speed of joint"),
    ],
)
def test_options_that_make_no_sense(method, options, message):
    q, path = smooth_path(ALFAIZ)
    with pytest.raises(ak.ArmikError, match=message):
        ak.solve(ALFAIZ, path, method, start=q[0], **options)


def test_settings_and_verdict_are_saved(tmp_path):
    q, path = smooth_path(ALFAIZ)
    solution = ak.solve(ALFAIZ, path, "lm", start=q[0], restarts=2)
    text = solution.save(tmp_path / "lm.csv").read_text(encoding="utf-8")
    record = json.loads(text.splitlines()[0][2:])
    assert record["method"] == "lm"
    assert record["settings"]["restarts"] == 2
    assert record["ok"] is True


def test_on_the_command_line(tmp_path):
    q, path = smooth_path(ALFAIZ)
    file = tmp_path / "path.csv"
    ak.write_path(file, path)
    start = ",".join(f"{angle:.9f}" for angle in np.rad2deg(q[0]))
    arguments = [
        "solve",
        file,
        "--arm",
        "alfaiz",
        "--method",
        "lm",
        "--start",
        start,
        "--out",
        tmp_path / "out",
    ]
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert done.exit_code == 0, done.output
    assert "method lm" in done.output


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_options_of_a_method_on_the_command_line(tmp_path):
    _, path = smooth_path(ALFAIZ, 6)
    file = tmp_path / "path.csv"
    ak.write_path(file, path)
    common = ("solve", file, "--arm", "alfaiz", "--out", tmp_path)
    done = invoke(*common, "--method", "lm", "--set", "restarts=3", "--set", "residual=corrected")
    assert done.exit_code in (0, 1), done.output
    for arguments, message in (
        (("--method", "pro-isade", "--tracking", "soft"), "--tracking belongs to --method trajectory"),
        (("--method", "lm", "--max-acceleration", "9"), "--max-acceleration belongs to --method trajectory"),
        (("--method", "lm", "--set", "restarts"), "expected NAME=VALUE"),
        (("--method", "lm", "--set", "restarts=-1"), "restarts is -1"),
        (("--method", "lm", "--set", "speed=1"), "unknown option of method 'lm' 'speed'"),
    ):
        done = invoke(*common, *arguments)
        assert done.exit_code == 2
        assert message in " ".join(done.output.split())


def test_files_say_which_samples_were_reached(tmp_path):
    arm = ak.catalog.ehmcs()
    q, path = smooth_path(arm, 8)
    position = np.array(path.position)
    position[5] *= 3
    solution = ak.solve(arm, ak.HandPath(path.time, position, path.rotation), "lm", start=q[0])
    rows = solution.save(tmp_path / "lm.csv").read_text(encoding="utf-8").splitlines()[1:]
    columns = rows[0].split(",")
    reached = [float(row.split(",")[columns.index("reached [-]")]) for row in rows[1:]]
    assert reached == solution.reached.tolist()
    with np.load(solution.save(tmp_path / "lm.npz")) as file:
        np.testing.assert_array_equal(file["reached"], solution.reached)
        np.testing.assert_array_equal(file["iterations"], solution.sample_iterations)
    texts = [text.get_text() for axes in solution.plot().axes for text in axes.texts]
    assert "| not reached" in texts
