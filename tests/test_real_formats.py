"""Real files of every format, each with its oddity, against readings by other means.

The files are not part of this project: the tests skip where they are absent.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import armik_sym as ak
from armik_sym.errors import MotionFileWarning, UnitError
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.read_markers import read_markers, write_markers

FOLDER = Path(__file__).resolve().parent.parent.parent / "shared" / "data" / "formats"


@pytest.fixture(scope="module")
def formats() -> Path:
    if not FOLDER.is_dir():
        pytest.skip(f"real files not found in {FOLDER}: they are not part of this project")
    return FOLDER


def rows_of(file: Path, delimiter: str, skip: int) -> list[list[str]]:
    with file.open(encoding="utf-8-sig", newline="") as text:
        return [row for row in list(csv.reader(text, delimiter=delimiter))[skip:] if any(row)]


def numbers(rows: list[list[str]], first: int, count: int) -> np.ndarray:
    """Cells as numbers in the unit of the file; NaN where empty."""
    return np.array(
        [[float(cell) if cell.strip() else math.nan for cell in row[first : first + count]] for row in rows]
    )


@pytest.mark.parametrize(
    ("name", "delimiter", "skip", "markers", "frames", "promised", "rate", "ends"),
    [
        ("markers.trc", ",", 6, 51, 93, 652, 100.0, ("ASISl", "boite_gauche_ext")),
        ("abdbonepin.trc", "\t", 5, 11, 1991, 3514, 100.0, ("gu", "ijc")),
        ("arm26_elbow_flex.trc", "\t", 6, 3, 121, None, 120.0, ("r_acromion", "r_radius_styloid")),
    ],
)
def test_trc(
    formats: Path,
    name: str,
    delimiter: str,
    skip: int,
    markers: int,
    frames: int,
    promised: int | None,
    rate: float,
    ends: tuple[str, str],
) -> None:
    if promised is None:
        r = read_markers(formats / name)
        assert r.note == ""
    else:
        with pytest.warns(MotionFileWarning, match=f"promises {promised} rows"):
            r = read_markers(formats / name)
        assert f"the header promises {promised} rows (NumFrames), the file has {frames}, fewer" in r.note
    assert (len(r), len(r.names), r.rate) == (frames, markers, rate)
    assert r.names[0] == ends[0]
    assert ends[1] in r.names
    by_hand = rows_of(formats / name, delimiter, skip)
    assert len(by_hand) == frames
    np.testing.assert_array_equal(r.time, numbers(by_hand, 1, 1)[:, 0])
    expected = numbers(by_hand, 2, 3 * markers).reshape(frames, markers, 3) / 1000
    np.testing.assert_allclose(r.position, expected, rtol=3e-16)


@pytest.mark.parametrize(
    ("name", "delimiter", "skip", "rows", "columns", "promised", "degrees"),
    [
        ("inverse_kin.mot", ",", 11, 88, 25, 250, True),
        ("inverse_dyn.sto", ",", 7, 92, 25, 250, False),
        ("arm26_InverseKinematics.mot", "\t", 11, 121, 2, None, True),
    ],
)
def test_mot_and_sto(
    formats: Path,
    name: str,
    delimiter: str,
    skip: int,
    rows: int,
    columns: int,
    promised: int | None,
    degrees: bool,
) -> None:
    if promised is None:
        table = ak.read_storage(formats / name)
    else:
        with pytest.warns(MotionFileWarning, match=f"promises {promised} rows"):
            table = ak.read_storage(formats / name)
        assert f"the file has {rows}, fewer" in table.note
    assert (len(table), len(table.names), table.in_degrees) == (rows, columns, degrees)
    by_hand = numbers(rows_of(formats / name, delimiter, skip), 0, columns + 1)
    np.testing.assert_array_equal(np.column_stack([table.time, table.values]), by_hand)


@pytest.mark.filterwarnings("ignore::armik_sym.errors.MotionFileWarning")
def test_the_seven_joints_of_a_real_arm_become_radians(formats: Path) -> None:
    joints = (
        "shoulder_plane shoulder_ele shoulder_rotation elbow_flexion pro_sup hand_r_Add hand_r_Flex".split()
    )
    motion = ak.read_motion(formats / "inverse_kin.mot", joints)
    assert motion.joint_names == tuple(joints)
    assert motion.q[0, 3] == math.radians(42.06628447)
    assert motion.time[0] == 1.56
    with pytest.raises(UnitError, match="'thorax_tilt_moment' is a load"):
        ak.read_motion(formats / "inverse_dyn.sto")


@pytest.mark.parametrize(
    ("name", "frames", "markers", "unit", "rate", "share", "label"),
    [
        ("markers_analogs.c3d", 580, 51, 1000.0, 100.0, 0.0103, "Daphnee:MEDH"),
        ("sample_propulsion.c3d", 700, 41, 1.0, 69.992615, 0.2224, "LateralEpicondyleL"),
    ],
)
def test_c3d(
    formats: Path, name: str, frames: int, markers: int, unit: float, rate: float, share: float, label: str
) -> None:
    r = read_markers(formats / name)
    assert (len(r), len(r.names), r.rate) == (frames, markers, rate)
    assert np.isnan(r.position[..., 0]).mean() == pytest.approx(share, abs=5e-4)
    assert r.of(label).shape == (frames, 3)
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed (extra c3d)")
    content = ezc3d.c3d(str(formats / name))
    assert list(r.names) == content["parameters"]["POINT"]["LABELS"]["value"]
    np.testing.assert_array_equal(r.position, content["data"]["points"][:3].transpose(2, 1, 0) / unit)
    assert r.rate == pytest.approx(content["parameters"]["POINT"]["RATE"]["value"][0], rel=1e-7)
    # The bytes themselves, without any reader: 32-bit floating-point numbers from the first block of data on.
    raw = (formats / name).read_bytes()
    start = (int.from_bytes(raw[16:18], "little") - 1) * 512
    width = 4 * markers + int.from_bytes(raw[4:6], "little")
    values = np.frombuffer(raw, "<f4", count=frames * width, offset=start).reshape(frames, width)
    points = values[:, : 4 * markers].reshape(frames, markers, 4).astype(float)
    seen = ~np.isnan(r.position).any(axis=2)
    np.testing.assert_array_equal(seen, ~np.isnan(points).any(axis=2) & (points[..., 3] >= 0))
    np.testing.assert_array_equal(r.position[seen], points[seen][:, :3] / unit)


def test_bvh(formats: Path) -> None:
    with pytest.warns(MotionFileWarning, match="the first frame stands apart"):
        motion = ak.read_bvh(formats / "01_01.bvh")
    assert "T-pose" in motion.note
    assert (len(motion), motion.frame_time, motion.channel_count) == (2752, 0.0083333, 96)
    text = (formats / "01_01.bvh").read_text().splitlines()
    first = next(i for i, line in enumerate(text) if line.startswith("Frame Time")) + 1
    np.testing.assert_array_equal(
        motion.values[[0, 1000, -1]], [list(map(float, text[first + i].split())) for i in (0, 1000, 2751)]
    )
    r = motion.positions(0.0254 / 0.45)
    np.testing.assert_allclose(r.of("Hips"), motion.values[:, :3] * (0.0254 / 0.45), rtol=1e-15)
    # One joint down the chain by hand, from the numbers in the text.
    hips = Rotation.from_euler("ZYX", motion.values[500, 3:6], degrees=True)
    hip_joint = Rotation.from_euler("ZYX", motion.values[500, 6:9], degrees=True)
    expected = motion.values[500, :3] + (hips * hip_joint).apply([1.36306, -1.79463, 0.83929])
    np.testing.assert_allclose(r.of("LeftUpLeg")[500], expected * (0.0254 / 0.45), rtol=1e-12)
    # Bones do not stretch.
    bone = np.linalg.norm(r.of("RightForeArm") - r.of("RightArm"), axis=1)
    np.testing.assert_allclose(bone, bone[0], rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "frames", "first", "share"),
    [("ADL001DR3.csv", 860, 1, 0.2041), ("ADL001_static.csv", 41, 41, 0.0)],
)
def test_nexus(formats: Path, name: str, frames: int, first: int, share: float) -> None:
    r = read_markers(formats / name)
    assert (len(r), len(r.names), r.rate, r.time[0]) == (frames, 49, 100.0, (first - 1) / 100)
    assert r.names[0] == "ADL001:RSHO1"
    by_hand = numbers(rows_of(formats / name, ",", 5), 2, 3 * 49).reshape(frames, 49, 3) / 1000
    np.testing.assert_allclose(r.position, by_hand, rtol=3e-16)
    assert np.isnan(r.position[..., 0]).mean() == pytest.approx(share, abs=5e-4)
    assert len(r.gaps) == 49


def test_nexus_landmarks_are_filled_only_in_the_static_file(formats: Path) -> None:
    still, moving = (read_markers(formats / name) for name in ("ADL001_static.csv", "ADL001DR3.csv"))
    empty = [gap.name for gap in moving.gaps if gap.fraction == 1.0]
    assert len(empty) == 10
    assert not np.isnan(still.selected(empty).position).any()


def test_angles_without_units_are_read_with_those_of_the_caller(formats: Path) -> None:
    file = formats / "ADL001DR3angles.csv"
    columns = {"elbow": "elbow flexion-extension", "forearm": "forearm pronation-supination"}
    motion = ak.read_motion(file, columns, rate=100.0, unit="deg")
    by_hand = np.radians(numbers(rows_of(file, ",", 1), 0, 11))
    assert len(motion) == len(by_hand) == 622
    np.testing.assert_allclose(motion.q, by_hand[:, [7, 8]], rtol=1e-15)
    with pytest.raises((UnitError, ak.ArmikError)):
        ak.read_motion(file)


@pytest.mark.filterwarnings("ignore::armik_sym.errors.MotionFileWarning")
@pytest.mark.parametrize("name", ["markers.trc", "ADL001DR3.csv", "sample_propulsion.c3d"])
@pytest.mark.parametrize("ending", [".trc", ".csv", ".c3d"])
def test_real_recordings_survive_every_writer(formats: Path, tmp_path: Path, name: str, ending: str) -> None:
    if ending == ".c3d":
        pytest.importorskip("ezc3d", reason="ezc3d is not installed (extra c3d)")
    r = read_markers(formats / name)
    write_markers(tmp_path / f"x{ending}", r)
    back: MarkerRecording = read_markers(tmp_path / f"x{ending}")
    assert (back.names, back.rate) == (r.names, r.rate)
    exact = ending != ".c3d"
    np.testing.assert_allclose(back.time, r.time, rtol=0, atol=0 if exact else 1e-12)
    np.testing.assert_allclose(back.position, r.position, rtol=0 if exact else 1e-7, atol=0)
