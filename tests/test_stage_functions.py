"""One sample's tracking equations: right values, exact derivatives, C and virtual machine alike."""

from __future__ import annotations

import numpy as np
import pytest
from compiled_helpers import needs_cc
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation
from smooth_motions import path_of

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.stage_functions import compile_stage
from armik_sym.errors import OptionError
from armik_sym.symbolic import Orientation
from armik_sym.trajectory.targets import stage_targets

NAMES = sorted(ARMS)


def targets_of(arm, q, orientation):
    return stage_targets(arm, path_of(arm, np.vstack([q, q])), orientation)[0]


def flat(value):
    return np.asarray(value).ravel()


@pytest.mark.parametrize("orientation", Orientation)
@pytest.mark.parametrize("name", NAMES)
def test_derivatives_equal_finite_differences(name, orientation):
    arm = ARMS[name]
    stage = compile_stage(arm, orientation, "vm")
    q, aim = postures(arm, 2, 5)
    q = aim + 0.3 * (q - aim)
    target, m, h = targets_of(arm, aim, orientation), orientation.equations, 1e-6
    multipliers = np.random.default_rng(0).normal(size=m)

    def residual(at):
        return flat(stage.residual(at, arm.length_values, target))

    def jacobian(at):
        return flat(stage.jacobian(at, arm.length_values, target)).reshape(arm.dof, m).T

    steps = h * np.eye(arm.dof)
    differences = np.array([(residual(q + s) - residual(q - s)) / (2 * h) for s in steps]).T
    np.testing.assert_allclose(jacobian(q), differences, rtol=1e-6, atol=1e-8)
    hessian = flat(stage.hessian(q, arm.length_values, target, multipliers)).reshape(arm.dof, arm.dof)
    differences = np.array([(jacobian(q + s) - jacobian(q - s)).T @ multipliers / (2 * h) for s in steps])
    np.testing.assert_allclose(hessian, differences, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-12)


@settings(max_examples=30)
@given(name=st.sampled_from(NAMES), seed=st.integers(0, 10**6))
def test_full_residual_is_twice_the_tangent_of_half_the_angle(name, seed):
    arm = ARMS[name]
    q, aim = postures(arm, 2, seed)
    stage = compile_stage(arm, Orientation.FULL, "vm")
    r = flat(stage.residual(q, arm.length_values, targets_of(arm, aim, Orientation.FULL)))
    p, R = hand_pose(arm.chain, np.array([q, aim]), arm.lengths)
    np.testing.assert_allclose(r[:3], p[0] - p[1], atol=1e-13)
    turn = Rotation.from_matrix(R[1].T @ R[0]).as_rotvec()
    angle = np.linalg.norm(turn)
    if 1e-6 < angle < 3.0:
        np.testing.assert_allclose(r[3:], 2 * np.tan(angle / 2) * turn / angle, rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("turn", [0.1, 1.0, 3.0])
def test_pointing_residual_ignores_turns_about_the_fingers_only(turn):
    arm = ARMS["human"]
    stage = compile_stage(arm, Orientation.POINTING, "vm")
    q = postures(arm, 2, 3)
    path = path_of(arm, q)
    for axis, zero in ((arm.pointing_axis, True), (np.cross(arm.pointing_axis, [0.36, 0.48, 0.8]), False)):
        wanted = path.rotation @ Rotation.from_rotvec(turn * axis / np.linalg.norm(axis)).as_matrix()
        target = stage_targets(arm, type(path)(path.time, path.position, wanted), Orientation.POINTING)[0]
        size = np.linalg.norm(flat(stage.residual(q[0], arm.length_values, target)))
        assert size == pytest.approx(0 if zero else 2 * np.tan(turn / 2), rel=1e-6, abs=1e-12)


@needs_cc
@pytest.mark.parametrize("orientation", Orientation)
@pytest.mark.parametrize("name", ["ehmcs", "alfaiz", "custom_standard"])
def test_compiled_code_and_virtual_machine_agree(name, orientation):
    arm = ARMS[name]
    c, vm = (compile_stage(arm, orientation, backend) for backend in ("c", "vm"))
    assert (c.backend, vm.backend) == ("c", "vm")
    assert vm.compile_time == 0
    lengths = 1.1 * arm.length_values
    multipliers = np.linspace(-1, 1, orientation.equations)
    for q, aim in postures(arm, 10, 7, stretch=1.5).reshape(5, 2, -1):
        at = (aim + 0.2 * (q - aim), lengths, targets_of(arm, aim, orientation))
        for mine, other in (
            (c.residual(*at), vm.residual(*at)),
            (c.jacobian(*at), vm.jacobian(*at)),
            (c.hessian(*at, multipliers), vm.hessian(*at, multipliers)),
        ):
            np.testing.assert_allclose(flat(mine), flat(other), rtol=1e-11, atol=1e-12)


def test_arms_of_one_structure_share_their_functions():
    arm = ARMS["human"]
    other = arm.with_lengths(forearm=0.2).with_rom(arm.rom.lower / 2, arm.rom.upper / 2)
    assert compile_stage(arm, Orientation.NONE, "vm") is compile_stage(other, Orientation.NONE, "vm")
    assert compile_stage(arm, Orientation.NONE, "vm") is not compile_stage(arm, Orientation.FULL, "vm")
    assert compile_stage(arm, Orientation.NONE, "vm") is not compile_stage(
        ARMS["ehmcs"], Orientation.NONE, "vm"
    )


def test_unknown_backend():
    with pytest.raises(OptionError, match="valid are auto, c, vm"):
        compile_stage(ARMS["bare" if "bare" in ARMS else "human"], Orientation.NONE, "gpu")
