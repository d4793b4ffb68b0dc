"""Plant, loops and margins against textbook answers and python-control."""

from __future__ import annotations

import math

import control
import numpy as np
import pytest
from hypothesis import given, reject
from hypothesis import strategies as st
from servo_helpers import PLANT

from armik_sym.errors import DriveError, TuningError
from armik_sym.servo import Cascade, JointPlant, Pid, loop_margins, tune_cascade, tune_pid
from armik_sym.servo.linear import closed_poles, in_series
from armik_sym.servo.tuning import position_loop

BANDWIDTHS = st.floats(0.5, 20.0).map(lambda hz: 2 * math.pi * hz)
PLANTS = st.builds(
    JointPlant,
    inertia=st.floats(0.01, 10.0),
    viscous=st.floats(0.0, 0.5),
    lag=st.floats(1e-4, 1e-3),
    delay=st.floats(0.0, 0.002),
    step=st.just(0.001),
)


def judged(loop):
    """Phase margin and crossover as python-control finds them on a fine response."""
    omega = np.geomspace(1e-1, 0.999 * math.pi / loop.step, 5_000)
    data = control.frd(loop.response(omega)[None, None, :], omega, smooth=True)
    margins = control.stability_margins(data)
    return margins[:6]


def test_without_delay_the_plant_is_python_controls_own_discretisation():
    plant = JointPlant(0.8, 0.3, 0.0004, 0.0, 0.001)
    A, b, _ = plant.continuous
    ours = plant.sampled()
    theirs = control.c2d(control.ss(A, b[:, None], [[1, 0, 0]], 0), 0.001, "zoh")
    omega = np.geomspace(1, 3000, 50)
    np.testing.assert_allclose(
        ours.response(omega), np.squeeze(theirs(np.exp(1j * omega * 0.001))), rtol=1e-9
    )
    np.testing.assert_allclose(
        ours.to_control()(np.exp(1j * omega * 0.001)).squeeze(), ours.response(omega), rtol=1e-9
    )


@pytest.mark.parametrize("delay", [0.0, 0.0003, 0.001, 0.0017, 0.003])
def test_a_delay_of_any_part_of_a_sample_is_exact(delay):
    """The same joint on a grid ten times finer, where every delay is a whole number of samples."""
    plant = JointPlant(0.8, 0.3, 0.0004, delay, 0.001)
    phi, late, early, _ = plant.matrices()
    fine = JointPlant(0.8, 0.3, 0.0004, 0.0, 0.0001)
    phi_f, b_f, _, _ = fine.matrices()
    u = np.random.default_rng(2).normal(size=30)
    held = np.concatenate([np.zeros(round(delay / 0.0001)), np.repeat(u, 10)])
    x, y = np.zeros(3), np.zeros(3)
    for k in range(30):
        for i in range(10):
            y = phi_f @ y + b_f * held[10 * k + i]
        m = plant.whole_delay
        now, before = (u[j] if j >= 0 else 0.0 for j in (k - m, k - m - 1))
        x = phi @ x + late * now + early * before
        np.testing.assert_allclose(x, y, atol=1e-12)


def test_speed_of_a_joint_under_a_constant_torque_is_the_textbook_first_order_step():
    J, B, step = 0.7, 1.9, 0.001
    phi, b, _, _ = JointPlant(J, B, 1e-7, 0.0, step).matrices()
    x = np.zeros(3)
    for k in range(1, 800):
        x = phi @ x + b * 2.5
        assert x[1] == pytest.approx(2.5 / B * (1 - math.exp(-B * k * step / J)), abs=1e-6)


def test_a_spring_and_damper_is_the_textbook_second_order_step():
    """P control and speed feedback on a pure inertia: ω_n² / (s² + 2 ζ ω_n s + ω_n²)."""
    zeta, natural, step = 0.3, 6.0, 1e-5
    phi, b, _, _ = JointPlant(1.0, 0.0, 1e-8, 0.0, step).matrices()
    damped = natural * math.sqrt(1 - zeta**2)
    x = np.zeros(3)
    for k in range(1, 100_001):
        x = phi @ x + b * (natural**2 * (1.0 - x[0]) - 2 * zeta * natural * x[1])
        if k % 10_000 == 0:
            t = k * step
            decay = math.exp(-zeta * natural * t)
            expected = 1 - decay * (math.cos(damped * t) + zeta * natural / damped * math.sin(damped * t))
            assert x[0] == pytest.approx(expected, abs=2e-4)
    overshoot = math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    response = control.step_response(control.tf([natural**2], [1, 2 * zeta * natural, natural**2]), 5.0)
    assert response.outputs.max() == pytest.approx(1 + overshoot, abs=1e-3)


@given(plant=PLANTS, bandwidth=BANDWIDTHS, margin_deg=st.floats(30.0, 65.0))
def test_a_tuned_pid_has_the_bandwidth_and_margin_asked_for(plant, bandwidth, margin_deg):
    try:
        pid = tune_pid(plant, bandwidth, math.radians(margin_deg))
    except TuningError:
        reject()
    loop = in_series(pid.sampled(plant.step), plant.sampled())
    answer = loop.response(np.array([bandwidth]))[0]
    assert abs(answer) == pytest.approx(1.0, abs=1e-9)
    assert np.angle(-answer) == pytest.approx(math.radians(margin_deg), abs=1e-8)
    assert np.abs(closed_poles(loop)).max() < 1.0


@given(plant=PLANTS, bandwidth=BANDWIDTHS, margin_deg=st.floats(40.0, 85.0))
def test_a_tuned_cascade_has_the_bandwidth_and_margin_asked_for(plant, bandwidth, margin_deg):
    try:
        cascade = tune_cascade(plant, bandwidth, math.radians(margin_deg))
    except TuningError:
        reject()
    answer = position_loop(plant, cascade).response(np.array([bandwidth]))[0]
    assert abs(answer) == pytest.approx(1.0, abs=1e-8)
    assert np.angle(-answer) == pytest.approx(math.radians(margin_deg), abs=1e-7)
    whole = in_series(cascade.sampled(plant.step), plant.sampled())
    assert np.abs(closed_poles(whole)).max() < 1.0


@pytest.mark.parametrize(("tune", "margin"), [(tune_pid, 50.0), (tune_cascade, 65.0)])
def test_usual_loops_can_be_tuned_and_python_control_agrees_about_their_margins(tune, margin):
    controller = tune(PLANT, 2 * math.pi * 8, math.radians(margin))
    asked = (
        in_series(controller.sampled(PLANT.step), PLANT.sampled())
        if isinstance(controller, Pid)
        else position_loop(PLANT, controller)
    )
    gain, phase, stability, _, crossover, _ = judged(asked)
    assert phase == pytest.approx(margin, abs=1e-3)
    assert crossover == pytest.approx(2 * math.pi * 8, rel=1e-5)
    ours = loop_margins(asked)
    assert ours.stable
    assert math.degrees(ours.phase) == pytest.approx(margin, abs=1e-6)
    # python-control reports the gain margin nearest to 1, up or down.
    assert min(abs(math.log(gain / m)) for m in (ours.gain, ours.gain_down) if m > 0) < 1e-3
    assert ours.sensitivity == pytest.approx(1 / stability, rel=1e-4)
    assert ours.delay == pytest.approx(math.radians(margin) / (2 * math.pi * 8), rel=1e-6)


def test_margins_of_the_loop_cut_at_the_torque_are_those_of_python_control():
    cascade = tune_cascade(PLANT, 2 * math.pi * 10, math.radians(60))
    loop = in_series(cascade.sampled(PLANT.step), PLANT.sampled())
    ours, (gain, phase, stability, *_rest) = loop_margins(loop), judged(loop)
    assert math.degrees(ours.phase) == pytest.approx(phase, abs=1e-3)
    assert ours.sensitivity == pytest.approx(1 / stability, rel=1e-4)
    # python-control reports the gain margin nearest to 1, up or down.
    assert min(abs(math.log(gain / m)) for m in (ours.gain, ours.gain_down)) < 1e-3


def test_the_gain_and_delay_margins_are_where_the_loop_becomes_unstable():
    cascade = tune_cascade(PLANT, 2 * math.pi * 10, math.radians(60))
    loop = in_series(cascade.sampled(PLANT.step), PLANT.sampled())
    margins = loop_margins(loop)
    for factor, stable in ((0.99, True), (1.01, False)):
        louder = loop._replace(c=loop.c * margins.gain * factor, d=loop.d * margins.gain * factor)
        assert loop_margins(louder).stable is stable
        later = JointPlant(
            PLANT.inertia, PLANT.viscous, PLANT.lag, PLANT.delay + factor * margins.delay, 0.001
        )
        assert loop_margins(in_series(cascade.sampled(0.001), later.sampled())).stable is stable


@pytest.mark.parametrize("tune", [tune_pid, tune_cascade])
def test_what_cannot_be_tuned_is_refused_with_advice(tune):
    with pytest.raises(TuningError, match="lower bandwidth"):
        tune(PLANT, 2 * math.pi * 200, math.radians(70))
    with pytest.raises(TuningError, match="half the sampling rate"):
        tune(PLANT, 4000.0, 1.0)
    with pytest.raises(TuningError, match="between 0 and"):
        tune(PLANT, 50.0, 2.0)
    with pytest.raises(TuningError, match="expected above 0"):
        tune(PLANT, math.nan, 1.0)


@pytest.mark.parametrize("tune", [tune_pid, tune_cascade])
def test_a_loop_late_by_more_than_a_quarter_turn_is_refused_for_that(tune):
    """Counted within a turn its phase would look like a margin that is too large."""
    with pytest.raises(TuningError, match=r"late by 2\d\d°.*lower bandwidth"):
        tune(JointPlant(1.1, 0.5, 0.0003, 0.1, 0.001), 2 * math.pi * 8, 1.1)


def test_controllers_with_impossible_gains_are_refused():
    with pytest.raises(DriveError, match="Cascade: kp is -1"):
        Cascade(-1, 1.0, 1.0, 1.0)
    with pytest.raises(DriveError, match="Pid: tracking_time is 0"):
        Pid(1.0, 1.0, 1.0, 0.001, 0)


def test_cascade_and_position_loop_are_the_same_loop_cut_at_two_places():
    """Closed, they have the same poles."""
    cascade = Cascade(30.0, 80.0, 900.0, 0.1)
    torque = closed_poles(in_series(cascade.sampled(PLANT.step), PLANT.sampled()))
    position = closed_poles(position_loop(PLANT, cascade))
    for pole in position:
        assert np.abs(torque - pole).min() < 1e-6
