"""The entry point: methods and options by name, with lists of what is valid."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from sample_arms import ARMS
from smooth_motions import smooth_path

import armik_sym as ak
from armik_sym import solving
from armik_sym.errors import ArmikError, LimitError, OptionError, ShapeError, UnknownNameError
from armik_sym.motion.hand_path import HandPath
from armik_sym.trajectory import TrajectoryOptions

ARM = ARMS["ehmcs"]
PATH, _ = smooth_path(ARM, 4, seed=1)


def test_an_unknown_method_lists_the_known():
    with pytest.raises(UnknownNameError, match=r"unknown method 'magic': valid are .*trajectory") as caught:
        ak.solve(ARM, PATH, method="magic")
    assert set(ak.methods()) == set(caught.value.valid)
    assert isinstance(caught.value, ArmikError)
    assert isinstance(caught.value, ValueError)


def test_an_unknown_option_lists_the_known():
    with pytest.raises(
        UnknownNameError, match=r"unknown option of method 'trajectory' 'max_sped'.*max_speed"
    ) as e:
        ak.solve(ARM, PATH, max_sped=1.0)
    assert set(e.value.valid) == {field.name for field in dataclasses.fields(TrajectoryOptions)}


@pytest.mark.parametrize(
    ("error", "options", "words"),
    [
        (ShapeError, {"start": np.zeros(3)}, r"start has shape \(3,\), expected \(7,\)"),
        (LimitError, {"start": np.full(7, 90.0)}, "shoulder_abduction is 90 rad .*radians"),
        (LimitError, {"start": np.full(7, np.nan)}, "shoulder_abduction is nan"),
        (LimitError, {"max_speed": 0}, "max_speed of joint 'shoulder_abduction' is 0"),
        (LimitError, {"max_speed": -1}, "max_speed .* is -1"),
        (LimitError, {"max_speed": [1, 2]}, r"max_speed has shape \(2,\), expected one number or 7"),
        (LimitError, {"max_acceleration": np.zeros(7)}, "max_acceleration of joint"),
        (LimitError, {"max_speed": 1e-9}, "between samples .* the hand moves"),
        (OptionError, {"tracking": "loose"}, "'loose': valid are exact, soft"),
        (OptionError, {"orientation": "up"}, "'up': valid are full, pointing, none"),
        (OptionError, {"speed_weight": -1}, "speed_weight is -1"),
        (OptionError, {"position_sigma": 0}, "position_sigma is 0"),
        (OptionError, {"backend": "gpu"}, "'gpu': valid are auto, c, vm"),
    ],
)
def test_what_makes_no_sense_is_refused(error, options, words):
    with pytest.raises(error, match=words):
        ak.solve(ARM, PATH, **options)


@pytest.mark.parametrize("orientation", ["full", "pointing"])
def test_orientation_without_rotations_is_refused(orientation):
    bare = HandPath(PATH.time, PATH.position)
    with pytest.raises(OptionError, match=rf"'{orientation}' but the path has no rotations"):
        ak.solve(ARM, bare, orientation=orientation)


def test_the_method_gets_everything(monkeypatch):
    seen = {}

    def run(arm, path, options, **more):
        seen.update(more, arm=arm, path=path, options=options)
        return "solution"

    monkeypatch.setitem(solving._METHODS, "trajectory", (TrajectoryOptions, run))
    note = print
    found = ak.solve(ARM, PATH, start=ARM.rom.middle, seed=3, backend="vm", progress=note, max_speed=4.0)
    assert found == "solution"
    assert seen["arm"] is ARM
    assert seen["path"] is PATH
    assert seen["options"] == TrajectoryOptions(max_speed=4.0)
    assert (seen["seed"], seen["backend"], seen["progress"]) == (3, "vm", note)
    assert np.array_equal(seen["start"], ARM.rom.middle)


def test_the_solution_remembers_what_was_asked():
    solution = ak.solve(ARM, PATH, seed=4, max_speed=30.0, position_tolerance=1e-7)
    assert (solution.method, solution.seed) == ("trajectory", 4)
    assert solution.settings["max_speed"] == 30.0
    assert solution.requirements.position_tolerance == 1e-7
    assert np.array_equal(solution.requirements.max_speed, np.full(7, 30.0))
    assert solution.arm is ARM
    assert solution.path is PATH
    assert solution.timing.solve > 0


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (("ehmcs", PATH), {}, r"'ehmcs', expected an Arm.*load_arm.*alfaiz, ehmcs, human"),
        ((ARM, "path.csv"), {}, r"a str, expected a HandPath.*read_path"),
        ((ARM, PATH), {"seed": -1}, r"seed is -1, expected a whole number"),
        ((ARM, PATH), {"seed": 1.5}, r"seed is 1.5, expected a whole number"),
        ((ARM, PATH), {"seed": True}, r"seed is True, expected a whole number"),
    ],
)
def test_arguments_of_the_wrong_kind_are_told_what_was_expected(arguments, options, words):
    with pytest.raises(OptionError, match=words):
        ak.solve(*arguments, **options)


def test_compile_wants_an_arm():
    with pytest.raises(OptionError, match="expected an Arm"):
        ak.compile("ehmcs")
