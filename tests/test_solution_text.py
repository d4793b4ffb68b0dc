"""The printed summary: verdict first, degrees and millimetres, reasons, and never an exception."""

from __future__ import annotations

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import path_of, smooth_angles
from solutions import of_motion

from armik_sym.motion.hand_path import HandPath
from armik_sym.solution import Timing
from armik_sym.symbolic import Orientation

ARM = ARMS["human"]


def test_summary_of_a_good_solution():
    q = smooth_angles(ARM, 9, 0)
    solution = of_motion(ARM, q, status="Solve_Succeeded", iterations=17, timing=Timing(0.5, 0.25, 2.0))
    lines = str(solution).splitlines()
    assert lines[0] == "ok: arm human, 9 samples over 4 s, method by hand"
    text = str(solution)
    margin = np.rad2deg(solution.rom_margin)
    assert f"{margin.min():.3g}° at the least ({ARM.joint_names[np.argmin(margin)]})" in text
    step = np.rad2deg(solution.max_step)
    assert f"{step.max():.3g}° ({ARM.joint_names[np.argmax(step)]})" in text
    assert f"{np.rad2deg(solution.max_speed.max()):.3g}°/s" in text
    assert f"{np.rad2deg(solution.arc_length):.4g}°" in text
    for words in (
        "mm, rotation",
        "Solve_Succeeded, 17 iterations",
        "build 0.5 s",
        "compile 0.25 s",
        "solve 2 s",
    ):
        assert words in text
    assert "because" not in text


def test_summary_of_a_bad_solution_gives_the_reasons():
    q = smooth_angles(ARM, 9, 0)
    path = path_of(ARM, q)
    far = HandPath(path.time, path.position + np.array([0.03, 0, 0]), path.rotation)
    solution = of_motion(ARM, q, path=far, max_speed=1e-2)
    text = str(solution)
    assert text.startswith("NOT ok: ")
    assert "30 mm" in text
    for reason in solution.reasons:
        assert f"because         {reason}" in text


def test_rotation_is_left_out_where_it_is_not_tracked():
    solution = of_motion(ARM, smooth_angles(ARM, 9, 0), orientation=Orientation.NONE)
    assert "rotation " not in str(solution).splitlines()[1]


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("everywhere", [False, True])
def test_angles_that_are_not_finite_print_all_the_same(bad, everywhere):
    q = smooth_angles(ARM, 5, 0)
    path = path_of(ARM, q)
    q[slice(None) if everywhere else 3] = bad
    assert "NOT ok" in str(of_motion(ARM, q, path=path))
