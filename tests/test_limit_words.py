"""Limits in words: the name of the movement that meets them, and its value."""

from __future__ import annotations

import numpy as np
import pytest

from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.limit_words import limit_words, opposite_movement


def test_the_lower_limit_is_that_of_the_opposite_movement() -> None:
    arm = ehmcs()
    said = {
        (name, upper): limit_words(arm, i, upper)
        for i, name in enumerate(arm.joint_names)
        for upper in (False, True)
    }
    assert said["wrist_extension", True] == "wrist extension limit (73°)"
    assert said["wrist_extension", False] == "wrist flexion limit (73°)"
    assert said["forearm_pronation", False] == "forearm supination limit (110°)"
    assert said["shoulder_abduction", False] == "shoulder adduction limit (50°)"
    assert said["shoulder_internal_rotation", False] == "shoulder external rotation limit (45°)"
    assert said["wrist_ulnar_deviation", False] == "wrist radial deviation limit (20°)"
    assert said["elbow_flexion", False] == "elbow extension limit (0°)"
    assert len(set(said.values())) == 14


def test_a_range_without_zero_has_a_least_movement() -> None:
    arm = human()
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    i, j = arm.joint_index("elbow_flexion"), arm.joint_index("shoulder_abduction")
    lower[i], upper[j] = np.deg2rad(35), np.deg2rad(-10)
    narrow = arm.with_rom(lower, upper)
    assert limit_words(narrow, i, upper=False) == "least elbow flexion (35°)"
    assert limit_words(narrow, j, upper=True) == "least shoulder adduction (10°)"


def test_joints_that_are_no_movements_keep_their_names() -> None:
    assert limit_words(alfaiz(), 5, upper=True) == "wrist 2 upper limit (90°)"
    assert limit_words(alfaiz(), 5, upper=False) == "wrist 2 lower limit (-90°)"


@pytest.mark.parametrize("name", [name for arm in (ehmcs(), human()) for name in arm.joint_names])
def test_opposites_go_both_ways(name: str) -> None:
    opposite = opposite_movement(name)
    assert opposite is not None
    assert opposite != name
    assert opposite_movement(opposite) == name


def test_words_that_only_end_alike_are_no_movement() -> None:
    assert opposite_movement("inflexion") is None
