"""Symbolic kinematics of whole arms."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from sample_arms import ARMS, postures
from scipy.spatial.transform import Rotation

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.errors import OptionError
from armik_sym.symbolic import express


def _rows(f: ca.Function, q: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    return np.array([np.array(f(x, lengths)) for x in q])


@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_pose_equals_the_product_of_transforms(arm):
    q = postures(arm, 50)
    p, R = hand_pose(arm.chain, q, arm.lengths)
    for mode in ("parameter", "baked"):
        symbols = express(arm, mode)
        lengths = arm.length_values if mode == "parameter" else np.empty(0)
        np.testing.assert_allclose(_rows(symbols.function("position"), q, lengths)[..., 0], p, atol=1e-12)
        np.testing.assert_allclose(_rows(symbols.function("rotation"), q, lengths), R, atol=1e-12)
        T = _rows(symbols.function("pose"), q, lengths)
        np.testing.assert_allclose(T[:, :3, 3], p, atol=1e-12)
        assert np.all(T[:, 3] == [0, 0, 0, 1])


@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_frames_equal_the_product_of_transforms(arm):
    symbols = express(arm)
    f = ca.Function("f", [symbols.q, symbols.lengths], list(symbols.frames))
    q = postures(arm, 1)
    for T, wanted in zip(
        f(q[0], arm.length_values), joint_frames(arm.chain, q, arm.lengths)[0], strict=False
    ):
        np.testing.assert_allclose(np.array(T), wanted, atol=1e-13)


def _vector_of(representation: str, R: np.ndarray) -> np.ndarray:
    turn = Rotation.from_matrix(R)
    if representation == "roll_pitch_yaw":
        return turn.as_euler("xyz")
    if representation == "quaternion":
        x, y, z, w = turn.as_quat(canonical=True)
        return np.array([w, x, y, z])
    return R.ravel()


@pytest.mark.parametrize("representation", ["roll_pitch_yaw", "quaternion", "matrix"])
@pytest.mark.parametrize("name", ["ehmcs", "alfaiz", "custom_standard"])
def test_analytic_jacobian_equals_differences_of_scipy(name, representation):
    arm = ARMS[name]
    symbols = express(arm, "baked")
    f = ca.Function("f", [symbols.q], [symbols.analytic_jacobian(representation)])
    h = 1e-6
    for q in postures(arm, 30, seed=3):
        columns = []
        for step in np.eye(arm.dof) * h:
            p, R = hand_pose(arm.chain, np.stack([q + step, q - step]), arm.lengths)
            ahead, behind = (np.r_[p[k], _vector_of(representation, R[k])] for k in (0, 1))
            columns.append((ahead - behind) / (2 * h))
        wanted = np.stack(columns, axis=1)
        if np.abs(wanted).max() < 50:  # not next to the representation's own singularity or seam
            np.testing.assert_allclose(np.array(f(q)), wanted, atol=2e-6)


def test_default_analytic_jacobian_is_that_of_roll_pitch_yaw():
    assert express(ehmcs()).function("analytic_jacobian").size_out(0) == (6, 7)
    assert express(ehmcs()).function("jacobian").size_out(0) == (6, 7)


def test_baked_lengths_leave_no_symbols():
    symbols = express(human(), "baked")
    assert symbols.lengths.numel() == 0
    assert len(ca.symvar(symbols.T_base_hand)) == 7


def test_unknown_words_are_named():
    symbols = express(ehmcs())
    with pytest.raises(OptionError, match=r"'pos' is unknown: valid are pose, position"):
        symbols.function("pos")
    with pytest.raises(OptionError, match=r"'euler' is unknown: valid are roll_pitch_yaw"):
        symbols.analytic_jacobian("euler")
    with pytest.raises(OptionError, match=r"lengths is 'fixed', expected 'parameter' or 'baked'"):
        express(ehmcs(), "fixed")  # type: ignore[arg-type]
