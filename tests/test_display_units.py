"""Joint values in the units people read."""

from __future__ import annotations

import csv

import numpy as np
import pytest

import armik_sym as ak
from armik_sym.arm.display_units import joint_unit, joint_units


def slider() -> ak.Arm:
    """A turning joint with a sliding one behind it."""
    rows = (
        ak.DHLink("turn", alpha=-np.pi / 2),
        ak.DHLink("slide", joint=ak.JointType.PRISMATIC),
    )
    rom = ak.RangeOfMotion(np.array([-2.0, 0.1]), np.array([2.0, 0.9]))
    return ak.Arm("slider", ak.DHChain(rows), rom)


def test_angles_are_degrees_and_slides_are_millimetres() -> None:
    turn, slide = joint_units(slider())
    assert (turn.name, slide.name) == ("deg", "mm")
    assert turn.text(np.pi / 2) == "90°"
    assert slide.text(0.33, per="/s") == "330 mm/s"
    assert joint_unit(ak.catalog.ehmcs(), 3).factor == pytest.approx(180 / np.pi)


def test_files_and_text_of_a_sliding_joint_are_in_millimetres(tmp_path) -> None:
    arm = slider()
    time = np.linspace(0, 1, 20)
    q = np.stack([0.5 * np.sin(time), 0.33 + 0.1 * time], axis=1)
    path = ak.HandPath(time, ak.compile(arm).position(q))
    solution = ak.solve(arm, path, orientation="none", tracking="soft", position_sigma=1e-5)
    lines = [line for line in solution.save(tmp_path / "s.csv").read_text().splitlines() if line[0] != "#"]
    rows = list(csv.DictReader(lines))
    assert float(rows[-1]["slide [mm]"]) == pytest.approx(1000 * solution.q[-1, 1], rel=1e-12)
    assert float(rows[-1]["turn [deg]"]) == pytest.approx(np.rad2deg(solution.q[-1, 0]), rel=1e-12)
    assert " mm at the least (slide)" in str(solution) or "° at the least (turn)" in str(solution)


def test_a_start_outside_a_slide_is_told_in_millimetres() -> None:
    arm = slider()
    path = ak.HandPath([0, 1], [[0, 0.3, 0], [0, 0.31, 0]])
    with pytest.raises(ak.ArmikError, match=r"slide is 0.95 m \(950 mm\).*0.1 to 0.9 m \(100 mm to 900 mm\)"):
        ak.solve(arm, path, start=[0.0, 0.95], tracking="soft")
