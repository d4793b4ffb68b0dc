"""Figures: units on every axis, honest titles, nothing left open."""

from __future__ import annotations

import re
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from armik_sym.arm import Arm, DHChain, DHLink, JointType, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.errors import MotionFileError
from armik_sym.motion import HandPath
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report import hand_path_figure, save_figure, solution_figure
from armik_sym.report.stick_figure import stick_figure
from armik_sym.report.words import at_most, plain, power_of_ten
from armik_sym.solution import Requirements, Solution
from armik_sym.symbolic import Orientation

UNIT = re.compile(r"\[(s|deg|mm|deg/s|mm/s)\]")
SLIDER = Arm(
    "slider",
    DHChain((DHLink("lift", joint=JointType.PRISMATIC), DHLink("swing", a=0.3))),
    RangeOfMotion(np.array([0.0, -1.0]), np.array([0.5, 1.0])),
)


def made(arm, orientation=Orientation.FULL, tolerance=1e-9, drift=0.0, n=40, swing=0.2):
    """A solution without any solver: a smooth motion and the path it makes."""
    time = np.linspace(0.0, 2.0, n)
    q = arm.rom.middle + swing * arm.rom.width * np.sin(time[:, None] + np.arange(arm.dof)) / 2
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    path = HandPath(time, position, None if orientation is Orientation.NONE else rotation)
    free = np.full(arm.dof, np.inf)
    need = Requirements(tolerance, tolerance, free, free)
    return Solution(arm, path, q + drift * time[:, None], "trajectory", orientation, need)


def words(figure):
    """All text of a figure, drawn once so that matplotlib has filled it in."""
    figure.canvas.draw()
    texts = [*figure.texts, *([figure._suptitle] if figure._suptitle else [])]
    for axes in figure.axes:
        texts += [*axes.texts, axes.title, axes._left_title, axes._right_title]
        legend = axes.get_legend()
        texts += legend.get_texts() if legend else []
    return "\n".join(text.get_text() for text in texts)


@pytest.mark.parametrize("draw", [solution_figure, hand_path_figure])
@pytest.mark.parametrize("arm", [ehmcs(), ehmcs(4), human(), alfaiz(), SLIDER], ids=lambda arm: arm.name)
def test_every_axis_has_a_unit_and_pyplot_knows_nothing(draw, arm):
    figure = draw(made(arm))
    shown = [axes for axes in figure.axes if axes.axison]
    assert len(shown) >= 2
    for axes in shown:
        assert UNIT.search(axes.get_xlabel())
        assert UNIT.search(axes.get_ylabel())
    assert "Verdict: ok" in words(figure)
    pyplot = __import__("sys").modules.get("matplotlib.pyplot")
    assert pyplot is None or pyplot.get_fignums() == []


@pytest.mark.parametrize("draw", [solution_figure, hand_path_figure])
def test_the_note_is_on_the_figure(draw):
    figure = draw(made(ehmcs()), title="Drinking", note="Synthetic data")
    assert "Drinking" in words(figure)
    assert "Synthetic data" in words(figure)


def test_one_panel_per_joint_with_its_range_of_motion():
    arm = ehmcs()
    figure = solution_figure(made(arm))
    assert len([axes for axes in figure.axes if axes.axison]) == arm.dof + 3
    for i, axes in enumerate(figure.axes[: arm.dof]):
        drawn = {float(y) for line in axes.lines if len(set(line.get_ydata())) == 1 for y in line.get_ydata()}
        for limit in np.rad2deg([arm.rom.lower[i], arm.rom.upper[i]]):
            assert any(abs(limit - y) < 1e-9 for y in drawn)
        low, high = axes.get_ylim()
        assert low < np.rad2deg(arm.rom.lower[i]) < np.rad2deg(arm.rom.upper[i]) < high


def test_the_lines_are_the_solved_and_the_measured_angles_by_name():
    arm = ehmcs()
    solution = made(arm)
    measured = JointMotion(solution.time, solution.q[:, ::-1] + 0.1, arm.joint_names[::-1])
    figure = solution_figure(solution, measured)
    for i in range(arm.dof):
        lines = {line.get_label(): line for line in figure.axes[i].lines}
        np.testing.assert_allclose(lines["solved"].get_ydata(), np.rad2deg(solution.q[:, i]))
        np.testing.assert_allclose(lines["measured"].get_ydata(), np.rad2deg(solution.q[:, i] + 0.1))
    assert "measured" in words(figure)
    assert "measured" not in words(solution_figure(solution))


def test_a_joint_that_was_not_measured_is_drawn_without_measurement():
    solution = made(ehmcs())
    measured = JointMotion(solution.time, solution.q[:, :5], ehmcs().joint_names[:5])
    figure = solution_figure(solution, measured)
    labels = [[line.get_label() for line in axes.lines] for axes in figure.axes[:7]]
    assert ["measured" in label for label in labels] == [True] * 5 + [False] * 2


def test_a_bad_solution_says_so_and_why():
    bad = made(ehmcs(), drift=0.5)
    assert not bad.ok
    said = words(solution_figure(bad))
    assert "NOT ok" in said
    assert "position error" in said
    assert "outside by" in said
    assert "NOT ok" in words(hand_path_figure(bad))
    assert "the path asked for" in words(hand_path_figure(bad))


def test_errors_of_rounding_are_drawn_on_a_logarithmic_scale_and_others_not():
    exact = solution_figure(made(ehmcs()))
    assert [axes.get_yscale() for axes in exact.axes[-3:]] == ["log", "log", "linear"]
    drifted = solution_figure(made(ehmcs(), drift=0.01, tolerance=np.inf))
    assert [axes.get_yscale() for axes in drifted.axes[-3:]] == ["linear"] * 3
    assert len(solution_figure(made(ehmcs(), Orientation.NONE)).axes) == len(exact.axes) - 1


def test_directions_are_named_only_where_the_arm_says_which_they_are():
    named = "".join(axes.get_xlabel() + axes.get_ylabel() for axes in hand_path_figure(made(human())).axes)
    assert "forward" in named
    assert "up" in named
    plain_axes = hand_path_figure(made(alfaiz())).axes
    assert [axes.get_xlabel() for axes in plain_axes] == ["x [mm]", "x [mm]"]
    assert [axes.get_ylabel() for axes in plain_axes] == ["y [mm]", "z [mm]"]


def test_the_views_have_equal_axes_and_show_the_path():
    solution = made(ehmcs(), swing=0.6)
    figure = hand_path_figure(solution)
    figure.canvas.draw()
    p = 1000 * solution.path.position
    for axes, (across, up) in zip(figure.axes, [(2, 0), (1, 2)], strict=True):
        box = axes.bbox
        (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
        assert box.width / (x1 - x0) == pytest.approx(box.height / (y1 - y0), rel=1e-6)
        assert any(
            len(line.get_xdata()) == len(p) and np.allclose(line.get_xydata(), p[:, [across, up]])
            for line in axes.lines
        )


def test_a_hand_that_stands_still_can_be_drawn():
    arm = ehmcs()
    still = made(arm, swing=0.0, n=2)
    save_both = [solution_figure(still), hand_path_figure(still)]
    for figure in save_both:
        figure.canvas.draw()


def test_the_stick_figure_has_shoulder_elbow_and_wrist_where_the_arm_has_them():
    q = np.zeros((1, 7))
    device = stick_figure(ehmcs(), q)
    assert device.names == ("shoulder", "elbow", "wrist")
    np.testing.assert_allclose(
        device.points[0], [[0, 0, 0.143], [-0.2869, 0, 0.143], [-0.6229, 0, 0.143]], atol=1e-12
    )
    person = stick_figure(human(upper_arm=0.3, forearm=0.25, hand=0.1), q)
    assert person.names == ("shoulder", "elbow", "wrist", "hand")
    np.testing.assert_allclose(np.linalg.norm(np.diff(person.points[0], axis=0), axis=1), [0.3, 0.25, 0.1])
    figure = stick_figure(alfaiz(upper_arm=0.3, forearm=0.2), np.full((1, 7), 0.3))
    np.testing.assert_allclose(np.linalg.norm(np.diff(figure.points[0], axis=0), axis=1), [0.3, 0.2])
    assert stick_figure(SLIDER, np.full((1, 2), 0.2)).names == ("base", "", "hand")


@pytest.mark.parametrize("ending", [".png", ".pdf", ".svg"])
def test_the_same_figure_gives_the_same_file_and_settings_stay(tmp_path, ending):
    before = dict(mpl.rcParams)
    files = [save_figure(hand_path_figure(made(ehmcs())), tmp_path / f"{i}{ending}") for i in (1, 2)]
    assert files[0].read_bytes() == files[1].read_bytes()
    assert dict(mpl.rcParams) == before


def test_text_in_svg_stays_text(tmp_path):
    file = save_figure(hand_path_figure(made(ehmcs()), note="Synthetic"), tmp_path / "hand.svg")
    assert "Synthetic" in file.read_text(encoding="utf-8")


def test_files_that_cannot_be_written_are_refused(tmp_path):
    figure = hand_path_figure(made(ehmcs()))
    with pytest.raises(MotionFileError, match=r"valid are \.pdf, \.png, \.svg"):
        save_figure(figure, tmp_path / "hand.xyz")
    with pytest.raises(MotionFileError, match="cannot be written"):
        save_figure(figure, tmp_path / "no" / "hand.png")


def test_solution_plot_draws_the_solution_figure():
    solution = made(ehmcs())
    assert len(solution.plot().axes) == len(solution_figure(solution).axes)


def test_limits_that_leave_no_room_can_be_drawn():
    arm = ehmcs()
    fixed = arm.with_rom(arm.rom.middle, arm.rom.middle)
    solution_figure(replace(made(arm, swing=0.0), arm=fixed)).canvas.draw()


def test_numbers_in_words():
    assert at_most(3e-9, "mm") == "below 0.000001 mm"
    assert at_most(223.6, "mm") == "at most 224 mm"
    assert plain(5.73e-8) == "0.00000006"
    assert [power_of_ten(x) for x in (1e-9, 100.0, 0.0)] == ["10⁻⁹", "10²", ""]
