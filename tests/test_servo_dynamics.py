"""Rigid-body dynamics, against Pinocchio and against a Lagrangian differentiated by CasADi."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from servo_helpers import two_bodies, two_links

from armik_sym.arm import Arm, DHConvention, JointType, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.errors import DriveError
from armik_sym.servo.arm_load import bodies_of
from armik_sym.servo.body import SHARES, RigidBody, Subject
from armik_sym.servo.dynamics import (
    GRAVITY,
    gravity_of,
    gravity_torque,
    inverse_dynamics,
    joint_inertia,
    mass_matrix,
)

ARMS = {"ehmcs": ehmcs(), "ehmcs5": ehmcs(5), "human": human(), "alfaiz": alfaiz()}
EXTRA = {"upper_arm": 0.8, "forearm": 0.5, "hand": 0.2}


def random_motion(arm: Arm, n: int = 8, seed: int = 1):
    random = np.random.default_rng(seed)
    return tuple(scale * random.normal(size=(n, arm.dof)) for scale in (1.0, 2.0, 5.0))


def elementary(axis: str, value, turn: bool):
    T = ca.SX.eye(4)
    if turn:
        c, s = ca.cos(value), ca.sin(value)
        i, j = (0, 1) if axis == "z" else (1, 2)
        T[i, i], T[i, j], T[j, i], T[j, j] = c, -s, s, c
    else:
        T["xyz".index(axis), 3] = value
    return T


def lagrangian_torque(arm: Arm, bodies, gravity):
    """d/dt ∂L/∂q̇ - ∂L/∂q by automatic differentiation; nothing of the package but the numbers of the rows."""
    q, v, a = (ca.SX.sym(name, arm.dof) for name in "qva")
    frames, T, column = [ca.SX(arm.chain.base)], ca.SX(arm.chain.base), 0
    for link in arm.chain.links:
        theta, (d, along) = link.theta, (arm.lengths.get(x, x) for x in (link.d, link.a))
        if link.joint is JointType.REVOLUTE:
            theta = theta + link.sign * q[column]
            column += 1
        z = elementary("z", theta, True) @ elementary("z", d, False)
        x = elementary("x", along, False) @ elementary("x", link.alpha, True)
        T = T @ (z @ x if arm.chain.convention is DHConvention.STANDARD else x @ z)
        frames.append(T)
    frames.append(T @ ca.SX(arm.chain.tool))
    energy = ca.SX(0)
    for body in bodies:
        R = frames[body.frame][:3, :3]
        p = frames[body.frame][:3, 3] + R @ ca.SX(body.centre)
        speed = ca.jtimes(p, q, v)
        spin = ca.reshape(ca.jtimes(ca.reshape(R, 9, 1), q, v), 3, 3).T @ R
        omega = -ca.vertcat(spin[2, 1], spin[0, 2], spin[1, 0])
        energy += 0.5 * body.mass * ca.dot(speed, speed) + 0.5 * omega.T @ ca.SX(body.inertia) @ omega
        energy += body.mass * ca.dot(ca.SX(gravity), p)
    momentum = ca.gradient(energy, v)
    torque = ca.jtimes(momentum, q, v) + ca.jtimes(momentum, v, a) - ca.gradient(energy, q)
    return ca.Function("torque", [q, v, a], [torque])


@pytest.mark.parametrize("name", ARMS)
def test_torques_are_those_of_the_lagrangian(name):
    arm = ARMS[name]
    bodies, gravity = bodies_of(arm, Subject(80.0, 1.8), EXTRA), gravity_of(arm)
    q, v, a = random_motion(arm)
    expected = lagrangian_torque(arm, bodies, gravity)
    wanted = np.array([expected(*row).full().ravel() for row in zip(q, v, a, strict=True)])
    np.testing.assert_allclose(inverse_dynamics(arm, bodies, q, v, a, gravity), wanted, atol=1e-10)


@pytest.mark.parametrize("name", ["ehmcs", "human"])
def test_torques_and_inertia_are_those_of_pinocchio(name):
    pin = pytest.importorskip("pinocchio")
    arm = ARMS[name]
    bodies = bodies_of(arm, None, EXTRA)
    model = pin.Model()
    model.gravity.linear = gravity_of(arm)
    placement, parent = pin.SE3(arm.chain.base), 0
    for i, link in enumerate(arm.chain.links, 1):
        turn = pin.SE3(pin.utils.rotate("z", link.theta), np.zeros(3))
        if link.sign < 0:  # turning the other way about z is turning about z after a half turn about x
            turn = turn * pin.SE3(pin.utils.rotate("x", np.pi), np.zeros(3))
        parent = model.addJoint(parent, pin.JointModelRZ(), placement * turn, link.name)
        d, along = (arm.lengths.get(x, x) for x in (link.d, link.a))
        after = pin.SE3(pin.utils.rotate("x", link.alpha), np.array([along, 0.0, d]))
        if link.sign < 0:
            after = pin.SE3(pin.utils.rotate("x", -np.pi), np.zeros(3)) * after
        for body in bodies:
            if body.frame == i or (i == arm.dof and body.frame == i + 1):
                model.appendBodyToJoint(parent, pin.Inertia(body.mass, body.centre, body.inertia), after)
        placement = after
    data = model.createData()
    q, v, a = random_motion(arm)
    expected = np.array([pin.rnea(model, data, *row).copy() for row in zip(q, v, a, strict=True)])
    got = inverse_dynamics(arm, bodies, q, v, a, gravity_of(arm))
    np.testing.assert_allclose(got, expected, atol=1e-9)
    M = pin.crba(model, data, q[0])
    M = np.triu(M) + np.triu(M, 1).T
    np.testing.assert_allclose(mass_matrix(arm, bodies, q[:1])[0], M, atol=1e-10)
    np.testing.assert_allclose(joint_inertia(arm, bodies, q[:1])[0], np.diag(M), atol=1e-10)


@pytest.mark.parametrize("convention", DHConvention)
def test_a_hanging_pendulum_needs_no_torque_and_a_level_one_its_weight(convention):
    arm = two_links(convention)
    bodies = tuple(b for b in two_bodies() if b.name == "b") if convention is DHConvention.STANDARD else ()
    hanging = gravity_torque(arm, bodies, np.zeros((1, 2)), gravity_of(arm))
    np.testing.assert_allclose(hanging, 0.0, atol=1e-12)
    level = gravity_torque(arm, bodies, np.array([[np.pi / 2, 0.0]]), gravity_of(arm))[0]
    if bodies:
        np.testing.assert_allclose(level, GRAVITY * 1.5 * np.array([0.45, 0.15]), rtol=1e-12)


@pytest.mark.parametrize("sex", SHARES)
def test_every_segment_of_the_table_can_be_a_rigid_body(sex):
    """No moment of inertia is larger than the sum of the other two."""
    for share in SHARES[sex].values():
        moments = np.sort(np.square([share.sagittal, share.transverse, share.longitudinal]))
        assert moments[2] <= moments[0] + moments[1]


def test_bodies_that_cannot_be_are_refused():
    for values, said in (
        ((-1.0, np.zeros(3), np.eye(3)), "mass is -1.0"),
        ((1.0, np.zeros(2), np.eye(3)), "centre is"),
        ((1.0, np.zeros(3), -np.eye(3)), "inertia is"),
    ):
        with pytest.raises(DriveError, match=said):
            RigidBody("odd", 1, *values)


def test_segments_weigh_what_the_table_says_and_lie_between_their_joints():
    arm = human()
    bodies = {body.name: body for body in bodies_of(arm, Subject(70.0, 1.741))}
    assert set(bodies) == {"upper_arm", "forearm", "hand"}
    assert sum(body.mass for body in bodies.values()) == pytest.approx(70 * (0.0271 + 0.0162 + 0.0061))
    hanging = np.zeros((1, 7))
    from armik_sym.arm.product_of_transforms import joint_frames

    frames = joint_frames(arm.chain, hanging, arm.lengths)[0]
    height = {
        name: float(arm.up @ (frames[b.frame] @ np.append(b.centre, 1.0))[:3]) for name, b in bodies.items()
    }
    share = SHARES["male"]
    assert height["upper_arm"] == pytest.approx(-0.28 * share["upper_arm"].centre)
    assert height["forearm"] == pytest.approx(-0.28 - 0.26 * share["forearm"].centre)
    assert height["hand"] == pytest.approx(-0.28 - 0.26 - 0.0862 * share["hand"].centre)


def test_a_heavier_person_needs_more_torque_and_a_taller_one_a_longer_hand():
    arm, q = human(), np.full((1, 7), 0.6)
    light, heavy = (
        gravity_torque(arm, bodies_of(arm, Subject(m)), q, gravity_of(arm)) for m in (50.0, 100.0)
    )
    np.testing.assert_allclose(heavy, 2 * light)
    assert Subject(stature=1.9).hand_length > Subject(stature=1.6).hand_length


def test_what_is_missing_or_impossible_is_said():
    arm = two_links()
    with pytest.raises(DriveError, match=r"no segment length 'upper_arm'.*bodies="):
        bodies_of(arm)
    blind = Arm("blind", arm.chain, RangeOfMotion(arm.rom.lower, arm.rom.upper))
    with pytest.raises(DriveError, match="where up is"):
        gravity_of(blind)
    for wrong in ({"mass": 0.0}, {"stature": 17.4}, {"sex": "none"}, {"mass": float("nan")}):
        with pytest.raises(DriveError, match=next(iter(wrong))):
            Subject(**wrong)
