"""The check as a whole: verdicts, how much slower, and again."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from servo_helpers import MOTOR, first_second, plain_drive, swing, two_bodies, two_links

import armik_sym as ak
from armik_sym.errors import DriveError, OptionError, TuningError, UnknownNameError
from armik_sym.servo import Cascade, Tolerances, check, load_drive
from armik_sym.servo.motion import ArmMotion
from armik_sym.servo.reference import reference_of
from armik_sym.servo.setup import make_setup
from armik_sym.servo.slower import limit_factor, smallest_factor

ARM, BODIES = two_links(), two_bodies()
DRIVE = plain_drive(ARM.joint_names)


def checked(motion, **options):
    return check(motion, DRIVE, bodies=BODIES, **options)


@cache
def solved(method="trajectory"):
    """The first second of a task: long enough for jumps, short enough for a test."""
    task = ak.load_task("drinking_lift")
    return ak.solve(ak.catalog.ehmcs(), first_second(task.path), method, start=task.measured.q[0])


@pytest.fixture(scope="module")
def gentle():
    return checked(swing(ARM))


def test_a_gentle_motion_is_followed_and_the_numbers_are_those_of_the_motion(gentle):
    assert gentle.ok
    assert gentle.reasons == ()
    assert gentle.slower_by == 1.0
    first = gentle.joints[0]
    assert first.name == "first"
    # Minimum jerk: largest speed 15/8 of the mean.
    assert first.speed == pytest.approx(0.5 * 15 / 8, rel=1e-3)
    assert first.speed_limit == pytest.approx(MOTOR.no_load_speed / 50)
    assert first.torque_limit == pytest.approx(50 * MOTOR.peak_torque)
    assert 0 < first.error_rms < first.error_peak < math.radians(2)
    assert gentle.tracking.settled
    # Wrist error from forward kinematics: at most what both joint errors can do together.
    most = np.abs(gentle.tracking.joint_error) @ np.array([0.55, 0.25])
    assert (gentle.tracking.hand_error <= most + 1e-12).all()
    assert gentle.tracking.hand_peak > 0.1 * most.max()
    assert str(gentle).startswith("ok: the drives can follow: arm two_links, drive plain")


def test_a_fast_motion_is_refused_with_joint_number_limit_and_time():
    result = checked(swing(ARM, 2.0, 0.3))
    assert not result.ok
    fast = next(reason for reason in result.reasons if "turns at most" in reason)
    assert "first is asked for" in fast
    assert "°/s at 0.15 s" in fast
    strong = next(reason for reason in result.reasons if "Nm at" in reason)
    assert f"its drive has {result.joints[0].torque_limit:.3g} Nm" in strong
    assert any(reason.startswith("the hand is") for reason in result.reasons)
    assert "not ok" in str(result)


def test_the_factor_it_gives_is_enough_and_a_smaller_one_is_not():
    result = checked(swing(ARM, 2.0, 0.3))
    factor = result.slower_by
    assert factor is not None
    assert factor > 1.5
    assert result.slowed(factor).ok
    assert not result.slowed(factor * 0.997).ok
    with pytest.raises(OptionError, match="factor"):
        result.slowed(0.0)


def test_the_factor_is_enough_where_the_arm_shakes_its_joints():
    """Few samples, hard turns: the load settles only after many passes, and the search must wait for that."""
    time, q = np.array([0.0, 0.1]), np.array([[0.0, 0.0], [0.5, 0.5]])
    result = checked(ArmMotion(ARM, time, q))
    factor = result.slower_by
    assert factor is not None
    assert result.slowed(factor).ok
    assert not result.slowed(0.997 * factor).ok


def test_where_speed_decides_the_factor_is_exactly_the_ratio_of_speeds():
    motion = swing(ARM, 1.0, 2.0)
    slow = replace(MOTOR, top_speed=50 * 0.5)
    setup = make_setup(ARM, motion.q, drive=plain_drive(ARM.joint_names, motor=slow), bodies=())
    reference = reference_of(motion, 1000.0)
    assert limit_factor(setup, reference) == pytest.approx(np.abs(reference.speed).max() / 0.5, rel=1e-12)


@pytest.mark.parametrize("size", [1.5, 2.5])
def test_at_the_factor_of_the_limits_one_of_them_is_just_met(size):
    motion = swing(ARM, size, 0.4)
    setup = make_setup(ARM, motion.q, drive=DRIVE, bodies=BODIES)
    factor = limit_factor(setup, reference_of(motion, 1000.0))
    assert factor is not None
    used = []
    for f in (factor, 0.999 * factor):
        r = reference_of(motion, 1000.0)
        needed = setup.torque_needed(r.q, r.speed / f, r.acceleration / f**2)
        joints = setup.drive.joints
        used.append(
            max(
                max(np.abs(needed[:, j]).max() / d.peak_torque for j, d in enumerate(joints)),
                max(np.sqrt((needed[:, j] ** 2).mean()) / d.rated_torque for j, d in enumerate(joints)),
                max(np.abs(r.speed[:, j]).max() / f / d.top_speed for j, d in enumerate(joints)),
            )
        )
    assert used[0] == pytest.approx(1.0, abs=1e-9)
    assert used[1] > 1.0


def test_a_drive_that_cannot_hold_the_arm_is_not_helped_by_time():
    weak = replace(MOTOR, rated_torque=0.001, peak_torque=0.002)
    motion = swing(ARM)
    result = check(motion, plain_drive(ARM.joint_names, motor=weak), bodies=BODIES)
    assert not result.ok
    assert result.slower_by is None


def test_bisection_finds_a_threshold():
    assert smallest_factor(lambda f: f >= 3.3, 1.0, 10.0) == pytest.approx(3.3, rel=2e-3)
    assert smallest_factor(lambda f: f >= 3.3, 1.0, 3.0) is None
    assert smallest_factor(lambda _: True, 1.7, 10.0) == 1.7
    assert smallest_factor(lambda _: True, 11.0, 10.0) is None


def test_retimed_it_is_followed_and_not_slower_than_slowing_all():
    result = checked(swing(ARM, 2.0, 0.3))
    found = result.retimed()
    assert found is not None
    motion, again = found
    assert again.ok
    assert motion.duration <= motion.uniform_duration
    np.testing.assert_array_equal(motion.q, result.solution.q)


@pytest.mark.parametrize("controller", ["cascade", "pid"])
def test_feedforward_makes_tracking_better(controller):
    """The derivative of a PID holds the wanted speed already, so only the cascade gains much from it."""
    solution = solved()
    error = {
        way: check(solution, controller=controller, feedforward=way, bandwidth=6.0).tracking.hand_rms
        for way in ("none", "speed", "acceleration")
    }
    assert error["acceleration"] < error["speed"] <= error["none"]
    if controller == "cascade":
        assert error["speed"] < 0.1 * error["none"]
    assert error["acceleration"] < 0.0015


def test_the_papers_point_jumps_cannot_be_followed_and_smooth_motion_can():
    """The same path, the same drives: ISADE jumps, Pro-ISADE trembles, the whole trajectory is smooth."""
    checks = {method: check(solved(method)) for method in ("isade", "pro-isade", "trajectory")}
    error = {method: each.tracking.hand_rms for method, each in checks.items()}
    assert error["trajectory"] < 0.2 * error["pro-isade"] < 0.2 * error["isade"]
    assert checks["trajectory"].ok
    assert not checks["isade"].ok
    assert "turns at most" in " ".join(checks["isade"].reasons)


def test_own_controllers_and_gravity_compensation_are_used():
    law = tuple(Cascade(20.0, 40.0, 300.0, 0.1) for _ in range(2))
    result = check(swing(ARM), DRIVE, law, bodies=BODIES, gravity=True, feedforward="speed")
    assert result.setup.controllers == law
    assert result.setup.options.gravity
    with pytest.raises(DriveError, match="expected 2"):
        check(swing(ARM), DRIVE, law[:1], bodies=BODIES)


def test_tolerances_decide_and_impossible_wishes_are_refused(gentle):
    strict = checked(swing(ARM), tolerances=Tolerances(hand=1e-9, joint=1e-9))
    assert not strict.ok
    assert strict.tracking.hand_rms == pytest.approx(gentle.tracking.hand_rms)
    with pytest.raises(OptionError, match="tolerance hand"):
        Tolerances(hand=-1.0)
    with pytest.raises(TuningError, match=r"joint 'first'.*lower bandwidth"):
        checked(swing(ARM), bandwidth=200.0)
    with pytest.raises(UnknownNameError, match="cascade, pid"):
        check(swing(ARM), DRIVE, "lqr", bodies=BODIES)
    with pytest.raises(UnknownNameError, match="bandwidth"):
        checked(swing(ARM), bandwith=3.0)


@pytest.mark.parametrize(
    ("options", "error", "said"),
    [
        ({"rate": -1.0}, OptionError, "rate is -1.0 Hz"),
        ({"bandwidth": "8"}, OptionError, "bandwidth is '8' Hz"),
        ({"phase_margin": "wide"}, OptionError, "phase_margin is 'wide'"),
        ({"gravity": "no"}, OptionError, "gravity is 'no'"),
        ({"largest": math.nan}, OptionError, "largest is nan"),
        ({"largest": 0.5}, OptionError, "largest is 0.5"),
        ({"controller": 7}, DriveError, "controller is 7"),
        ({"bodies": (replace(BODIES[0], frame=9),)}, DriveError, "frame 9.*frames 0 to 3"),
    ],
)  # fmt: skip
def test_values_that_cannot_be_are_refused_by_name(options, error, said):
    with pytest.raises(error, match=said):
        check(swing(ARM), DRIVE, **{"bodies": BODIES, **options})
    with pytest.raises(DriveError, match="drive is 3"):
        check(swing(ARM), 3, bodies=BODIES)


def test_unsafe_loops_are_named():
    nervous = tuple(Cascade(100.0, 700.0, 1e4, 0.1) for _ in range(2))
    reasons = check(swing(ARM), DRIVE, nervous, bodies=BODIES).reasons
    assert any("the loop of first" in reason for reason in reasons)


def test_a_motion_read_from_a_file_needs_no_hand_path(tmp_path):
    solution = solved()
    motion = ArmMotion(solution.arm, solution.time, solution.q)
    both = check(motion), check(solution)
    np.testing.assert_array_equal(both[0].tracking.run.q, both[1].tracking.run.q)
    assert check(motion, load_drive()).ok
