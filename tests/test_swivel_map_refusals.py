"""What the swivel map refuses, and what it says of itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import armik_sym as ak
from armik_sym.arm.catalog import ehmcs, human
from armik_sym.errors import ArmModelError, LimitError, OptionError, ShapeError
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.swivel.map import swivel_map


def test_what_cannot_be_mapped_is_refused_with_the_reason() -> None:
    arm, path = ehmcs(), ak.load_task("brushing").path
    with pytest.raises(ArmModelError, match=r"5 joints: shoulder, elbow and spherical wrist make 7"):
        swivel_map(ehmcs(5), path)
    with pytest.raises(OptionError, match=r"no rotation.*wrist="):
        swivel_map(arm, HandPath(path.time, path.position))
    with pytest.raises(OptionError, match="expected an Arm"):
        swivel_map("ehmcs", path)  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="expected a HandPath"):
        swivel_map(arm, path.position)  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match="expected a direction"):
        swivel_map(arm, path, reference=np.ones((len(path), 3)))
    with pytest.raises(OptionError, match="no length"):
        swivel_map(arm, path, reference=[0, 0, 0])
    with pytest.raises(OptionError, match="expected a direction"):
        swivel_map(arm, path, reference="up")
    with pytest.raises(OptionError, match="backend"):
        swivel_map(arm, path, backend="fortran")  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match=r"expected \(3,\) or \(601, 3\)"):
        swivel_map(arm, path, wrist=[0, 0])
    with pytest.raises(LimitError, match=r"wrist_ulnar_deviation is 60° at sample 0.*-20° to 40°"):
        swivel_map(arm, path, wrist=[0, 0, np.deg2rad(60)])
    with pytest.raises(LimitError, match="nan"):
        swivel_map(arm, path, wrist=[0, 0, np.nan])


def test_questions_that_do_not_fit_are_refused() -> None:
    task = ak.load_task("brushing")
    map_ = swivel_map(ehmcs(), task.path)
    for branch in (8, -1, 1.5, True, "elbow"):
        with pytest.raises(OptionError, match=r"expected 0 to 7 \(0: shoulder flexion beyond"):
            map_.clearance([0.0], branch)  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match=r"expected \(601, 7\)"):
        map_.swivel_of(task.measured.q[:-1])
    with pytest.raises(ShapeError, match="no joint 'wrist_extension'"):
        map_.swivel_of(JointMotion(task.measured.time, task.measured.q[:, :5], task.measured.joint_names[:5]))
    with pytest.raises(ShapeError):
        map_.postures(0.0, 8)


def test_the_map_says_what_it_is() -> None:
    map_ = ak.swivel_map(ak.catalog.ehmcs(), ak.load_task("brushing").path)
    assert isinstance(map_, ak.SwivelMap)
    assert repr(map_) == "SwivelMap(arm ehmcs, 601 samples, 0 blocked)"
    assert len(map_) == 601
    with pytest.raises(AttributeError):
        map_.arm = human()  # type: ignore[misc]
    assert replace(map_, backend="vm").backend == "vm"
