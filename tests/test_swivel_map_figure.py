"""The picture of the swivel map: what is drawn is what the map says, in every odd case."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from smooth_motions import path_of, smooth_angles, smooth_path
from solutions import of_motion

import armik_sym as ak
from armik_sym.arm import Arm
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.limit_words import limit_words
from armik_sym.errors import OptionError, ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.report.stick_figure import stick_figure
from armik_sym.report.swivel_map_bands import bands_of, into_window, window_of
from armik_sym.report.swivel_map_guides import elbow_guides
from armik_sym.report.swivel_map_panel import TINTS
from armik_sym.swivel.map import SwivelMap, swivel_map

TASK = ak.load_task("catching_ball")
UNIT = re.compile(r"\[(s|deg)\]")


def task_map() -> SwivelMap:
    return swivel_map(ehmcs(), TASK.path)


def free(arm: Arm) -> Arm:
    return arm.with_rom(np.full(7, -np.pi), np.full(7, np.pi))


def words(figure: Figure) -> str:
    figure.canvas.draw()
    texts = [*figure.texts, figure._suptitle]
    for axes in figure.axes:
        texts += [*axes.texts, axes.title, axes._left_title, axes._right_title]
        legends = [child for child in axes.get_children() if type(child).__name__ == "Legend"]
        for legend in legends:
            texts += legend.get_texts()
    return "\n".join(text.get_text().replace("\n", " ") for text in texts)


def panels(figure: Figure) -> list:
    return [axes for axes in figure.axes if axes.axison]


def test_it_explains_itself_with_units_and_limits_and_leaves_pyplot_alone() -> None:
    figure = task_map().plot(title="Catching")
    (axes,) = panels(figure)
    assert UNIT.search(axes.get_xlabel())
    assert UNIT.search(axes.get_ylabel())
    said = words(figure)
    assert "Catching: swivel map, arm ehmcs, 401 samples" in said
    assert "Synthetic" in said
    assert "about the line from shoulder to wrist" in said
    assert "Postures with shoulder flexion -90° to 90°" in said
    assert "a posture at every sample" in said
    assert "over 30°" in said
    pyplot = sys.modules.get("matplotlib.pyplot")
    assert pyplot is None or pyplot.get_fignums() == []
    assert "From a log" in words(task_map().plot(note="From a log"))


def test_every_limit_that_ends_the_band_for_long_is_named_and_no_other() -> None:
    map_ = task_map()
    said = words(map_.plot())
    ends = map_.interval_ends()
    rows = map_.intervals.branch == 2
    share: dict[str, float] = {}
    for joint in range(7):
        for upper in (False, True):
            hits = (ends.joint[rows] == joint) & (ends.upper[rows] == upper)
            share[limit_words(map_.arm, joint, upper)] = float(hits.any(axis=1).mean())
    assert sum(part > 0.05 for part in share.values()) >= 5
    for limit, part in share.items():
        if part > 0.05:
            assert limit in said
        if part == 0:
            assert limit not in said


def test_lines_are_the_swivel_angles_of_the_motions() -> None:
    map_ = task_map()
    q = TASK.measured.q
    other = map_.postures(map_.swivel_of(q).psi + 0.2, 2)
    figure = map_.plot(q, compare={"Other": other, "measured": TASK.measured})
    (axes,) = panels(figure)
    said = words(figure)
    assert {"solved", "Other", "measured"} <= set(said.splitlines())
    drawn = [line.get_ydata() for line in axes.lines if len(line.get_xdata()) == len(map_)]
    for motion in (q, other):
        psi = np.rad2deg(map_.swivel_of(motion).psi)
        assert any(np.allclose(np.mod(np.asarray(y, float) - psi + 1, 360), 1, atol=1e-6) for y in drawn)
    low, high = axes.get_ylim()
    assert all(low < np.nanmin(y) and np.nanmax(y) < high for y in drawn[-3:])


def test_a_solution_is_called_by_its_method() -> None:
    arm, n = ehmcs(), 12
    q = smooth_angles(arm, n, 1)
    solution = of_motion(arm, q)
    figure = swivel_map(arm, solution.path).plot(solution)
    assert "solved (by hand)" in words(figure)


@pytest.mark.parametrize("seed", range(4))
def test_bands_are_the_intervals(seed: int) -> None:
    arm = human()
    path, _ = smooth_path(arm, 80, seed, most=2.5, width=0.98)
    map_ = swivel_map(arm, path)
    for branch in (0, 2):
        low, high = window_of(map_, [branch], [])
        assert high - low <= 360 + 1e-9
        bands = bands_of(map_, branch, low, high)
        drawn = {row for strip in bands.strips for row in strip.rows}
        assert drawn == set(np.flatnonzero(map_.intervals.branch == branch))
        for strip in bands.strips:
            assert np.all(np.diff(strip.columns) == 1)
            sample = bands.samples[strip.columns]
            np.testing.assert_array_equal(map_.intervals.sample[strip.rows], sample)
            for edge, exact in ((strip.start, map_.intervals.start), (strip.end, map_.intervals.end)):
                turns = (np.array(edge) - np.rad2deg(exact[strip.rows])) / 360
                np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
            for k in range(len(strip.columns) - 1):
                assert strip.start[k] <= strip.end[k + 1]
                assert strip.start[k + 1] <= strip.end[k]


def test_a_band_across_the_cut_at_180_degrees_is_drawn_in_one_piece() -> None:
    arm = ehmcs()
    plain = swivel_map(arm, TASK.path)
    behind = swivel_map(arm, TASK.path, reference=-plain.reference[0])
    assert (behind.intervals.end > np.pi).any()
    for map_ in (plain, behind):
        low, high = window_of(map_, [2], [])
        (strip,) = bands_of(map_, 2, low, high).strips
        assert len(strip.columns) == len(map_)
        assert low < min(strip.start)
        assert max(strip.end) < high
        width = np.array(strip.end) - np.array(strip.start)
        np.testing.assert_allclose(width, np.rad2deg(plain.width[:, 2]), atol=1e-9)


def test_tints_are_clearances() -> None:
    map_ = task_map()
    (axes,) = panels(map_.plot())
    (picture,) = axes.images
    colours = picture.get_array()
    left, right, low, high = picture.get_extent()
    rng = np.random.default_rng(0)
    right_ones = total = 0
    for _ in range(150):
        sample, psi = int(rng.integers(0, len(map_))), float(rng.uniform(low, high))
        margin = np.rad2deg(map_.clearance([np.deg2rad(psi)], 2, [sample]).margin[0, 0])
        steps = np.array([least for least, _ in TINTS])
        if margin < 0 or np.abs(margin - steps).min() < 0.7:
            continue
        wanted = to_rgb(TINTS[int(np.searchsorted(steps, margin)) - 1][1])
        i = int((psi - low) / (high - low) * (len(colours) - 1))
        j = int((map_.path.time[sample] - left) / (right - left) * (colours.shape[1] - 1))
        total += 1
        right_ones += np.allclose(colours[i, j], wanted, atol=0.01)
    assert total > 40
    assert right_ones >= 0.97 * total


def test_tints_get_darker_with_clearance_in_grey_too() -> None:
    grey = [np.dot(to_rgb(colour), [0.299, 0.587, 0.114]) for _, colour in TINTS]
    assert np.all(np.diff(grey) < -0.04)


@pytest.mark.parametrize("arm", [ehmcs(), human()], ids=lambda arm: arm.name)
def test_the_elbow_is_lowest_and_outermost_where_the_guides_say(arm: Arm) -> None:
    """Against the elbow of the DH chain, at many swivel angles."""
    path, _ = smooth_path(arm, 30, seed=3)
    map_ = swivel_map(arm, path)
    scan = np.deg2rad(np.arange(-180, 180, 1.0))
    samples = np.array([0, 7, 15, 29])
    guides = {guide.words: guide.psi_deg for guide in elbow_guides(map_, samples)}
    assert {"elbow lowest", "elbow outermost"} <= set(guides)
    elbows = np.array([stick_figure(arm, map_.postures(psi, 3)[samples]).points[:, 1] for psi in scan])
    for name, direction, sign in (
        ("elbow lowest", arm.up, -1), ("elbow highest", arm.up, 1),
        ("elbow outermost", arm.outward, 1), ("elbow innermost", arm.outward, -1),
    ):  # fmt: skip
        for i, psi in enumerate(guides.get(name, [])):
            if np.isfinite(psi):
                best = np.rad2deg(scan[(sign * elbows[:, i] @ direction).argmax()])
                assert abs((best - psi + 180) % 360 - 180) <= 0.51


def test_an_arm_that_does_not_say_where_up_is_has_no_guides() -> None:
    arm = replace(ehmcs(), up=None, outward=None)
    map_ = swivel_map(arm, TASK.path)
    assert elbow_guides(map_, np.arange(3)) == []
    assert "elbow lowest" not in words(map_.plot())
    assert "elbow lowest" in words(task_map().plot())


def test_samples_without_posture_are_hatched_with_the_reason() -> None:
    arm = ak.load_arm("ehmcs")
    upper = arm.rom.upper.copy()
    upper[3] = np.deg2rad(110)
    task = ak.load_task("drinking_lift")
    map_ = swivel_map(arm.with_rom(arm.rom.lower, upper), task.path)
    figure = map_.plot(compare={"measured": task.measured})
    said = words(figure)
    assert f"{len(map_.blocked)} of them without any posture" in said
    assert f"no posture at {len(map_.blocked)} of {len(map_)} samples" in said
    assert "no posture: elbow flexion limit (110°) missed by 15.2°" in said
    (axes,) = panels(figure)
    (span,) = [patch for patch in axes.patches if patch.get_hatch()]
    left, right = span.get_x(), span.get_x() + span.get_width()
    time = task.path.time
    inside = (time >= left) & (time <= right)
    np.testing.assert_array_equal(np.flatnonzero(inside), map_.blocked)


def test_nothing_but_blocked_samples_can_be_drawn() -> None:
    path, _ = smooth_path(ehmcs(), 20, 1)
    far = HandPath(path.time, path.position + 3.0, path.rotation)
    said = words(swivel_map(ehmcs(), far).plot())
    assert "20 of them without any posture" in said
    assert "out of reach by" in said


def test_a_motion_over_two_branches_has_a_panel_for_each() -> None:
    arm = human()
    path, q = smooth_path(arm, 200, 5, most=2.5, width=0.98)
    map_ = swivel_map(arm, path)
    branch = map_.swivel_of(q).branch
    assert set(branch) == {0, 2}
    figure = map_.plot(q)
    assert len(panels(figure)) == 2
    said = words(figure)
    assert "shoulder abduction -90° to 90°" in said
    assert "shoulder abduction beyond ±90°" in said
    assert "not on this branch" in said
    for axes, one in zip(panels(figure), (0, 2), strict=True):
        drawn = [
            line for line in axes.lines if len(line.get_xdata()) == len(map_) and line.get_linewidth() > 2
        ]
        seen = np.zeros(len(map_), dtype=bool)
        for line in drawn:
            seen |= np.isfinite(np.asarray(line.get_ydata(), float))
        np.testing.assert_array_equal(seen, branch == one)


def test_branches_can_be_chosen() -> None:
    map_ = task_map()
    assert len(panels(map_.plot(branch=0))) == 1
    assert len(panels(map_.plot(TASK.measured, branch=[2, 0, 1]))) == 3
    assert "shoulder flexion beyond" in words(map_.plot(branch=0))
    with pytest.raises(OptionError, match="branch is 8"):
        map_.plot(branch=8)
    with pytest.raises(OptionError, match="branch is 9"):
        map_.plot(branch=[2, 9])
    with pytest.raises(ShapeError):
        map_.plot(TASK.measured.q[1:])


def test_the_whole_circle_has_no_edges() -> None:
    arm = free(ehmcs())
    path, q = smooth_path(ehmcs(), 30, 2)
    map_ = swivel_map(arm, path)
    figure = map_.plot(q)
    words(figure)
    (strip,) = bands_of(map_, 0, -180.0, 180.0).strips
    assert all(strip.whole)
    assert strip.start[0] < -180
    assert strip.end[0] > 180
    assert "limit (180°)" not in words(figure)


def test_a_line_that_goes_around_twice_is_shown_whole() -> None:
    arm = free(ehmcs())
    path, _ = smooth_path(ehmcs(), 200, 2)
    map_ = swivel_map(arm, path)
    turning = np.linspace(0.0, 4 * np.pi, 200)
    q = map_.postures(turning, 0)
    (axes,) = panels(map_.plot(q))
    low, high = axes.get_ylim()
    assert high - low > 720
    psi = into_window(np.rad2deg(map_.swivel_of(q).psi), low, high)
    assert low < psi.min() < psi.max() < high


def test_windows_are_cut_where_nothing_is_and_never_through_a_line() -> None:
    for seed in range(8):
        arm = human()
        path, q = smooth_path(arm, 60, seed, most=2.5, width=0.98)
        map_ = swivel_map(arm, path)
        psi = np.rad2deg(map_.swivel_of(q).psi)
        low, high = window_of(map_, [0, 2], [psi])
        moved = into_window(psi, low, high)
        assert low < moved.min()
        assert moved.max() < high
        assert -180 <= 0.5 * (low + high) <= 180


@pytest.mark.parametrize("n", [2, 3, 5000])
@pytest.mark.parametrize("arm", [ehmcs(), alfaiz()], ids=lambda arm: arm.name)
def test_short_and_long_paths(arm: Arm, n: int) -> None:
    path, q = smooth_path(arm, n, 1)
    figure = swivel_map(arm, path).plot(q)
    words(figure)
    assert f"{n} samples" in words(figure)


def test_long_paths_are_thinned_but_no_stretch_of_blocked_samples_is_lost() -> None:
    arm = ehmcs()
    q = smooth_angles(arm, 4000, 1)
    made = path_of(arm, q)
    position = np.array(made.position)
    position[[1234, 2500, 2501]] += [3.0, 0.0, 0.0]
    map_ = swivel_map(arm, HandPath(made.time, position, made.rotation))
    branch = int(map_.swivel_of(q).branch[0])
    bands = bands_of(map_, branch, -180.0, 180.0)
    assert len(bands.samples) < 1300
    assert {1234, 2500, 2501} <= set(bands.samples.tolist())
    (axes,) = panels(map_.plot(branch=branch))
    assert len([patch for patch in axes.patches if patch.get_hatch()]) >= 2


def test_a_locked_joint_leaves_bands_without_width() -> None:
    arm = human()
    q = smooth_angles(arm, 30, 1)
    q[:, 2] = 0.2
    path = path_of(arm, q)
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[2] = upper[2] = 0.2
    words(swivel_map(arm.with_rom(lower, upper), path).plot(q))


def test_paths_of_positions_and_the_straight_arm_can_be_drawn() -> None:
    arm = ehmcs()
    q = smooth_angles(arm, 25, 3)
    path = path_of(arm, q, turned=False)
    words(swivel_map(arm, path, wrist=q[:, 4:]).plot(q))
    q[:, 3] = 0.0
    words(swivel_map(arm, path_of(arm, q)).plot(q))


def test_the_lines_stay_apart_by_dashes_too() -> None:
    map_ = task_map()
    compare = {f"motion {i}": TASK.measured for i in range(6)}
    (axes,) = panels(map_.plot(TASK.measured, compare=compare))
    styles = {
        (line.get_color(), str(line._dash_pattern), line.get_linewidth())
        for line in axes.lines
        if len(line.get_xdata()) == len(map_) and line.get_linewidth() in (1.4, 2.6)
    }
    assert len({dashes for _, dashes, _ in styles}) >= 5


def test_the_lines_of_the_docs_page_run() -> None:
    page = (Path(__file__).resolve().parent.parent / "docs" / "swivel_map.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    measured = TASK.measured
    names = {"ak": ak, "arm": ehmcs(), "path": TASK.path, "solution": measured, "measured": measured}
    exec(compile(block, "swivel_map.md", "exec"), names)  # noqa: S102 - the page is ours
    assert names["q"].shape == measured.q.shape
