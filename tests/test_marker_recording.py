"""Marker recordings in memory: what they refuse, gaps, filling and filtering."""

from __future__ import annotations

import numpy as np
import pytest

from armik_sym.errors import OptionError, RecordingError, ShapeError, UnknownNameError
from armik_sym.motion.low_pass import low_pass
from armik_sym.motion.marker_recording import MarkerRecording

TIME = np.arange(200) / 59.94


def recording(position: np.ndarray | None = None, **more: object) -> MarkerRecording:
    if position is None:
        t = TIME[:, None, None]
        position = np.concatenate([np.sin(t + np.arange(3)), t * np.array([1.0, 2.0, 3.0])], axis=1)
    return MarkerRecording(TIME, ("me:ELB", "me:WRI"), position, **more)


def with_gaps(*gaps: tuple[int, int]) -> MarkerRecording:
    position = recording().position.copy()
    for first, end in gaps:
        position[first:end, 1, 0] = np.nan  # one coordinate is enough
    return recording(position)


def test_markers_are_found_with_and_without_prefix() -> None:
    r = recording()
    np.testing.assert_array_equal(r.of("ELB"), r.of("me:ELB"))
    assert r.index("WRI") == 1
    assert r.selected(["WRI"]).names == ("me:WRI",)
    assert r.renamed({"ELB": "elbow"}).names == ("elbow", "me:WRI")
    with pytest.raises(UnknownNameError, match=r"'SHO'.*me:ELB, me:WRI"):
        r.of("SHO")
    both = MarkerRecording(TIME[:1], ("a:X", "b:X"), np.zeros((1, 2, 3)))
    with pytest.raises(UnknownNameError, match="a:X, b:X"):
        both.of("X")
    with pytest.raises(RecordingError, match="'me:WRI' occurs twice"):
        r.renamed({"ELB": "me:WRI"})


def test_rate_is_the_declared_one_or_that_of_the_times() -> None:
    assert recording(declared_rate=59.94).rate == 59.94
    assert recording().rate == pytest.approx(59.94, rel=1e-13)
    assert np.isnan(MarkerRecording([0.5], ("a",), np.zeros((1, 1, 3))).rate)
    with pytest.raises(RecordingError, match=r"declared_rate is 120 Hz, but the times have 59\.94"):
        recording(declared_rate=120.0)


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"names": ("a", "a")}, RecordingError, "'a' occurs twice"),
        ({"names": ("a", " ")}, RecordingError, "marker 1 is ' '"),
        ({"names": "ab"}, RecordingError, "one name for each marker"),
        ({"names": ("a",)}, ShapeError, r"\(200, 1, 3\)"),
        ({"time": TIME[::-1]}, RecordingError, "time runs backwards at sample 1"),
        ({"time": np.full(200, np.nan)}, RecordingError, "time of sample 0"),
        ({"position": np.full((200, 2, 3), np.inf)}, RecordingError, "sample 0, marker 0 is infinite"),
        ({"position": np.zeros((200, 2))}, ShapeError, r"expected \(200, 2, 3\)"),
        ({"declared_rate": -1.0}, RecordingError, "positive"),
    ],
)
def test_what_is_no_recording_is_refused(changes: dict, error: type[Exception], message: str) -> None:
    given = {"time": TIME, "names": ("a", "b"), "position": np.zeros((200, 2, 3)), **changes}
    with pytest.raises(error, match=message):
        MarkerRecording(**given)


def test_gaps_are_counted_and_make_the_whole_marker_missing() -> None:
    r = with_gaps((0, 3), (50, 54), (100, 101), (198, 200))
    assert np.isnan(r.of("WRI")[50]).all()
    elbow, wrist = r.gaps
    assert (elbow.missing, elbow.count, elbow.longest) == (0, 0, 0.0)
    assert (wrist.missing, wrist.count) == (10, 4)
    assert wrist.longest == pytest.approx(5 / 59.94)
    assert "10 samples missing (5.0 %) in 4 gaps" in str(wrist)


@pytest.mark.parametrize("method", ["linear", "cubic"])
def test_filling_restores_straight_lines_and_says_what_it_did(method: str) -> None:
    r = with_gaps((0, 3), (50, 54), (100, 120))
    filled = r.filled(method, longest=0.1)
    np.testing.assert_allclose(filled.of("WRI")[50:54], recording().of("WRI")[50:54], atol=1e-12)
    assert np.isnan(filled.of("WRI")[:3]).all(), "nothing is extrapolated"
    assert np.isnan(filled.of("WRI")[100:120]).all(), "the gap is longer than 0.1 s"
    assert f"filled by {method}" in filled.note
    assert "1 gaps, 4 samples, the longest 0.08342 s; 2 gaps left open" in filled.note
    seen = ~np.isnan(r.position)
    np.testing.assert_array_equal(filled.position[seen], r.position[seen])


def test_a_cubic_is_filled_by_the_cubic_method_exactly() -> None:
    t = TIME[:, None]
    position = (0.3 - t + 2 * t**2 - 0.5 * t**3)[:, None] * np.ones((1, 2, 3))
    holed = position.copy()
    holed[70:75, 0] = np.nan
    filled = recording(holed).filled("cubic", longest=0.2)
    np.testing.assert_allclose(filled.position, position, atol=1e-12)


@pytest.mark.parametrize(("method", "longest"), [("spline", 0.1), ("linear", 0.0), ("linear", float("nan"))])
def test_wrong_ways_to_fill_are_refused(method: str, longest: float) -> None:
    with pytest.raises(OptionError):
        recording().filled(method, longest)


@pytest.mark.parametrize("cutoff", [2.0, 6.0, 20.0])
def test_the_filter_halves_the_power_at_its_cut_off_without_shift(cutoff: float) -> None:
    t = np.arange(4000) / 100.0
    wave = np.sin(2 * np.pi * cutoff * t)[:, None]
    middle = slice(1500, 2500)
    passed = low_pass(wave, 100.0, cutoff)[middle, 0]
    np.testing.assert_allclose(passed, wave[middle, 0] / np.sqrt(2), atol=2e-4)
    slow = np.sin(2 * np.pi * cutoff / 20 * t)[:, None]
    np.testing.assert_allclose(low_pass(slow, 100.0, cutoff)[middle], slow[middle], atol=1e-4)


def test_the_filter_keeps_gaps_and_does_not_reach_across_them() -> None:
    r = with_gaps((60, 70), (100, 101), (102, 103))
    filtered = r.filtered(6.0)
    np.testing.assert_array_equal(np.isnan(filtered.position), np.isnan(r.position))
    changed = r.position.copy()
    changed[70:, 1] += 1.0
    np.testing.assert_array_equal(recording(changed).filtered(6.0).of("WRI")[:60], filtered.of("WRI")[:60])
    np.testing.assert_array_equal(filtered.of("WRI")[101], r.of("WRI")[101])
    assert "6 Hz" in filtered.note


def test_the_filter_needs_even_steps_and_a_cut_off_it_can_meet() -> None:
    with pytest.raises(OptionError, match=r"less than half the sampling rate, 29\.97 Hz"):
        recording().filtered(30.0)
    time = TIME.copy()
    time[150:] += 1.0
    jump = MarkerRecording(time, ("a",), np.zeros((200, 1, 3)))
    with pytest.raises(RecordingError, match="after sample 149"):
        jump.filtered(6.0)
