"""`armik solve` and `armik compare` on real files of every format; they are not part of this project."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from test_real_formats import formats  # noqa: F401 - a fixture
from typer.testing import CliRunner

from armik_sym.cli import app

# The markers of one laboratory, in a trc and a c3d file; the person looks along -x.
LABORATORY = """side = "right"
frame = "x backward, y right, z up"
[points]
shoulder = "ACRO_tip"
elbow = ["EPICl", "EPICm"]
wrist_radial = "STYLr"
wrist_ulnar = "STYLu"
hand_radial = "INDEX"
hand_ulnar = "LASTC"
"""
SKELETON = """side = "right"
frame = "x left, y up, z forward"
[points]
shoulder = "RightArm"
elbow = "RightForeArm"
wrist = "RightHand"
hand = "RFingers_end"
hand_radial = "RThumb_end"
"""
STATIC = """side = "right"
frame = "x right, y forward, z up"
[points]
shoulder = "RGTH"
elbow = ["RLEP", "RMEP"]
wrist_radial = "RSPR"
wrist_ulnar = "RSPU"
hand = "RFTP"
"""
# The unit of this skeleton is an inch over 0.45.
WALKS = ["--unit", "0.056444", "--base", "moving"]
# (file, points, options, samples, upper arm [m])
GOOD = [
    ("markers.trc", LABORATORY, [], 93, 0.327),
    ("markers_analogs.c3d", LABORATORY, ["--base", "moving", "--rom", "widened"], 533, 0.308),
    ("01_01.bvh", SKELETON, [*WALKS, "--begin", 0.5, "--end", 2], 180, 0.296),
    ("ADL001_static.csv", STATIC, [], 41, 0.274),
]  # fmt: skip


def run(*arguments: object):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def points_file(folder: Path, text: str) -> Path:
    file = folder / "points.toml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(("name", "points", "options", "samples", "upper_arm"), GOOD)
def test_solve(formats: Path, tmp_path: Path, name, points, options, samples, upper_arm) -> None:  # noqa: F811
    result = run(
        "solve", formats / name, "--points", points_file(tmp_path, points), *options, "--out", tmp_path
    )
    assert result.exit_code == 0, result.output
    with np.load(tmp_path / f"{Path(name).stem}_solution.npz") as saved:
        record = json.loads(str(saved["record"]))
        assert len(saved["q"]) == samples
        assert np.all((saved["q"] >= saved["lower"]) & (saved["q"] <= saved["upper"]))
        assert saved["position_error"].max() < 0.01
    assert record["lengths_m"]["upper_arm"] == pytest.approx(upper_arm, abs=1e-3)
    assert record["note"].startswith(f"right arm of {name}")
    assert "mirrored" in record["note"]


@pytest.mark.parametrize(("name", "points", "options", "samples", "upper_arm"), GOOD)
def test_compare(formats: Path, tmp_path: Path, name, points, options, samples, upper_arm) -> None:  # noqa: F811
    result = run(
        "compare", formats / name, "--points", points_file(tmp_path, points), *options,
        "--method", "trajectory", "--method", "swivel-constant", "--out", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    (length,) = re.findall(r"^  upper arm +([\d.]+) mm", result.output, re.MULTILINE)
    assert float(length) == pytest.approx(1000 * upper_arm, abs=1)
    text = (tmp_path / f"{Path(name).stem}_comparison.txt").read_text(encoding="utf-8")
    assert f"{samples} of" in text
    assert "elbow position" in result.output


@pytest.mark.parametrize("command", ["solve", "compare"])
@pytest.mark.parametrize(
    ("name", "points", "options", "words"),
    [
        ("arm26_elbow_flex.trc", None, [], "--points is missing"),
        ("arm26_elbow_flex.trc", 'shoulder = "r_acromion"\nelbow = "r_humerus_epicondyle"\n'
         'wrist = "r_radius_styloid"', [], "do not tell how the hand is turned"),
        ("abdbonepin.trc", 'elbow = "centelbow"', [], "[points] has no shoulder"),
        ("sample_propulsion.c3d", 'wrist = "NAR"\nhand = "GloveR1"', [], "[points] has no shoulder"),
        ("ADL001DR3.csv", STATIC.partition("[points]")[2], [], "is missing in all 860 samples"),
        ("01_01.bvh", SKELETON.partition("[points]")[2], [], "--unit cm"),
        ("inverse_kin.mot", None, [], "say of which arm"),
        ("inverse_kin.mot", None, ["--arm", "human"], "has no joint shoulder_flexion"),
        ("inverse_dyn.sto", None, ["--arm", "human"], "is a load"),
        ("ADL001DR3angles.csv", None, ["--arm", "human"], "joint angles need 'time'"),
    ],
)  # fmt: skip
def test_files_that_hold_no_arm_are_refused_with_the_reason(
    formats: Path, tmp_path: Path, command, name, points, options, words  # noqa: F811
) -> None:  # fmt: skip
    if points is not None:
        text = f'side = "right"\nframe = "x right, y forward, z up"\n[points]\n{points}\n'
        options = [*options, "--points", points_file(tmp_path, text)]
    result = run(command, formats / name, *options, "--out", tmp_path / "out")
    assert result.exit_code == 2, result.output
    assert words in " ".join(result.stderr.split())
    assert "Traceback" not in result.output
