"""One damped step: against scipy's bounded least squares, and the rotation residual against scipy."""

from __future__ import annotations

import ctypes
from collections.abc import Callable

import numpy as np
import pytest
from damped_helpers import compiled
from scipy.optimize import lsq_linear
from scipy.spatial.transform import Rotation

from armik_sym.arm.catalog import human
from armik_sym.motion.rotation_vector import rotation_vector
from armik_sym.pointwise.damped.bounded_step import bounded_step
from armik_sym.pointwise.damped.pose_residual import printed_rotation_residual

DOF = 7
HUMAN = human()

Step = Callable[[np.ndarray, np.ndarray, float, np.ndarray, np.ndarray, np.ndarray], np.ndarray]
Residual = Callable[[np.ndarray, bool], np.ndarray]


def address(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def in_c(J, e, damping, q, lower, upper):
    arrays = [np.ascontiguousarray(a, dtype=np.float64) for a in (J, e, q, lower, upper)]
    d = np.full(DOF, np.nan)
    rounds = compiled(HUMAN).library.handle.damped_step_once(
        address(arrays[0]),
        address(arrays[1]),
        ctypes.c_int(len(e)),
        ctypes.c_double(damping),
        *(address(a) for a in arrays[2:]),
        address(d),
    )
    assert 1 <= rounds < 4 * DOF
    return d


def in_numpy(J, e, damping, q, lower, upper):
    d = bounded_step(J, e, damping, lower - q, upper - q)
    assert d is not None
    return d


def residual_in_c(E, printed):
    E, out = np.ascontiguousarray(E), np.full(3, np.nan)
    compiled(HUMAN).library.handle.rotation_residual(address(E), ctypes.c_int(printed), address(out))
    return out


def residual_in_numpy(E, printed):
    return printed_rotation_residual(E) if printed else rotation_vector(E)


both_steps = pytest.mark.parametrize("step", [in_c, in_numpy])
both_residuals = pytest.mark.parametrize("residual", [residual_in_c, residual_in_numpy])


def problem(rng: np.random.Generator, kind: str) -> tuple[np.ndarray, ...]:
    m = 3 if kind == "position" else 6
    J, e = rng.normal(size=(m, DOF)), rng.normal(size=m)
    if kind == "singular":
        J = J[:, :2] @ rng.normal(size=(2, DOF))
    width = 100.0 if kind == "wide" else 0.4
    lower, upper = -width * rng.uniform(0.1, 1, DOF), width * rng.uniform(0.1, 1, DOF)
    q = rng.uniform(lower, upper)
    if kind == "at limits":
        q = np.where(rng.uniform(size=DOF) < 0.7, rng.choice([lower, upper], axis=0), q)
    return J, e, q, lower, upper


@both_steps
@pytest.mark.parametrize("kind", ["wide", "narrow", "at limits", "singular", "position"])
@pytest.mark.parametrize("damping", [1e-6, 1e-2, 1.0])
def test_step_is_the_bounded_minimum(step: Step, kind: str, damping: float) -> None:
    rng = np.random.default_rng(1)
    active = 0
    for _ in range(40):
        J, e, q, lower, upper = problem(rng, kind)
        d = step(J, e, damping, q, lower, upper)
        A, b = np.vstack([J, np.sqrt(damping) * np.eye(DOF)]), np.concatenate([e, np.zeros(DOF)])
        wanted = lsq_linear(A, b, (lower - q - 1e-15, upper - q + 1e-15), method="bvls", tol=1e-14)
        assert np.sum((A @ d - b) ** 2) <= 2 * wanted.cost * (1 + 1e-9) + 1e-14
        np.testing.assert_allclose(d, wanted.x, atol=1e-7 / np.sqrt(damping))
        assert (q + d >= lower - 1e-15).all()
        assert (q + d <= upper + 1e-15).all()
        active += np.any((d == lower - q) | (d == upper - q))
    assert (active == 0) if kind == "wide" and damping == 1.0 else (kind == "wide" or active > 20)


@both_steps
def test_joints_that_cannot_move_stay(step: Step) -> None:
    rng = np.random.default_rng(2)
    J, e, q, lower, upper = problem(rng, "narrow")
    lower[[1, 4]] = upper[[1, 4]] = q[[1, 4]]
    d = step(J, e, 1e-3, q, lower, upper)
    assert (d[[1, 4]] == 0).all()
    free = np.delete(np.arange(DOF), [1, 4])
    A = np.vstack([J[:, free], np.sqrt(1e-3) * np.eye(5)])
    limits = (lower[free] - q[free], upper[free] - q[free])
    wanted = lsq_linear(A, np.concatenate([e, np.zeros(5)]), limits, method="bvls", tol=1e-14)
    np.testing.assert_allclose(d[free], wanted.x, atol=1e-8)
    assert (step(J, e, 1e-3, q, q, q) == 0).all()


def test_c_and_numpy_steps_agree() -> None:
    rng = np.random.default_rng(3)
    for kind in ["wide", "narrow", "at limits", "singular", "position"]:
        for _ in range(50):
            J, e, q, lower, upper = problem(rng, kind)
            arguments = (J, e, 0.01, q, lower, upper)
            np.testing.assert_allclose(in_c(*arguments), in_numpy(*arguments), atol=1e-11)


def test_numbers_that_allow_no_step_give_none() -> None:
    J, e, q = np.full((6, DOF), np.nan), np.ones(6), np.zeros(DOF)
    d = np.full(DOF, 7.0)
    handle = compiled(HUMAN).library.handle
    low, high = q - 1, q + 1
    arrays = [address(a) for a in (q, low, high)]
    rounds = handle.damped_step_once(
        address(J), address(e), ctypes.c_int(6), ctypes.c_double(0.1), *arrays, address(d)
    )
    assert rounds == 0
    assert (d == 0).all()
    J = np.zeros((6, DOF))
    rounds = handle.damped_step_once(
        address(J), address(e), ctypes.c_int(6), ctypes.c_double(0.0), *arrays, address(d)
    )
    assert rounds == 0


@both_residuals
@pytest.mark.parametrize("angle", [0.0, 1e-300, 1e-12, 1e-6, 1.0, 2.0, 2.2, 3.0, np.pi - 1e-7, np.pi - 1e-12])
def test_rotation_vector_is_that_of_scipy(residual: Residual, angle: float) -> None:
    rng = np.random.default_rng(4)
    for axis in [*np.eye(3), *-np.eye(3), *rng.normal(size=(50, 3))]:
        w = angle * axis / np.linalg.norm(axis)
        E = Rotation.from_rotvec(w).as_matrix()
        np.testing.assert_allclose(residual(E, False), w, atol=1e-14 + 1e-14 * angle)


@both_residuals
def test_rotation_vector_of_half_a_turn(residual: Residual) -> None:
    rng = np.random.default_rng(5)
    for axis in [*np.eye(3), *rng.normal(size=(50, 3)), np.array([1.0, 1e-9, 0]), np.array([1e-9, 0, -1.0])]:
        a = axis / np.linalg.norm(axis)
        w = residual(2 * np.outer(a, a) - np.eye(3), False)
        assert np.linalg.norm(w) == pytest.approx(np.pi, abs=1e-14)
        np.testing.assert_allclose(np.outer(w, w), np.pi**2 * np.outer(a, a), atol=1e-13)


@both_residuals
def test_printed_residual_is_mirrored_and_loses_large_angles(residual: Residual) -> None:
    rng = np.random.default_rng(6)
    mirror = np.array([[0, 0, -1], [0, 1, 0], [-1, 0, 0]])  # at the plane x + z = 0
    for axis in rng.normal(size=(20, 3)):
        a = axis / np.linalg.norm(axis)
        for angle in (0.1, 1.5):
            E = Rotation.from_rotvec(angle * a).as_matrix()
            np.testing.assert_allclose(residual(E, True), angle * mirror @ a, atol=1e-13)
        E = Rotation.from_rotvec(2.0 * a).as_matrix()
        np.testing.assert_allclose(residual(E, True), (2.0 - np.pi) * mirror @ a, atol=1e-13)
    assert (residual(np.eye(3), True) == 0).all()
    assert (residual(np.diag([1.0, -1.0, -1.0]), True) == 0).all()
    quarter = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
    np.testing.assert_allclose(residual(quarter, True), [0, 0, -np.pi / 2], atol=1e-15)
