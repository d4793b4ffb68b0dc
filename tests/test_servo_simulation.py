"""The simulated loop: linear where it should be, limited where it must be."""

from __future__ import annotations

import math
from dataclasses import replace

import control
import numpy as np
import pytest
from servo_helpers import MOTOR, PLANT, plain_drive, swing, two_bodies, two_links

from armik_sym.servo import Cascade, Gear, JointDrive, Motor, Pid, retime, tune_cascade, tune_pid
from armik_sym.servo.dynamics import inverse_dynamics
from armik_sym.servo.linear import in_series
from armik_sym.servo.motion import ArmMotion
from armik_sym.servo.reference import reference_of
from armik_sym.servo.setup import ServoOptions, make_setup
from armik_sym.servo.simulation import Wanted, simulate
from armik_sym.servo.tracking import track
from armik_sym.servo.tuning import position_loop

STRONG = JointDrive("j", replace(MOTOR, voltage=1e6, peak_torque=1e6, top_speed=1e5), Gear(1.0), 500.0)
PID = tune_pid(PLANT, 2 * math.pi * 8, math.radians(50))
CASCADE = tune_cascade(PLANT, 2 * math.pi * 8, math.radians(65))


def run(controller, q, *, drive=STRONG, speed=None, load=None, plant=PLANT):
    n = len(q)
    none = np.zeros((n, 1))
    wanted = Wanted(np.asarray(q)[:, None], none if speed is None else speed[:, None], none)
    load = none if load is None else np.asarray(load)[:, None]
    return simulate([plant], [controller], [drive], wanted, load)


@pytest.mark.parametrize("controller", [PID, CASCADE], ids=["pid", "cascade"])
def test_small_motion_is_the_answer_of_the_linear_loop_as_python_control_computes_it(controller):
    q = np.concatenate([[0.0], np.full(400, 0.01)])
    loop = (
        in_series(controller.sampled(0.001), PLANT.sampled())
        if isinstance(controller, Pid)
        else position_loop(PLANT, controller)
    )
    closed = control.feedback(loop.to_control(), 1)
    response = control.forced_response(closed, np.arange(401) * 0.001, q)
    np.testing.assert_allclose(run(controller, q).q[:, 0], response.outputs, atol=1e-9)


def test_a_load_step_is_the_answer_of_the_linear_loop():
    load = np.concatenate([[0.0], np.full(1500, 3.0)])
    got = run(CASCADE, np.zeros(1501), load=load).q[:, 0]
    phi, late, early, per_load = PLANT.matrices()
    law, x, u = CASCADE.sampled(0.001), np.zeros(3), [0.0, 0.0]
    state = np.zeros(2)
    for k in range(1501):
        assert got[k] == pytest.approx(x[0], abs=1e-12)
        error = -x[0]
        u = [float(law.c @ state + law.d * error), u[0]]
        state = law.A @ state + law.b * error
        x = phi @ x + late * u[0] + early * u[1] + per_load * load[k]
    assert abs(got[-1]) < 1e-4  # integral action takes the load off


def test_errors_on_a_ramp_and_a_parabola_are_those_of_the_final_value_theorem():
    time, speed, acceleration = np.arange(12_000) * 0.001, 0.4, 0.3
    ramp, parabola = speed * time, 0.5 * acceleration * time**2
    late = run(CASCADE, ramp).q[-1, 0] - ramp[-1]
    assert late == pytest.approx(-speed / CASCADE.kp, rel=1e-6)  # type 1: v / kp
    fed = run(CASCADE, ramp, speed=np.full(12_000, speed)).q[-1, 0] - ramp[-1]
    assert abs(fed) < 1e-8  # wanted speed fed forward
    assert abs(run(PID, ramp).q[-1, 0] - ramp[-1]) < 1e-8  # type 2
    off = run(PID, parabola).q[-1, 0] - parabola[-1]
    assert off == pytest.approx(-acceleration * PLANT.viscous / PID.ki, rel=1e-3)  # a / K_a, K_a = ki / B


@pytest.mark.parametrize("controller", [PID, CASCADE], ids=["pid", "cascade"])
def test_anti_windup_keeps_the_overshoot_of_a_limited_step_small(controller):
    weak = JointDrive("j", replace(MOTOR, voltage=1e6, rated_torque=0.5, peak_torque=1.0), Gear(1.0), 500.0)
    q = np.concatenate([[0.0], np.full(6000, 1.0)])
    with_it = run(controller, q, drive=weak)
    without = run(replace(controller, tracking_time=1e9), q, drive=weak)
    assert with_it.limited.any()
    assert with_it.q.max() < 0.8 * without.q.max() or with_it.q.max() < 1.02 < without.q.max()


def test_torque_and_speed_never_leave_the_line_of_the_motor():
    motor = Motor(24.0, 0.5, 0.0, 0.05, 3e-4, 0.4, 1.2, 1e4)
    drive = JointDrive("j", motor, Gear(50.0), 500.0)
    out = run(CASCADE, np.concatenate([[0.0], np.full(3000, 40.0)]), drive=drive)
    assert np.abs(out.torque).max() <= drive.peak_torque * (1 + 1e-12)
    assert np.abs(out.speed).max() <= motor.no_load_speed / 50 * (1 + 1e-2)
    assert np.abs(out.speed).max() > 0.9 * drive.top_speed


def test_a_torque_below_dry_friction_moves_nothing_and_friction_never_pushes():
    sticky = replace(STRONG, dry=2.0)
    held = simulate(
        [PLANT], [Cascade(0.0, 1e-12, 0.0, 1.0)], [sticky],
        Wanted(np.zeros((300, 1)), np.zeros((300, 1)), np.where(np.arange(300)[:, None] > 0, 1.9, 0.0)),
        np.zeros((300, 1)),
    )  # fmt: skip
    assert np.abs(held.q).max() == 0.0
    moved = simulate(
        [PLANT], [Cascade(0.0, 1e-12, 0.0, 1.0)], [sticky],
        Wanted(np.zeros((300, 1)), np.zeros((300, 1)), np.where(np.arange(300)[:, None] > 0, 2.5, 0.0)),
        np.zeros((300, 1)),
    )  # fmt: skip
    J, B, t = PLANT.inertia, PLANT.viscous, 0.299 - PLANT.delay - PLANT.lag
    assert moved.speed[-1, 0] == pytest.approx(0.5 / B * (1 - math.exp(-B * t / J)), rel=0.01)


@pytest.mark.parametrize("step", [0.01, 0.001, 0.00025])
def test_a_joint_held_by_friction_does_not_creep_under_a_torque_that_swings(step):
    swinging = np.sin(2 * math.pi * 7 * np.arange(int(2 / step)) * step)[:, None]
    none, quiet = np.zeros_like(swinging), [Cascade(0.0, 1e-12, 0.0, 1.0)]
    plant, sticky = replace(PLANT, step=step), replace(STRONG, dry=2.0)
    for wanted, load in (
        (Wanted(none, none, 1.5 * swinging), none),
        (Wanted(none, none, none), 1.5 * swinging),
    ):
        assert np.abs(simulate([plant], quiet, [sticky], wanted, load).q).max() == 0.0


@pytest.mark.parametrize("feedforward", ["none", "acceleration"])
def test_a_start_with_full_acceleration_is_fed_forward_from_the_first_sample(feedforward):
    """A straight way re-timed from rest to rest: its acceleration jumps at the start, the command with it."""
    arm = two_links()
    way = ArmMotion(arm, np.array([0.0, 1.0]), np.array([[0.0, 0.0], [0.5, 0.0]]))
    motion = retime(way, 1.0, 3.0, ends="rest", faster=True)
    options = ServoOptions(feedforward=feedforward)
    setup = make_setup(arm, motion.q, drive=plain_drive(arm.joint_names), bodies=(), options=options)
    reference = reference_of(motion, 1000.0)
    assert reference.acceleration[0, 0] == pytest.approx(3.0)
    after = track(setup, reference).run.torque[10, 0]
    expected = 3.0 * setup.plants[0].inertia
    assert (
        after == pytest.approx(expected, rel=0.1) if feedforward == "acceleration" else after < 0.5 * expected
    )


def test_the_relaxed_simulation_is_the_coupled_arm_integrated_directly():
    """Two heavy links on weak reduction, so that each shakes the other; Runge-Kutta with M(q) as a whole.

    What is left, some 1e-7 rad and of second order in the sampling time, is the load that the relaxed
    simulation holds during a sample.
    """
    arm, bodies = two_links(), two_bodies()
    drive = replace(plain_drive(arm.joint_names, ratio=30.0), delay=0.0)
    motion = swing(arm, 0.1, 0.2, 21)
    setup = make_setup(arm, motion.q, drive=drive, bodies=bodies, options=ServoOptions(bandwidth=6.0))
    reference = reference_of(motion, 1000.0)
    relaxed = track(setup, reference, passes=100, change=1e-10)
    assert relaxed.settled
    assert not relaxed.run.limited.any()

    own = np.diag([j.inertia for j in drive.joints])
    lag, viscous = setup.plants[0].lag, 0.5

    def slope(q, v, torque, u):
        # Torques without acceleration and with a unit of each: bias and mass matrix in one call.
        units = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        same = np.tile(q, (3, 1)), np.tile(v, (3, 1))
        bias, *columns = inverse_dynamics(arm, bodies, *same, units, setup.gravity)
        M = np.column_stack(columns) - bias[:, None] + own
        return v, np.linalg.solve(M, torque - viscous * v - bias), (u - torque) / lag

    laws = setup.controllers
    q, v = reference.q[0].copy(), np.zeros(2)
    torque = setup.body_torque(q[None], v[None], v[None])[0]
    integral, before = torque.copy(), q.copy()
    kp, kv, ki = (np.array([getattr(law, key) for law in laws]) for key in ("kp", "kv", "ki"))
    inertia = np.array([plant.inertia for plant in setup.plants])
    for k in range(len(reference.time)):
        np.testing.assert_allclose(relaxed.run.q[k], q, atol=3e-7)
        error = kp * (reference.q[k] - q) + reference.speed[k] - (q - before) / 0.001
        integral = integral + ki * 0.001 * error
        u = kv * error + integral + viscous * reference.speed[k] + inertia * reference.acceleration[k]
        before = q.copy()
        for _ in range(5):  # the current loop is faster than a sample
            h = 0.0002
            state = (q, v, torque)
            k1 = slope(*state, u)
            k2 = slope(*(s + h / 2 * d for s, d in zip(state, k1, strict=True)), u)
            k3 = slope(*(s + h / 2 * d for s, d in zip(state, k2, strict=True)), u)
            k4 = slope(*(s + h * d for s, d in zip(state, k3, strict=True)), u)
            slopes = zip(state, k1, k2, k3, k4, strict=True)
            q, v, torque = (s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in slopes)
    assert np.abs(relaxed.run.q[-1] - reference.q[0]).max() > 0.09
