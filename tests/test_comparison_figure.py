"""The figure of a comparison: what it shows, and that it says so."""

from __future__ import annotations

import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from sample_arms import ARMS
from smooth_motions import smooth_angles
from solutions import of_motion

import armik_sym as ak
from armik_sym.motion import JointMotion
from armik_sym.report import save_figure


def words(figure):
    figure.canvas.draw()
    texts = [*figure.texts, *(text for legend in figure.legends for text in legend.get_texts())]
    for axes in figure.axes:
        texts += [*axes.texts, axes.title, axes._left_title, axes._right_title]
    return "\n".join(text.get_text() for text in texts)


def comparison(name="human", apart_deg=3.0):
    arm = ARMS[name]
    q = smooth_angles(arm, 50, 2)
    return ak.compare(of_motion(arm, q), q - np.deg2rad(apart_deg))


@pytest.mark.parametrize("name", ["human", "ehmcs", "ehmcs_5", "custom_modified", "custom_standard"])
def test_each_quantity_has_two_panels_with_units_and_the_same_time(name):
    arm = ARMS.get(name) or ak.catalog.ehmcs(5)
    q = smooth_angles(arm, 50, 2)
    c = ak.compare(of_motion(arm, q), q - 0.01)
    figure = c.plot(title="a motion")
    expected = arm.dof + 2 * (c.swivel is not None)
    assert len(figure.axes) == 2 * expected
    for upper, lower in zip(figure.axes[::2], figure.axes[1::2], strict=True):
        assert re.search(r"\[(deg|mm)\]$", upper.get_ylabel())
        assert re.search(r"\[(deg|mm)\]$", lower.get_ylabel())
        assert lower.get_xlabel() == "time [s]"
        assert upper.get_xlim() == lower.get_xlim()
    text = words(figure)
    assert text.startswith("a motion: arm ")
    for name_ in arm.joint_names:
        assert name_.replace("_", " ").capitalize() in text


def test_solved_is_a_line_and_measured_a_broken_one_so_that_grey_prints_tell_them_apart():
    c = comparison()
    figure = c.plot()
    solved, measured, *_ = figure.axes[0].lines
    assert solved.get_linestyle() == "-"
    assert measured.get_linestyle() != "-"
    np.testing.assert_allclose(solved.get_ydata(), np.rad2deg(c.q[:, 0]))
    np.testing.assert_allclose(measured.get_ydata(), np.rad2deg(c.measured[:, 0]))
    text = words(figure)
    assert "solved, method by hand" in text
    assert "measured" in text
    assert "range of motion of the arm" in text
    assert "mean 3.0, max 3.0 deg" in text


def test_differences_of_angles_have_one_scale():
    arm = ARMS["human"]
    q = smooth_angles(arm, 50, 2)
    measured = q.copy()
    measured[:, 2] += np.deg2rad(30)
    figure = ak.compare(of_motion(arm, q), measured).plot()
    scales = {axes.get_ylim() for axes in figure.axes[1:16:2]}
    assert len(scales) == 1
    assert next(iter(scales))[1] > 30


def test_notes_and_verdict_are_on_the_page():
    arm = ARMS["human"]
    q = smooth_angles(arm, 50, 2)
    measured = q.copy()
    measured[5:9] = np.nan
    solution = of_motion(arm, q, max_speed=1e-3)
    text = words(ak.compare(solution, measured).plot())
    assert "missing at 4 of 50 samples" in text
    assert "Solution not ok: " in text


def test_no_line_of_the_head_leaves_the_page():
    arm = ARMS["human"]
    q = smooth_angles(arm, 50, 2)
    solution = of_motion(arm, q, max_speed=1e-3, max_acceleration=1e-3)
    measured = q.copy()
    measured[5:9] = np.nan
    figure = ak.compare(solution, measured).plot(title="drinking from a full cup")
    FigureCanvasAgg(figure).draw()
    lines = [text.get_window_extent() for text in figure.texts]
    assert len(lines) > 4
    assert max(line.x1 for line in lines) < figure.bbox.x1


def test_nothing_measured_of_a_joint_and_one_sample_can_be_drawn(tmp_path):
    arm = ARMS["human"]
    q = smooth_angles(arm, 50, 2)
    measured = q.copy()
    measured[:, 0] = np.nan
    assert "no measured sample" in words(ak.compare(of_motion(arm, q), measured).plot())
    one = JointMotion([0.0], q[:1], arm.joint_names)
    c = ak.compare(of_motion(arm, q), one)
    assert len(c.time) == 1
    assert save_figure(c.plot(), tmp_path / "one.png").stat().st_size > 1000


def test_pyplot_is_left_alone():
    comparison().plot()
    import matplotlib.pyplot as plt

    assert plt.get_fignums() == []
