"""What a posture costs: against plain NumPy and forward kinematics; derivatives; C and virtual machine."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sample_arms
import spherical_arms
from compiled_helpers import build_strictly, needs_cc
from hypothesis import given
from hypothesis import strategies as st

import armik_sym as ak
from armik_sym.arm import Arm, DHChain, DHLink, RangeOfMotion
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.library_source import casadi_library
from armik_sym.errors import OptionError, ShapeError
from armik_sym.swivel.axis_lines import turned
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.symbolic import express
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.posture_cost import cost as cost_module
from armik_sym.trajectory.posture_cost import posture_cost, preferred_posture
from armik_sym.trajectory.posture_cost.expressions import cost_functions

ARMS = {**sample_arms.ARMS, **spherical_arms.ARMS}
SPHERICAL = sorted(spherical_arms.ARMS)
ASIDE = np.array([0.6, -0.48, 0.64])


def cost_of(arm, backend="vm", **options):
    return posture_cost(arm, TrajectoryOptions(**options), backend)


def clearance_by_hand(arm, q, clearance, weight):
    """½ Σ w φ(distance/clearance), joint by joint in the plainest way."""
    total = 0.0
    for j in range(arm.dof):
        half = 0.5 * (arm.rom.upper[j] - arm.rom.lower[j])
        c = min(clearance[j], half)
        if c == 0:
            continue
        distance = min(q[j] - arm.rom.lower[j], arm.rom.upper[j] - q[j])
        if distance < c:
            total += 0.5 * weight * (c / clearance[j]) ** 2 * (1 - distance / c) ** 3
    return total


def elbow_by_axes(arm, q):
    """Unit vectors from shoulder to elbow as a product of turns about the lines of the joints."""
    spherical = recognise(arm)
    R = np.eye(3)
    for direction, angle in zip(spherical.lines.direction[:3], q.T[:3], strict=True):
        R = R @ turned(direction, angle)
    u = R @ spherical.upper_arm
    return u / np.linalg.norm(spherical.upper_arm)


def derivatives(cost, q):
    """Value, gradient and Hessian of one posture."""
    at = (q, cost.lengths, cost.parameters)
    dof = len(q)
    gradient = np.asarray(cost.gradient(*at)).ravel()
    return float(cost.value(*at)), gradient, np.asarray(cost.hessian(*at)).reshape(dof, dof)


def differences(cost, q, h=1e-6):
    """The same gradient and Hessian by central differences."""
    rows = [(derivatives(cost, q + h * e), derivatives(cost, q - h * e)) for e in np.eye(len(q))]
    gradient = np.array([(a[0] - b[0]) / (2 * h) for a, b in rows])
    return gradient, np.array([(a[1] - b[1]) / (2 * h) for a, b in rows])


@pytest.mark.parametrize("name", ["ehmcs", "human", "alfaiz", "custom_standard", "bare"])
def test_clearance_is_the_stated_sum(name):
    arm = sample_arms.BARE if name == "bare" else ARMS[name]
    wanted = np.random.default_rng(2).uniform(0.05, 0.6, arm.dof)
    cost = cost_of(arm, clearance_weight=3.0, clearance=wanted)
    q = sample_arms.postures(arm, 200, 4)
    expected = [clearance_by_hand(arm, row, wanted, 3.0) for row in q]
    assert np.max(expected) > 0.5
    np.testing.assert_allclose(cost.evaluate(q), expected, rtol=1e-13, atol=1e-13)


def test_limits_cost_half_the_weight_and_the_rest_of_the_range_nothing():
    arm, c = ARMS["ehmcs"], math.radians(10)
    cost = cost_of(arm, clearance_weight=2.0)
    assert cost.evaluate(arm.rom.middle[None])[0] == 0
    for j in range(arm.dof):
        for limit, inwards in ((arm.rom.lower[j], 1), (arm.rom.upper[j], -1)):
            q = np.tile(arm.rom.middle, (4, 1))
            q[:, j] = limit + inwards * c * np.array([0, 0.5, 1 - 1e-9, 1 + 1e-9])
            np.testing.assert_allclose(cost.evaluate(q), [1, 0.125, 0, 0], rtol=1e-12, atol=1e-24)
            assert cost.evaluate(q)[3] == 0


@given(width=st.floats(0, 1.0))
def test_joints_with_little_room_cost_nothing_in_the_middle_and_never_more_than_others(width):
    arm = ARMS["human"]
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[4], upper[4] = 0.3, 0.3 + width
    arm = arm.with_rom(lower, upper)
    cost = cost_of(arm, clearance_weight=2.0)
    q = np.tile(arm.rom.middle, (21, 1))
    q[:, 4] = np.linspace(lower[4], upper[4], 21)
    values = cost.evaluate(q)
    half = min(width / 2, math.radians(10)) / math.radians(10)
    assert values[10] == pytest.approx(0, abs=1e-30)
    assert values.max() <= 1.0 + 1e-12
    assert values[0] == pytest.approx(half**2 if width > 1e-8 else 0, abs=1e-12)
    hessian = derivatives(cost, q[0])[2]
    assert np.linalg.eigvalsh(hessian).max() <= cost.curvature * (1 + 1e-12)


def test_one_clearance_is_for_joints_that_turn_only():
    arm = ARMS["custom_standard"]
    slides = [0, 3]
    one = cost_of(arm, clearance_weight=1.0, clearance=0.1)
    q = np.tile(arm.rom.middle, (2, 1))
    q[0, slides] = arm.rom.lower[slides]
    q[1, 1] = arm.rom.lower[1]
    np.testing.assert_allclose(one.evaluate(q), [0, 0.5], atol=1e-15)
    each = cost_of(arm, clearance_weight=1.0, clearance=[0.1, 0.0, 0.1, 0.1, 0.1])
    np.testing.assert_allclose(each.evaluate(q), [1.0, 0.0], atol=1e-15)


@pytest.mark.parametrize("name", [*SPHERICAL, "ehmcs_4dof", "ehmcs_5dof"])
def test_elbow_term_is_the_stated_angle(name):
    arm = ARMS[name].with_lengths(**{key: 1.3 * value for key, value in list(ARMS[name].lengths.items())[:1]})
    cost = cost_of(arm, prefer=7 * ASIDE, prefer_weight=4.0)
    q = sample_arms.postures(arm, 50, 6, stretch=1.5)
    expected = 0.5 * 4.0 * (1 - elbow_by_axes(arm, q) @ ASIDE)
    np.testing.assert_allclose(cost.evaluate(q), expected, rtol=1e-12, atol=1e-13)
    assert np.ptp(expected) > 2


@pytest.mark.parametrize(
    ("arm", "to_elbow", "shoulder"),
    [
        (ehmcs(), ehmcs(4).with_lengths(forearm=0.0), [0, 0, 0.143]),
        (human(), human(forearm=0.0, hand=0.0), [0, 0, 0]),
        (alfaiz(), alfaiz(forearm=0.0), [0, 0, 0]),
    ],
)
def test_words_mean_what_they_say(arm, to_elbow, shoulder):
    """With a forearm of no length the hand is the elbow: forward kinematics says where it points."""
    q = sample_arms.postures(arm, 100, 8)
    elbow = hand_pose(to_elbow.chain, q[:, : to_elbow.dof], to_elbow.lengths)[0] - shoulder
    u = elbow / np.linalg.norm(elbow, axis=1)[:, None]
    directions = {"elbow_high": arm.up, "elbow_low": -arm.up}
    if arm.outward is not None:
        directions |= {"elbow_out": arm.outward, "elbow_in": -arm.outward}
    for word, d in directions.items():
        cost = cost_of(arm, prefer=word, prefer_weight=2.0)
        np.testing.assert_allclose(cost.evaluate(q), 1 - u @ d, atol=1e-14)


@pytest.mark.parametrize(("arm", "abduction"), [(ehmcs(), 0), (human(), 1)])
def test_the_hanging_elbow_is_low_and_abduction_brings_it_out(arm, abduction):
    assert arm.joint_names[abduction] == "shoulder_abduction"
    q = np.zeros((2, 7))
    q[1, abduction] = np.pi / 2
    for word, values in (("elbow_low", [0, 1]), ("elbow_out", [1, 0]), ("elbow_in", [1, 2])):
        cost = cost_of(arm, prefer=word, prefer_weight=2.0)
        np.testing.assert_allclose(cost.evaluate(q), values, atol=1e-14)


OPTIONS = [
    {"clearance_weight": 2.0, "clearance": 0.5},
    {"prefer": ASIDE},
    {"clearance_weight": 0.7, "clearance": 0.4, "prefer": ASIDE, "prefer_weight": 3.0},
]


@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("name", SPHERICAL)
def test_derivatives_equal_finite_differences(name, options):
    arm = ARMS[name]
    cost = cost_of(arm, **options)
    lower, upper, middle = arm.rom.lower, arm.rom.upper, arm.rom.middle
    places = [*sample_arms.postures(arm, 8, 1), *sample_arms.postures(arm, 4, 2, stretch=1.3)]
    places += [lower, upper, middle, np.zeros(arm.dof), lower + 1e-9, upper - 0.01]
    for q in places:
        _, gradient, hessian = derivatives(cost, q)
        by_value, by_gradient = differences(cost, q)
        np.testing.assert_allclose(gradient, by_value, rtol=1e-6, atol=1e-8)
        np.testing.assert_allclose(hessian, by_gradient, rtol=1e-5, atol=2e-4)
        np.testing.assert_array_equal(hessian, hessian.T)
        if np.all(arm.rom.margin(q) >= 0):
            assert np.abs(np.linalg.eigvalsh(hessian)).max() <= cost.curvature * (1 + 1e-9)


def test_second_derivative_is_continuous_where_the_clearance_begins():
    arm, c = ARMS["ehmcs"], 0.3
    cost = cost_of(arm, clearance_weight=1.0, clearance=c)
    for j in range(arm.dof):
        for edge in (arm.rom.lower[j] + c, arm.rom.upper[j] - c):
            for aside in (-1e-7, 0.0, 1e-7):
                q = arm.rom.middle
                q[j] = edge + aside
                value, gradient, hessian = derivatives(cost, q)
                assert value < 1e-15
                assert np.abs(gradient).max() < 1e-10
                assert np.abs(hessian).max() < 1e-4
    inside = arm.rom.middle
    inside[0] = arm.rom.lower[0] + c / 2
    assert derivatives(cost, inside)[2][0, 0] == pytest.approx(0.5 * 6 * 0.5 / c**2)


@needs_cc
@pytest.mark.parametrize("options", OPTIONS)
@pytest.mark.parametrize("name", ["human", "odd_modified"])
def test_compiled_code_and_virtual_machine_agree(name, options):
    arm = ARMS[name]
    c, vm = (cost_of(arm, backend, **options) for backend in ("c", "vm"))
    assert (c.backend, vm.backend) == ("c", "vm")
    q = sample_arms.postures(arm, 600, 3)
    np.testing.assert_allclose(c.evaluate(q), vm.evaluate(q), rtol=1e-13, atol=1e-14)
    for row in q[:20]:
        for mine, other in zip(derivatives(c, row), derivatives(vm, row), strict=True):
            np.testing.assert_allclose(mine, other, rtol=1e-12, atol=1e-12)
    each = [derivatives(vm, row)[0] for row in q[:20]]
    np.testing.assert_allclose(c.evaluate(q[:20]), each, rtol=1e-13, atol=1e-14)


@needs_cc
def test_generated_code_is_clean_c(tmp_path):
    build_strictly(casadi_library(cost_functions(express(ARMS["ehmcs"]), elbow=True)), tmp_path)


@pytest.mark.parametrize("backend", ["vm", pytest.param("c", marks=needs_cc)])
def test_other_lengths_limits_and_choices_compile_nothing(backend):
    arm = ARMS["human"]
    first = cost_of(arm, backend, prefer="elbow_low")
    known = cost_module._program.cache_info().misses
    other = arm.with_lengths(forearm=0.2, upper_arm=0.33).with_rom(arm.rom.lower / 2, arm.rom.upper / 2)
    second = cost_of(other, backend, prefer=[1, 2, 3], clearance_weight=1.0, prefer_weight=0.5)
    assert cost_module._program.cache_info().misses == known
    assert second.value is first.value
    assert second.hessian is first.hessian


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"clearance": 0.5, "prefer_weight": 9.0},
        {"prefer": "elbow_out", "prefer_weight": 0},
        {"prefer": np.zeros(7)},
        {"clearance_weight": 5.0, "clearance": 0},
    ],
)
def test_what_costs_nothing_compiles_nothing(options, monkeypatch):
    monkeypatch.setattr(cost_module, "_program", None)
    assert cost_of(ARMS["ehmcs"], "c", **options) is None


def test_a_direction_counts_whatever_its_length():
    arm, q = ARMS["ehmcs"], sample_arms.postures(ARMS["ehmcs"], 5)
    values = [cost_of(arm, prefer=size * ASIDE).evaluate(q) for size in (1.0, 1e-200, 1e200)]
    np.testing.assert_allclose(values[1:], [values[0]] * 2, rtol=1e-14)
    assert cost_of(arm, prefer=[0, 0, 1]).evaluate(q) == pytest.approx(
        cost_of(arm, prefer=(0.0, 0.0, 2.0)).evaluate(q)
    )


def test_many_postures_or_none():
    cost = cost_of(ARMS["ehmcs"], prefer="elbow_low")
    assert cost.evaluate(np.empty((0, 7))).shape == (0,)
    for wrong in (np.zeros(7), np.zeros((3, 6)), np.zeros((7, 1))):
        with pytest.raises(ShapeError, match=r"expected \(n, 7\)"):
            cost.evaluate(wrong)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        (
            "alfaiz",
            {"prefer": "elbow_out"},
            "'elbow_out', but arm 'alfaiz' does not say where outward is: give",
        ),
        (
            "odd_standard",
            {"prefer": "elbow_low"},
            "'odd_standard' does not say where up is: give the direction",
        ),
        (
            "custom_standard",
            {"prefer": "elbow_low"},
            "direction of the elbow, but .*'lift' shifts.*only a post",
        ),
        ("custom_standard", {"prefer": [0, 0, 1]}, "only a posture can be preferred: 5 angles"),
        ("ehmcs", {"prefer": [0, 0, 0]}, "vector 0, 0, 0, which points nowhere"),
        ("ehmcs", {"clearance": [0.1] * 6, "clearance_weight": 1}, "clearance has 6 numbers, but .*7 joints"),
    ],
)
def test_options_that_do_not_fit_the_arm(name, options, message):
    with pytest.raises(OptionError, match=message):
        cost_of(ARMS[name], **options)


def test_three_numbers_are_a_posture_where_there_is_no_elbow():
    rows = tuple(DHLink(name, a=0.2) for name in ("a", "b", "c"))
    arm = Arm("three", DHChain(rows), RangeOfMotion([-1, -1, -1], [1, 2, 1]))
    assert cost_of(arm, prefer=[0.1, 0.2, 0.3]) is None
    np.testing.assert_array_equal(preferred_posture(arm, [0.1, 0.2, 0.3]), [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(preferred_posture(arm, None), [0, 0.5, 0])
    with pytest.raises(
        OptionError, match=r"prefer has 7 numbers, but arm 'three' has 3 joints: .* in .rad.$"
    ):
        preferred_posture(arm, [0] * 7)


TASK = ak.load_task("playing_ball")
EHMCS = ehmcs()


def elbow_of(solution):
    return elbow_by_axes(solution.arm, solution.q)


@pytest.mark.parametrize("backend", ["vm", pytest.param("c", marks=needs_cc)])
def test_clearance_keeps_clear_of_a_limit_that_the_motion_otherwise_touches(backend):
    free = ak.solve(EHMCS, TASK.path)
    upper = EHMCS.rom.upper.copy()
    j = EHMCS.joint_index("shoulder_internal_rotation")
    upper[j] = free.q[:, j].max() - math.radians(5)
    tight = EHMCS.with_rom(EHMCS.rom.lower, upper)
    touching = ak.solve(tight, TASK.path, backend=backend)
    clear = ak.solve(tight, TASK.path, backend=backend, clearance_weight=10.0)
    assert touching.ok
    assert clear.ok
    assert tight.rom.margin(touching.q).min() < math.radians(0.01)
    assert tight.rom.margin(clear.q).min() > math.radians(3)


def test_the_elbow_goes_where_it_is_preferred():
    plain = elbow_of(ak.solve(EHMCS, TASK.path))
    for word, d in (("elbow_low", -EHMCS.up), ("elbow_high", EHMCS.up), ("elbow_out", EHMCS.outward)):
        solution = ak.solve(EHMCS, TASK.path, prefer=word)
        assert solution.ok, solution.reasons
        moved = np.rad2deg(np.arccos(np.clip(np.sum(plain * elbow_of(solution), axis=1), -1, 1)))
        assert (elbow_of(solution) @ d).mean() > (plain @ d).mean() + 0.05
        assert moved.max() > 10
    high = ak.solve(EHMCS, TASK.path, prefer="elbow_high", clearance_weight=10.0)
    assert EHMCS.rom.margin(high.q).min() > math.radians(2)


def test_no_weight_no_difference():
    plain = ak.solve(EHMCS, TASK.path)
    same = ak.solve(EHMCS, TASK.path, prefer="elbow_out", prefer_weight=0.0, clearance=0.5)
    assert np.array_equal(plain.q, same.q)
    assert plain.iterations == same.iterations
