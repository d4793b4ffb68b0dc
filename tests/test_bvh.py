"""`.bvh` files: forward kinematics by hand, round trips, refusals."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_recordings import names
from scipy.spatial.transform import Rotation

from armik_sym.errors import (
    MotionFileError,
    MotionFileWarning,
    OptionError,
    RecordingError,
    UnitError,
    UnknownNameError,
)
from armik_sym.motion.bvh import read_bvh, write_bvh
from armik_sym.motion.bvh_motion import CHANNELS, BvhJoint, BvhMotion
from armik_sym.motion.read_markers import read_markers

GOOD = """HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
\tJOINT Arm
\t{
\t\tOFFSET 0 2 0
\t\tCHANNELS 3 Zrotation Yrotation Xrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 1 0 0
\t\t}
\t}
\tJOINT Leg {
\t\tOFFSET 0 -1 0
\t\tCHANNELS 1 Xrotation
\t}
}
MOTION
Frames: 2
Frame Time: .01668335
1 2 3 90 0 0 90 0 0 0
1 2 3 10 20 30 40 50 60 5
"""


def read(tmp_path: Path, text: str) -> BvhMotion:
    (tmp_path / "x.bvh").write_text(text)
    return read_bvh(tmp_path / "x.bvh")


def test_joints_are_where_the_product_of_transforms_puts_them(tmp_path: Path) -> None:
    motion = read(tmp_path, GOOD)
    assert motion.names == ("Hips", "Arm", "Arm_end", "Leg")
    assert motion.rate == pytest.approx(59.94, rel=1e-6)
    r = motion.positions("cm")
    assert r.rate == motion.rate
    # First frame: a quarter turn about z at the hips, another at the arm.
    np.testing.assert_allclose(r.of("Arm")[0], [-0.01, 0.02, 0.03], atol=1e-15)
    np.testing.assert_allclose(r.of("Arm_end")[0], [-0.02, 0.02, 0.03], atol=1e-15)
    np.testing.assert_allclose(r.of("Leg")[0], [0.02, 0.02, 0.03], atol=1e-15)
    hips = Rotation.from_euler("ZYX", [10, 20, 30], degrees=True)
    arm = hips * Rotation.from_euler("ZYX", [40, 50, 60], degrees=True)
    expected = np.array([1, 2, 3]) + hips.apply([0, 2, 0]) + arm.apply([1, 0, 0])
    np.testing.assert_allclose(r.of("Arm_end")[1], 0.01 * expected, atol=1e-15)
    np.testing.assert_allclose(motion.rotations("Arm")[1], arm.as_matrix(), atol=1e-15)
    assert "lengths taken as cm" in r.note


def test_the_unit_of_length_has_to_be_given(tmp_path: Path) -> None:
    read(tmp_path, GOOD)
    with pytest.raises(UnitError, match="unit='cm'"):
        read_markers(tmp_path / "x.bvh")
    feet = read_markers(tmp_path / "x.bvh", unit=0.3048)
    np.testing.assert_allclose(feet.of("Hips")[0], 0.3048 * np.array([1, 2, 3]))
    with pytest.raises(UnknownNameError, match="cm, m, mm"):
        read_markers(tmp_path / "x.bvh", unit="inch")
    with pytest.raises(OptionError, match="positive"):
        read_markers(tmp_path / "x.bvh", unit=-1.0)


def test_fewer_frames_than_promised_are_a_warning_and_a_note(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match="promises 9 rows"):
        assert (
            "promises 9 rows (Frames), the file has 2, fewer"
            in read(tmp_path, GOOD.replace("Frames: 2", "Frames: 9")).note
        )


def test_a_first_frame_that_stands_apart_is_told(tmp_path: Path) -> None:
    rest = "0 0 0 0 0 0 0 0 0 0\n"
    more = "".join(f"1 2 3 10 20 30 40 50 {60 + i} 5\n" for i in range(5))
    text = GOOD[: GOOD.index("1 2 3 90")].replace("Frames: 2", "Frames: 6") + rest + more
    with pytest.warns(MotionFileWarning, match="the first frame stands apart"):
        assert "T-pose" in read(tmp_path, text).note


def test_offset_and_position_channels_together_are_told(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match="'Hips' has an offset and position channels"):
        motion = read(tmp_path, GOOD.replace("OFFSET 0 0 0", "OFFSET 0 0 1"))
    np.testing.assert_allclose(motion.positions("m").of("Hips")[0], [1, 2, 4])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("HIERARCHY", "SKELETON", "line 1 does not say HIERARCHY"),
        ("ROOT Hips", "JOINT Hips", "line 2 is 'JOINT Hips', expected one ROOT"),
        ("OFFSET 0 2 0", "OFFSET 0 2", "line 8 is 'OFFSET 0 2', expected OFFSET and three numbers"),
        ("CHANNELS 3 Zrotation", "CHANNELS 4 Zrotation", "line 9 is 'CHANNELS 4"),
        ("CHANNELS 3 Zrotation", "CHANNELS 3 Yrotation", "line 9"),
        ("CHANNELS 3 Zrotation", "CHANNELS 3 Wrotation", "line 9"),
        ("JOINT Leg", "JOINT Arm", "names the joint 'Arm' a second time"),
        ("\tJOINT Arm\n\t{\n", "\tJOINT Arm\n", "line 7 does not open the braces of joint 'Arm'"),
        ("}\nMOTION", "MOTION", "1 braces are not closed"),
        ("}\nMOTION", "}\n}\nMOTION", "closes a brace that was never opened"),
        ("Frames: 2", "Frames: 1e99", "Frames is '1e99'"),
        ("Frame Time: .01668335", "Frame Time: 0", "frame time '0'"),
        ("1 2 3 90", "1 2 3 nan", "column 'Hips Zrotation' is 'nan'"),
        ("1 2 3 90", "1 2 90", "line 23 has 9 cells, expected 10, one for each"),
        ("1 2 3 10 20 30 40 50 60 5\n", "1 2 3 10", "line 24 has 4 cells.*cut off"),
    ],
)
def test_wrong_files_are_refused_with_line_and_reason(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in GOOD
    with pytest.raises(MotionFileError, match=message) as caught:
        read(tmp_path, GOOD.replace(old, new, 1))
    assert "x.bvh" in str(caught.value)


def test_every_cut_ends_in_an_error_or_a_warning(tmp_path: Path) -> None:
    for end in range(GOOD.index("MOTION") + 5):
        with pytest.raises(MotionFileError, match=r"x\.bvh"):
            read(tmp_path, GOOD[:end])


def test_a_bottomless_skeleton_is_refused(tmp_path: Path) -> None:
    deep = "".join(f"JOINT j{i}\n{{\nOFFSET 0 0 1\nCHANNELS 1 Xrotation\n" for i in range(6000))
    with pytest.raises(MotionFileError, match="more than 5000 joints"):
        read(tmp_path, "HIERARCHY\n" + deep.replace("JOINT", "ROOT", 1))


def test_joints_that_contradict_each_other_are_refused() -> None:
    root = BvhJoint("a", -1, (0, 0, 0), ("Xrotation",))
    for joints, message in (
        ((root, root), "expected one before it"),
        ((root, BvhJoint("a", 0, (0, 0, 0), ("Xrotation",))), "occurs twice"),
        ((BvhJoint("a", -1, (0, 0, 0), ("Wrotation",)),), "has the channels Wrotation"),
    ):
        with pytest.raises(RecordingError, match=message):
            BvhMotion(joints, 0.01, np.zeros((1, 1)))
    with pytest.raises(UnknownNameError):
        BvhMotion((root,), 0.01, np.zeros((1, 1))).rotations("b")


@st.composite
def motions(draw: st.DrawFn) -> BvhMotion:
    labels = draw(
        names(forbidden="{}").map(lambda some: [name.replace(" ", "").replace("\xa0", "") for name in some])
    )
    labels = [
        name
        for name in dict.fromkeys(labels)
        if name and not name.endswith("_end") and name.split() == [name]
    ]
    labels = labels or ["a"]
    numbers = st.floats(-1e3, 1e3)
    joints: list[BvhJoint] = []
    open_chain: list[int] = []
    for label in labels:
        parent = draw(st.sampled_from(open_chain)) if open_chain else -1
        open_chain = [*open_chain[: open_chain.index(parent) + 1], len(joints)] if open_chain else [0]
        channels = draw(st.lists(st.sampled_from(CHANNELS[3:]), min_size=1, unique=True))
        joints.append(BvhJoint(label, parent, draw(st.tuples(numbers, numbers, numbers)), tuple(channels)))
    if draw(st.booleans()):
        joints.append(BvhJoint(joints[-1].name + "_end", len(joints) - 1, (0.0, 1.5, 0.0)))
    n, count = draw(st.integers(1, 4)), sum(len(joint.channels) for joint in joints)
    values = np.array(draw(st.lists(numbers, min_size=n * count, max_size=n * count))).reshape(n, count)
    return BvhMotion(tuple(joints), draw(st.sampled_from([1 / 59.94, 0.01, 1 / 3])), values)


@pytest.mark.filterwarnings("ignore:.*stands apart")
@settings(max_examples=60, deadline=None)
@given(motions())
def test_round_trip_is_exact(motion: BvhMotion) -> None:
    with tempfile.TemporaryDirectory() as folder:
        write_bvh(Path(folder) / "x.bvh", motion)
        back = read_bvh(Path(folder) / "x.bvh")
    assert back.joints == motion.joints
    assert back.frame_time == motion.frame_time
    np.testing.assert_array_equal(back.values, motion.values)
