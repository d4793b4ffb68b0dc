"""What `fit_arm` cannot work with is refused with the reason; names of axes and marker files are read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_markers import FRAME, POINTS, known_markers, recording_from_base, with_gaps

import armik_sym as ak
from armik_sym.errors import (
    ArmFileError,
    ArmModelError,
    HandPathError,
    OptionError,
    RecordingError,
    ShapeError,
    UnitError,
    UnknownNameError,
)
from armik_sym.fitting import MarkerMap, read_marker_map
from armik_sym.fitting.named_axes import BODY, HAND, named_axes
from armik_sym.motion.marker_recording import MarkerRecording

RECORDING = known_markers(n=40).recording


def refused(error: type[Exception], match: str, points: object = POINTS, **options: object) -> None:
    given = {"recording": RECORDING, "side": "left", "frame": FRAME, **options}
    with pytest.raises(error, match=match):
        ak.fit_arm(given.pop("recording"), points, **given)  # type: ignore[arg-type]


def test_all_markers_that_are_missing_are_listed_with_those_that_exist() -> None:
    points = {**POINTS, "shoulder": "ACR", "elbow": ["ELB_lat", "EPI"]}
    refused(RecordingError, r"known\.trc has no marker 'ACR', 'EPI': it has SHO, ELB_lat", points)


def test_points_that_do_not_exist_or_are_missing() -> None:
    refused(UnknownNameError, "unknown point 'knee': valid are elbow, hand", {**POINTS, "knee": "SHO"})
    refused(OptionError, "elbow is missing", {"shoulder": "SHO", "wrist": "WRI_rad"})
    refused(OptionError, "shoulder is missing", {"elbow": "ELB_lat", "wrist": "WRI_rad"})
    refused(
        OptionError,
        r"wrist \(or wrist_radial and wrist_ulnar\) is missing",
        {"shoulder": "SHO", "elbow": "E"},
    )
    refused(OptionError, "elbow is 3, expected the name", {**POINTS, "elbow": 3})
    refused(OptionError, r"elbow is \[\], expected", {**POINTS, "elbow": []})
    refused(OptionError, "points is 5", 5)
    one_point = {"shoulder": "SHO", "elbow": "ELB_lat", "wrist": "WRI_rad", "hand": "MCP2"}
    refused(OptionError, "do not tell how the hand is turned: give hand_radial", one_point)


def test_a_marker_that_is_never_seen_and_points_that_are_never_seen_together() -> None:
    never = with_gaps(RECORDING, {"WRI_uln": [(0, 40)]})
    refused(RecordingError, r"marker 'WRI_uln' is missing in all 40 samples", recording=never)
    apart = with_gaps(RECORDING, {"SHO": [(0, 18)], "MCP5": [(22, 40)]})
    refused(
        RecordingError, r"4 of 40 samples have all points, a fit needs 5 \(shoulder in 22", recording=apart
    )
    enough = with_gaps(RECORDING, {"SHO": [(0, 17)], "MCP5": [(22, 40)]})
    assert ak.fit_arm(enough, POINTS, "left", FRAME).n == 5


def moved(change: Callable[[np.ndarray, Callable[[str], int]], object]) -> MarkerRecording:
    position = np.array(RECORDING.position)
    change(position, RECORDING.index)
    return replace(RECORDING, position=position)


def test_points_of_the_hand_in_one_line_do_not_tell_how_it_is_turned() -> None:
    def in_line(position: np.ndarray, index: Callable[[str], int]) -> None:
        wrist = position[:, [index("WRI_rad"), index("WRI_uln")]].mean(axis=1)
        along = position[:, index("MCP2")] - wrist
        position[:, index("MCP5")] = wrist + 0.5 * along

    refused(RecordingError, "hand points not in line in 0", recording=moved(in_line))
    one = moved(lambda p, index: p.__setitem__((7, index("MCP5")), p[7, index("MCP2")]))
    assert 7 not in ak.fit_arm(one, POINTS, "left", FRAME).sample


@pytest.mark.filterwarnings("error")
def test_single_samples_with_points_on_one_another_do_no_harm() -> None:
    def elbow_at_shoulder(position: np.ndarray, index: Callable[[str], int]) -> None:
        position[7, [index("ELB_lat"), index("ELB_med")]] = position[7, index("SHO")]

    def wrist_at_elbow(position: np.ndarray, index: Callable[[str], int]) -> None:
        middle = position[7, [index("ELB_lat"), index("ELB_med")]].mean(axis=0)
        position[7, [index("WRI_rad"), index("WRI_uln")]] = middle

    for change in (elbow_at_shoulder, wrist_at_elbow):
        fit = ak.fit_arm(moved(change), POINTS, "left", FRAME)
        assert np.isfinite(fit.measured.q).all()
        assert fit.lengths["upper_arm"].mean == pytest.approx(0.301, abs=1e-6)


def test_positions_no_laboratory_has() -> None:
    far = moved(lambda p, index: p.__setitem__((3, index("ELB_lat")), 1e20))
    refused(RecordingError, r"'ELB_lat' is 1e\+20 m from the origin in sample 3", recording=far)


def test_too_few_samples() -> None:
    few = replace(RECORDING, time=RECORDING.time[:4], position=RECORDING.position[:4])
    refused(RecordingError, "4 samples, a fit needs 5; the recording has 4", recording=few)
    refused(RecordingError, "0 samples from 3 to inf s", start=3.0)
    refused(RecordingError, "0 samples from 0.2 to 0.1 s", start=0.2, end=0.1)


@pytest.mark.parametrize(
    ("factor", "said"), [(1000.0, "millimetres"), (100.0, "centimetres"), (1 / 0.0254, "inches")]
)
def test_units_that_are_not_metres(factor: float, said: str) -> None:
    wrong = replace(RECORDING, position=factor * RECORDING.position)
    refused(UnitError, rf"upper arm is .* expected 0.06 to 0.6 m: the positions may be .*{said} \(0.301 m\)",
            recording=wrong)  # fmt: skip


def test_a_marker_in_the_wrong_place() -> None:
    swapped = {**POINTS, "wrist_radial": "MCP2", "wrist_ulnar": "MCP5"}
    refused(UnitError, "the hand is .* a marker stands for the wrong point", swapped)


def test_options_that_make_no_sense() -> None:
    refused(OptionError, "recording is a list", recording=[1])
    refused(OptionError, "base is 'floating', expected 'fixed' or 'moving'", base="floating")
    refused(OptionError, "side is 'port'", side="port")
    refused(OptionError, "side is missing: give side=, 'left' or 'right'", side=None)
    refused(OptionError, "frame is missing", frame=None)
    refused(OptionError, "(?s)frame is .* expected words", frame=2 * np.eye(3))
    refused(OptionError, "(?s)frame is .* expected words", frame=np.diag([1.0, 1.0, -1.0]))
    refused(OptionError, "rom is 'open', expected 'widened'", rom="open")
    refused(ShapeError, "rom has limits for 2 joints", rom=([0, 0], [1, 1]))
    refused(OptionError, "cutoff_hz is 80", cutoff_hz=80.0)
    refused(OptionError, "longest", fill_gaps=-1.0)


def test_orientations_that_are_none() -> None:
    points = {"shoulder": "SHO", "elbow": "ELB_lat", "wrist": "WRI_rad"}
    refused(ShapeError, r"hand_rotation has shape \(3, 3, 3\), expected \(40, 3, 3\)", points,
            hand_rotation=np.zeros((3, 3, 3)))  # fmt: skip
    turned = np.tile(np.eye(3), (40, 1, 1))
    turned[:30] = np.nan
    turned[33] *= 2
    refused(HandPathError, "rotation of sample 33 is no rotation", points, hand_rotation=turned)
    refused(OptionError, "hand_axes 'x fingers, y up'", points, hand_rotation=turned,
            hand_axes="x fingers, y up")  # fmt: skip


def test_arms_that_points_cannot_be_fitted_to() -> None:
    refused(ArmModelError, "does not say which way is up and outward", arm=ak.catalog.alfaiz())
    human = ak.catalog.human()
    chain = human.chain
    renamed = replace(chain, links=(*chain.links[:-1], replace(chain.links[-1], name="wrist_last")))
    refused(ArmModelError, "the last joint is 'wrist_last'", arm=replace(human, chain=renamed))
    offset = replace(chain, links=(*chain.links[:3], replace(chain.links[3], a=0.02), *chain.links[4:]))
    refused(ArmModelError, "an arm with offsets cannot be fitted", arm=replace(human, chain=offset))


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("x up, y right, z forward", np.eye(3)),
        ("x forward, y up, z right", [[0, 1, 0], [0, 0, 1], [1, 0, 0]]),
        ("Z=up; X=forward", [[0, 0, 1], [0, -1, 0], [1, 0, 0]]),
        ("x left, z up", [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]),
    ],
)
def test_axes_by_name(text: str, rows: object) -> None:
    np.testing.assert_array_equal(named_axes(text, BODY, "frame"), rows)


def test_axes_of_a_right_hand_are_those_of_a_left_one_mirrored() -> None:
    left = named_axes("x fingers, y ulnar", HAND, "hand_axes")
    right = named_axes("x fingers, y ulnar", HAND, "hand_axes", -1)
    np.testing.assert_array_equal(left, np.eye(3))
    np.testing.assert_array_equal(right, np.diag([1.0, 1.0, -1.0]))


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("x forward", "name two or three axes"),
        ("x forward, x up", "a second time"),
        ("x forward, y backward", "a second time"),
        ("x forward, y up, z left", "left-handed"),
        ("x ahead, y up", "cannot read 'x ahead'"),
        ("forward up right", "cannot read"),
        ("", "cannot read"),
    ],
)
def test_axes_that_make_no_sense(text: str, match: str) -> None:
    refused(OptionError, match, frame=text)


def test_a_marker_file_says_points_side_and_frame(tmp_path: Path) -> None:
    file = tmp_path / "lab.toml"
    lines = [f"{point} = {names!r}".replace("'", '"') for point, names in POINTS.items()]
    file.write_text("\n".join(['side = "right"', f'frame = "{FRAME}"', "[points]", *lines]))
    known = known_markers("right")
    fit = ak.fit_arm(known.recording, file)
    assert fit.side == "right"
    assert np.abs(fit.measured.q - known.q).max() < 1e-9
    map_read = read_marker_map(file)
    assert map_read.points["elbow"] == ("ELB_lat", "ELB_med")
    assert "SHO" in map_read.markers
    # What the call says counts more than what the file says.
    assert ak.fit_arm(known.recording, map_read, side="left").side == "left"


@pytest.mark.parametrize(
    ("content", "error", "match"),
    [
        ("[points", ArmFileError, "not valid TOML"),
        ("shoulder = 'SHO'", ArmFileError, "unknown key 'shoulder'"),
        ("side = 3\n[points]", OptionError, "side is 3, expected a text"),
        ("points = 3", ArmFileError, "expected a table"),
        ("[points]\nfoot = 'SHO'", UnknownNameError, "point in .*lab.toml 'foot'"),
        ("[points]\nshoulder = 'SHO'", OptionError, "lab.toml: wrist"),
        ("[points]\nelbow = [1]", OptionError, r"elbow is \[1\]"),
    ],
)
def test_marker_files_that_make_no_sense(
    tmp_path: Path, content: str, error: type[Exception], match: str
) -> None:
    file = tmp_path / "lab.toml"
    file.write_text(content)
    with pytest.raises(error, match=match):
        read_marker_map(file)


def test_a_marker_file_with_names_the_recording_does_not_have_is_named() -> None:
    lab = MarkerMap({**POINTS, "hand_radial": "M2"}, source="lab.toml")
    refused(RecordingError, r"no marker 'M2' \(wanted by lab.toml\)", lab)


def test_markers_are_found_with_and_without_their_prefix() -> None:
    known = known_markers()
    prefixed = replace(known.recording, names=tuple(f"P07:{name}" for name in known.recording.names))
    points = {**POINTS, "hand": ["P07:MCP2", "MCP5"]}
    fit = ak.fit_arm(prefixed, points, "left", FRAME)
    assert np.abs(fit.measured.q - known.q).max() < 1e-9


def test_the_recording_is_not_changed() -> None:
    before = np.array(RECORDING.position)
    ak.fit_arm(RECORDING, POINTS, "left", FRAME, cutoff_hz=5.0)
    np.testing.assert_array_equal(RECORDING.position, before)
    assert isinstance(RECORDING, MarkerRecording)
    assert recording_from_base("left").shape == (3, 3)
