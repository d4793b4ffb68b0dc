"""Device angles to human angles and back: eq. (8) right in every quadrant."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames

H = np.diag([-1.0, 1.0, -1.0])
MANY = np.random.default_rng(0).uniform(-np.pi, np.pi, (100_000, 3))
RIGHT = np.pi / 2


def B(q):
    """R_0^3 of the device by multiplying transforms, not by the expressions under test."""
    arm = ak.catalog.ehmcs()
    postures = np.concatenate([q, np.zeros((len(q), 4))], axis=1)
    return joint_frames(arm.chain, postures, arm.lengths)[:, 3, :3, :3]


def C(p):
    """Ry(-q'1) Rz(-q'2) Ry(-q'3), typed from the three turns."""

    def about_y(angle):
        c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
        rows = [[c, zero, s], [zero, one, zero], [-s, zero, c]]
        return np.moveaxis(np.array(rows), -1, 0)

    def about_z(angle):
        c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
        rows = [[c, -s, zero], [s, c, zero], [zero, zero, one]]
        return np.moveaxis(np.array(rows), -1, 0)

    return about_y(-p[:, 0]) @ about_z(-p[:, 1]) @ about_y(-p[:, 2])


def printed_equation_8(q):
    """As printed, with tan(q1/2) instead of its square in the two factors under the first root."""
    q1, q2, q3 = q.T
    t1, t2, t3, u = np.tan(q1 / 2), np.tan(q2 / 2), np.tan(q3 / 2), np.tan(q2 / 2 - np.pi / 4)
    total = t1**2 + u**2 + t1**2 * u**2 + 1
    root = np.sqrt((total - 4 * t1 * u) * (total + 4 * t1 * u))
    p1 = -2 * np.arctan((2 * u - 2 * t1**2 * u + root) / (t1**2 - u**2 - t1**2 * u**2 + 1))
    v = np.sqrt(-(np.cos(q2) ** 2 * np.sin(q1) ** 2 - 1) / (np.cos(q1 / 2) ** 4 * (np.sin(q2) + 1) ** 2))
    p2 = -2 * np.arctan((np.cos(q1) + 1) * (np.sin(q2) + 1) * v / (2 * (np.cos(q2) * np.sin(q1) + 1)))
    s2 = np.sin(q2)
    above = (
        2 * t3 + v + t3**2 * v - 2 * t1**2 * t3 + s2 * v + 2 * t1 * s2 + t3**2 * s2 * v - 2 * t1 * t3**2 * s2
    )
    below = (
        t1**2 - t2**2 + t3**2 + t1**2 * t2**2 - t1**2 * t3**2 + t2**2 * t3**2
        + 8 * t1 * t2 * t3 - t1**2 * t2**2 * t3**2 - 1
    )  # fmt: skip
    p3 = -2 * np.arctan((t2 + 1) ** 2 * above / ((s2 + 1) * below))
    return np.stack([p1, p2, p3], axis=1)


def apart(a, b):
    """Largest difference modulo full turns."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi)


def test_the_matrix_identity_holds_for_100_000_random_angles_in_all_quadrants():
    p = ak.elbow.device_to_human(MANY)
    assert np.abs(H @ B(MANY) @ H - C(p)).max() < 1e-12
    assert p[:, 1].max() <= 0
    assert p[:, 1].min() >= -np.pi
    assert np.abs(p[:, [0, 2]]).max() <= np.pi
    for quadrants in ((-1, 1), (1, -1), (-1, -1), (1, 1)):
        assert (np.sign(np.sin(p[:, 0])) == quadrants[0]).any()
        assert (np.sign(np.cos(p[:, 2])) == quadrants[1]).any()


def test_it_equals_equation_8_with_its_exponent_mended():
    p = ak.elbow.device_to_human(MANY)
    printed = printed_equation_8(MANY)
    # Half-angle tangents lose digits where a tangent or the matrix's own singularity is near.
    regular = np.abs(np.sin(p[:, 1])) > 1e-2
    regular &= np.abs(MANY).max(axis=1) < np.pi - 1e-2
    regular &= np.abs(np.sin(MANY[:, 1]) + 1) > 1e-3
    assert regular.mean() > 0.9
    assert apart(printed, p)[regular].max() < 1e-6
    assert np.median(apart(printed, p)[regular]) < 1e-14


def test_human_to_device_undoes_it():
    back = ak.elbow.human_to_device(ak.elbow.device_to_human(MANY))
    assert np.abs(B(back) - B(MANY)).max() < 1e-12
    own = np.abs(MANY[:, 1]) < RIGHT - 1e-3
    assert np.abs(back - MANY)[own].max() < 1e-9
    near = ak.elbow.human_to_device(ak.elbow.device_to_human(MANY), neighbour=MANY)
    regular = np.abs(np.cos(MANY[:, 1])) > 1e-3
    assert np.abs(near - MANY)[regular].max() < 1e-9


def test_device_to_human_undoes_human_to_device():
    near = ak.elbow.device_to_human(ak.elbow.human_to_device(MANY), neighbour=MANY)
    regular = np.abs(np.sin(MANY[:, 1])) > 1e-3
    assert np.abs(near - MANY)[regular].max() < 1e-9


angle = st.floats(-7, 7) | st.sampled_from(
    [0.0, RIGHT, -RIGHT, np.pi, -np.pi, 1e-9, RIGHT - 1e-9, RIGHT + 1e-13]
)


@given(st.tuples(angle, angle, angle))
def test_both_directions_hold_at_and_next_to_their_singularities(q):
    q = np.array([q])
    p = ak.elbow.device_to_human(q)
    assert np.abs(H @ B(q) @ H - C(p)).max() < 1e-12
    assert np.abs(B(ak.elbow.human_to_device(q)) - H @ C(q) @ H).max() < 1e-12
    near = ak.elbow.device_to_human(q, neighbour=[1.0, -2.0, 3.0])
    assert np.abs(H @ B(q) @ H - C(near)).max() < 1e-12
    assert np.abs(near[0, [0, 2]] - [1.0, 3.0]).max() <= 2 * np.pi


def test_where_the_first_angle_is_free_it_stays_with_the_neighbour():
    on_the_axis = np.array([[RIGHT, 0.0, 0.4]])
    p = ak.elbow.device_to_human(on_the_axis, neighbour=[0.7, -0.1, 0.2])
    assert p[0, 0] == 0.7
    assert abs(p[0, 1]) < 1e-12
    assert np.abs(H @ B(on_the_axis) @ H - C(p)).max() < 1e-12
    assert ak.elbow.device_to_human(on_the_axis)[0, 0] == 0.0


def test_a_path_through_the_singularity_stays_continuous():
    p = np.stack([np.full(201, 0.3), np.linspace(-0.5, 0.5, 201), np.full(201, -0.8)], axis=1)
    q = ak.elbow.human_to_device(p)
    followed = ak.elbow.device_to_human(q, neighbour=p[0])
    assert np.abs(followed - p).max() < 1e-9
    branch = ak.elbow.device_to_human(q)
    assert np.abs(np.diff(branch, axis=0)).max() > 2.8, "the branch of eq. (8) jumps there"


def test_a_path_over_many_turns_stays_continuous():
    q = np.linspace([0.1, 0.2, 0.3], [40.0, 1.2, -30.0], 2_000)
    p = ak.elbow.device_to_human(q, neighbour=ak.elbow.device_to_human(q[0]))
    assert np.abs(np.diff(p, axis=0)).max() < 0.3
    assert np.abs(H @ B(q) @ H - C(p)).max() < 1e-12


def test_one_neighbour_per_sample():
    q = MANY[:100]
    turned = ak.elbow.device_to_human(q) + 2 * np.pi
    np.testing.assert_allclose(ak.elbow.device_to_human(q, neighbour=turned), turned, atol=1e-12)


def test_a_single_sample_answers_without_the_leading_axis():
    assert ak.elbow.device_to_human(MANY[0]).shape == (3,)
    assert ak.elbow.human_to_device(MANY[0], neighbour=MANY[1]).shape == (3,)
    np.testing.assert_array_equal(ak.elbow.device_to_human(MANY[0]), ak.elbow.device_to_human(MANY[:5])[0])
    assert ak.elbow.device_to_human(np.zeros((0, 3))).shape == (0, 3)
    assert ak.elbow.device_to_human(np.zeros((0, 3)), neighbour=[0, 0, 0]).shape == (0, 3)


@pytest.mark.parametrize("dof", [3, 4, 7])
def test_whole_postures_bring_hand_and_elbow_to_the_same_place(dof):
    device = ak.catalog.ehmcs()
    human = ak.catalog.human(upper_arm=device.lengths["upper_arm"], forearm=device.lengths["forearm"], hand=0)
    q = np.random.default_rng(2).uniform(device.rom.lower, device.rom.upper, (500, 7))
    q[:, dof:] = 0
    converted = np.zeros_like(q)
    converted[:, :dof] = ak.elbow.human_posture(q[:, :dof])
    np.testing.assert_array_equal(converted[:, 3:], q[:, 3:])
    on_device = hand_pose(device.chain, q, device.lengths)
    on_human = hand_pose(human.chain, converted, human.lengths)
    base_to_shoulder = [0, 0, 0.143]
    np.testing.assert_allclose(on_device[0] - base_to_shoulder, on_human[0], atol=1e-12)
    np.testing.assert_allclose(on_device[1], on_human[1], atol=1e-12)


def test_postures_survive_the_way_there_and_back():
    rom = ak.catalog.ehmcs().rom
    q = np.random.default_rng(4).uniform(0.999 * rom.lower, 0.999 * rom.upper, (2_000, 7))
    there = ak.elbow.human_posture(q)
    np.testing.assert_allclose(ak.elbow.device_posture(there), q, atol=1e-9)
    back = ak.elbow.human_posture(ak.elbow.device_posture(there, q[0, :3]))
    np.testing.assert_allclose(back, there, atol=1e-9)
    np.testing.assert_allclose(ak.elbow.human_posture(np.zeros(7)), np.zeros(7), atol=1e-15)


def test_of_two_solutions_the_one_inside_the_range_of_motion_is_taken():
    rom = ak.catalog.human().rom
    inside = np.random.default_rng(5).uniform(0.999 * rom.lower, 0.999 * rom.upper, (2_000, 7))
    found = ak.elbow.human_posture(ak.elbow.device_posture(inside))
    np.testing.assert_allclose(found, inside, atol=1e-9)


@pytest.mark.parametrize("samples", [20, 600])
def test_raising_the_arm_beside_the_singularity_does_not_depend_on_the_sampling(samples):
    q = np.zeros((samples, 3))
    q[:, 0], q[:, 1] = np.deg2rad(np.linspace(0, 170, samples)), np.deg2rad(1)
    last = np.rad2deg(ak.elbow.human_posture(q)[-1])
    np.testing.assert_allclose(last, [-1, 170, 0], atol=0.3)


def test_with_a_neighbour_a_posture_path_is_continuous():
    q = np.zeros((600, 4))
    q[:, 0], q[:, 1] = np.deg2rad(np.linspace(0, 170, 600)), np.deg2rad(10)
    path = ak.elbow.human_posture(q, neighbour=[0, 0, 0])
    assert np.abs(np.diff(path, axis=0)).max() < np.deg2rad(3)
    back = ak.elbow.device_posture(path, neighbour=q[0, :3])
    np.testing.assert_allclose(back, q, atol=1e-9)


def test_plain_movements_keep_their_names():
    flexed = ak.elbow.human_posture([0.0, 0.8, 0.0])
    np.testing.assert_allclose(flexed, [0.8, 0, 0], atol=1e-12)
    abducted = ak.elbow.human_posture([0.8, 0.0, 0.0])
    np.testing.assert_allclose(abducted, [0, 0.8, 0], atol=1e-12)
    np.testing.assert_allclose(ak.elbow.human_posture([2.1, 0.0, 0.0]), [0, 2.1, 0], atol=1e-12)


def test_the_matrices_are_symbolic_functions():
    q = ca.SX.sym("q", 3)
    values = ca.Function("B", [q], [ak.elbow.device_elbow_direction(q), ak.elbow.human_elbow_direction(q)])
    for sample in MANY[:20]:
        device, human = (np.asarray(value) for value in values(sample))
        np.testing.assert_allclose(device, B(sample[np.newaxis])[0], atol=1e-14)
        np.testing.assert_allclose(human, C(sample[np.newaxis])[0], atol=1e-14)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ak.elbow.device_to_human(np.zeros((4, 7))), r"shape \(4, 7\), expected \(n, 3\) or \(3,\)"),
        (lambda: ak.elbow.device_to_human([0, np.nan, 0]), "angle 2 is nan, expected a finite number"),
        (lambda: ak.elbow.human_to_device([[0, 0, 0], [0, 0, np.inf]]), "angle 3 of sample 1 is inf"),
        (lambda: ak.elbow.device_to_human(np.zeros((4, 3)), np.zeros((3, 3))), r"or \(4, 3\), one per"),
        (
            lambda: ak.elbow.device_to_human(["a", "b", "c"]),
            "'a', 'b', 'c'.*expected an array of real numbers",
        ),
        (lambda: ak.elbow.device_to_human([[1, 2, 3], [1, 2]]), "expected an array of real numbers"),
        (lambda: ak.elbow.device_to_human([1j, 0, 0]), "expected an array of real numbers"),
        (lambda: ak.elbow.human_posture([0.0, 1.0]), r"human_posture.*\(2,\), expected \(n, k\) or \(k,\)"),
        (
            lambda: ak.elbow.human_posture([[0, 0, 0], [0, np.nan, 0]]),
            "human_posture.*angle 2 of sample 1",
        ),
        (lambda: ak.elbow.device_posture([0, 0, 0], [0, 0]), r"device_posture, neighbour: shape \(2,\)"),
    ],
)
def test_wrong_input_is_named(call, message):
    with pytest.raises(ak.ArmikError, match=message):
        call()
