"""Data that leave a parameter open, or contradict themselves, are refused with the joint and the way out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from calibrations import ENCODER, POT, device, held
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.device.calibration import JointSetup, Posture, fit_calibration
from armik_sym.device.simulator import Encoder, Potentiometer
from armik_sym.errors import CalibrationError, OptionError, ShapeError

SETUPS = [JointSetup("elbow", 0), JointSetup("flexion", 1)]
SENSORS = [Potentiometer(noise=1.0), Encoder(start=5)]


def fit(postures: list[Posture], **options: float) -> None:
    fit_calibration(device(POT, ENCODER), postures, SETUPS, **options)


@given(moved=st.floats(0, 29.9), other=st.booleans())
def test_joint_that_did_not_move_enough_is_named_with_both_angles(moved: float, other: bool) -> None:
    angles = [(0, 0), (moved, 90)] if other else [(0, 0), (90, moved)]
    postures = held(SENSORS, angles, ["elbow", "flexion"], samples=50)
    name = "elbow" if other else "flexion"
    with pytest.raises(
        CalibrationError, match=rf"'{name}' has to be moved.*{moved:.1f}° apart.*30.0° are needed"
    ):
        fit(postures)


def test_joint_without_a_known_angle_is_named() -> None:
    postures = [
        Posture(p.name, {"elbow": p.angles["elbow"]}, p.counts)
        for p in held(SENSORS, [(0, 0), (90, 90)], ["elbow", "flexion"])
    ]
    with pytest.raises(CalibrationError, match="'flexion': no posture says its angle"):
        fit(postures)


def test_counts_that_stand_still_while_the_joint_is_said_to_move() -> None:
    (zero, bent) = held(SENSORS, [(0, 0), (90, 90)], ["elbow", "flexion"])
    table = bent.table.copy()
    table[:, 0] = zero.table[:, 0]
    with pytest.raises(
        CalibrationError, match=r"'elbow' has to be moved: .*90.0°, but channel 0 moved by 0.0 counts"
    ):
        fit([zero, Posture("bent", bent.angles, table)])


def test_scale_that_stays_uncertain_asks_for_a_wider_move() -> None:
    postures = held(SENSORS, [(0, 0), (40, 90)], ["elbow", "flexion"])
    with pytest.raises(
        CalibrationError, match=r"'elbow' has to be moved further: .*40.0° apart.*uncertain by \d+ %"
    ):
        fit(postures, angle_error=math.radians(4))


@pytest.mark.parametrize("k", [0, 2, 4])
def test_posture_typed_wrongly_is_found_and_its_angle_told(k: int) -> None:
    true = [0, 25, 50, 75, 100]
    postures = held(SENSORS, [(angle, angle) for angle in true], ["elbow", "flexion"])
    typed = dict(postures[k].angles) | {"elbow": math.radians(true[k] + 40)}
    postures[k] = Posture("wrong one", typed, postures[k].counts)
    with pytest.raises(CalibrationError) as caught:
        fit(postures)
    message = str(caught.value)
    assert "'elbow': posture 'wrong one'" in message
    assert f"given as {true[k] + 40:.1f}°" in message
    said = float(message.split("postures say ")[1].split("°")[0])
    assert abs(said - true[k]) < 0.5


def test_three_postures_that_contradict_each_other() -> None:
    postures = held(SENSORS, [(0, 0), (45, 45), (90, 90)], ["elbow", "flexion"])
    postures[1] = Posture(
        "half", {"elbow": math.radians(70), "flexion": math.radians(45)}, postures[1].counts
    )
    with pytest.raises(CalibrationError, match="'elbow': its postures contradict each other"):
        fit(postures)


def test_strongly_bent_characteristic_is_refused_as_such() -> None:
    angles = np.linspace(-60, 60, 9)
    counts = 2048 + angles / 345 * 4096 * (1 + angles / 300)
    postures = [
        Posture(f"p{k}", {"elbow": math.radians(a)}, [[round(c), 0]])
        for k, (a, c) in enumerate(zip(angles, counts, strict=True))
    ]
    with pytest.raises(CalibrationError, match="'elbow': its angle is no straight line"):
        fit_calibration(device(POT, ENCODER), postures, SETUPS[:1])


def test_dead_zone_of_a_potentiometer_that_is_held_in_it() -> None:
    for level in (0, 4095):
        postures = [Posture("zero", {"elbow": 0.0}, [[2000, 0]]), Posture("up", {"elbow": 1.5}, [[level, 0]])]
        with pytest.raises(
            CalibrationError, match=r"posture 'up': the potentiometer of joint 'elbow'.*dead zone"
        ):
            fit_calibration(device(POT, ENCODER), postures, SETUPS[:1])
    floating = held([Potentiometer(mounting=0.1)], [[0], [-15]], ["elbow"])
    with pytest.raises(CalibrationError, match=r"posture 'posture 1'.*off its track"):
        fit_calibration(device(POT), floating, SETUPS[:1])


def test_half_a_turn_between_two_postures_may_go_either_way_round() -> None:
    with pytest.raises(CalibrationError, match="either way round"):
        fit(held(SENSORS, [(-85, 0), (95, 90)], ["elbow", "flexion"]))
    fit(held(SENSORS, [(-85, 0), (10, 50), (95, 90)], ["elbow", "flexion"]))


def test_scale_that_no_sensor_has() -> None:
    zero, bent = held(SENSORS, [(0, 0), (90, 90)], ["elbow", "flexion"])
    typed = {"elbow": math.radians(40), "flexion": math.radians(90)}
    with pytest.raises(CalibrationError, match=r"'elbow': .*all counts would be 153°, expected 200° to 365°"):
        fit([zero, Posture("bent", typed, bent.counts)])


def test_direction_given_that_the_postures_contradict() -> None:
    postures = held(SENSORS, [(0, 0), (90, 90)], ["elbow", "flexion"])
    setups = [JointSetup("elbow", 0), JointSetup("flexion", 1, direction=-1)]
    with pytest.raises(CalibrationError, match="'flexion': its counts were said to fall"):
        fit_calibration(device(POT, ENCODER), postures, setups)


def test_lost_counts_between_postures_show_at_the_index() -> None:
    a = Posture("a", {"flexion": 0.0}, [[0, 100]], {1: 60})
    good = Posture("b", {"flexion": math.radians(90)}, [[0, 1100]], {1: 4062})
    bad = Posture("b", {"flexion": math.radians(90)}, [[0, 1100]], {1: 4160})
    setups = [SETUPS[1]]
    assert fit_calibration(device(POT, ENCODER), [a, good], setups).joints[0].index == 60
    with pytest.raises(
        CalibrationError, match="posture 'b': the index pulse of joint 'flexion' came 100 counts off"
    ):
        fit_calibration(device(POT, ENCODER), [a, bad], setups)


def test_wrong_arguments() -> None:
    posture = Posture("a", {"elbow": 0.0}, [[1, 2]])
    with pytest.raises(CalibrationError, match="gives the angle of 'elbow', which is no joint"):
        fit_calibration(device(POT, ENCODER), [posture], [SETUPS[1]])
    with pytest.raises(CalibrationError, match="'elbow' is said to be on channel 3"):
        fit_calibration(device(POT), [posture], [JointSetup("elbow", 3)])
    with pytest.raises(CalibrationError, match=r"'flexion' is said to be on channel 1|on channel 1"):
        fit_calibration(device(POT), [posture], SETUPS)
    with pytest.raises(OptionError, match="angle_error"):
        fit([posture], angle_error=-1.0)
    with pytest.raises(ShapeError, match="whole numbers"):
        Posture("a", {}, [[1.5]])
    with pytest.raises(ShapeError, match="whole numbers"):
        Posture("a", {}, [[70000]])
    with pytest.raises(CalibrationError, match="angle of 'elbow' is nan"):
        Posture("a", {"elbow": math.nan}, [[1]])
