"""An arm as TOML: read again, it is the same arm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, BARE

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.arm.save_arm import arm_text
from armik_sym.errors import ArmFileError

EVERY = {**ARMS, BARE.name: BARE}
# The distance from one number to the next, relative, and one operation more.
ROUNDING = 5e-16


def assert_same(one: ak.Arm, other: ak.Arm) -> None:
    assert (one.name, one.joint_names, one.chain.convention) == (
        other.name, other.joint_names, other.chain.convention,
    )  # fmt: skip
    assert [(link.joint, link.moves) for link in one.chain.links] == [
        (link.joint, link.moves) for link in other.chain.links
    ]
    assert one.lengths == pytest.approx(dict(other.lengths), rel=ROUNDING, abs=0)
    for key in ("lower", "upper"):
        np.testing.assert_allclose(getattr(one.rom, key), getattr(other.rom, key), rtol=ROUNDING)
    for key in ("pointing_axis", "up", "outward"):
        np.testing.assert_equal(getattr(one, key), getattr(other, key))
    q = np.random.default_rng(3).uniform(-2, 2, (20, one.dof))
    for mine, its in zip(
        hand_pose(one.chain, q, one.lengths), hand_pose(other.chain, q, other.lengths), strict=True
    ):
        np.testing.assert_allclose(mine, its, atol=1e-14)


@pytest.mark.parametrize("name", EVERY)
def test_every_kind_of_arm_comes_back(name: str, tmp_path: Path) -> None:
    arm = EVERY[name]
    assert ak.save_arm(arm, tmp_path / "arm.toml") == tmp_path / "arm.toml"
    back = ak.load_arm(tmp_path / "arm.toml")
    assert_same(back, arm)
    assert back.description == " ".join(arm.description.split())


LIMIT = st.floats(-4 * np.pi, 4 * np.pi)
LENGTH = st.floats(0.0, 5.0)


@given(st.lists(st.tuples(LIMIT, LIMIT).map(sorted), min_size=7, max_size=7), LENGTH, LENGTH, LENGTH)
def test_any_lengths_and_limits_come_back(tmp_path_factory, limits, upper_arm, forearm, hand) -> None:
    lower, upper = np.transpose(limits)
    arm = ak.catalog.human(upper_arm, forearm, hand).with_rom(lower, upper)
    file = ak.save_arm(arm, tmp_path_factory.mktemp("arm") / "any.toml")
    assert_same(ak.load_arm(file), arm)


@given(st.text())
def test_any_description_can_be_written_and_read(tmp_path_factory, words) -> None:
    arm = replace(BARE, description=words)
    back = ak.load_arm(ak.save_arm(arm, tmp_path_factory.mktemp("arm") / "any.toml"))
    assert back.description.split() == words.split()


def test_numbers_are_short_where_people_wrote_them_short() -> None:
    text = arm_text(ak.catalog.human(0.3, 0.2517, 0.08))
    assert "upper_arm = 300\n" in text
    assert "forearm = 251.7\n" in text
    assert "alpha = -90\n" in text


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(ArmFileError, match="there is no folder"):
        ak.save_arm(BARE, tmp_path / "none" / "arm.toml")
