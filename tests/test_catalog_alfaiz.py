"""The arm of Al-Faiz against the printed matrices and equations.

In the stored text several subscripts are damaged: the extraction turned most of them into 2 or 3 (and
l4 into l3). Each equation is typed here in the reading that holds, with what was changed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy import pi

from armik_sym.arm.catalog import alfaiz
from armik_sym.arm.dh import DHConvention
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.errors import ArmModelError

L4, L3 = 0.30, 0.24  # upper arm (L4 in Table 1) and forearm (L5 in Table 1, l3 in the equations)
OFFSET = np.array([0, pi / 2, 0, 0, 0, -pi / 2, 0])


def random_postures(n=1000):
    return np.random.default_rng(1).uniform(-pi, pi, (n, 7))


def cosines_and_sines(angles):
    """Lists counted from 1, as in the paper."""
    return [None, *np.cos(angles).T], [None, *np.sin(angles).T]


def matrices(rows):
    return np.moveaxis(np.array(np.broadcast_arrays(*(x for row in rows for x in row))), 0, -1).reshape(
        -1, len(rows), len(rows)
    )


def printed_link_matrices(theta):
    """A_1 … A_7 as printed below Table 1: c and s are "cosine of theta" and "sin of theta"."""
    c, s = cosines_and_sines(theta)

    def towards_minus_y(i, shift=0.0):  # printed for α = +π/2
        return matrices([[c[i], -s[i], 0, shift], [0, 0, -1, 0], [s[i], c[i], 0, 0], [0, 0, 0, 1]])

    def towards_plus_y(i, shift=0.0):  # printed for α = -π/2
        return matrices([[c[i], -s[i], 0, shift], [0, 0, 1, 0], [-s[i], -c[i], 0, 0], [0, 0, 0, 1]])

    return [
        towards_minus_y(1),
        towards_minus_y(2),
        towards_plus_y(3),
        towards_minus_y(4, L4),
        towards_plus_y(5, L3),
        towards_minus_y(6),
        towards_plus_y(7),
    ]


def test_every_link_transform_is_the_printed_matrix_of_theta_with_its_offset():
    arm, q = alfaiz(), random_postures()
    T = joint_frames(arm.chain, q, arm.lengths)
    for i, printed in enumerate(printed_link_matrices(q + OFFSET)):
        np.testing.assert_allclose(np.linalg.inv(T[:, i]) @ T[:, i + 1], printed, rtol=0, atol=1e-13)


def equation_7(c, s, l4=L4, l3=L3):
    """Extracted: -l3(c4(s1s2 + c1c2s2) + c1c2s4) - l4(s1s2 + c1c2s2); the pairs are s1s3 and c1c3s2."""
    reach = s[1] * s[3] + c[1] * c[3] * s[2]
    return -l3 * (c[4] * reach + c[1] * c[2] * s[4]) - l4 * reach


def equation_8(c, s, l4=L4, l3=L3):
    """Extracted: l3(c4(c1s2 - c2s1s2) - c2s1s4) + l4(c1s2 - c2s1s2); the pairs are c1s3 and c3s1s2."""
    reach = c[1] * s[3] - c[3] * s[1] * s[2]
    return l3 * (c[4] * reach - c[2] * s[1] * s[4]) + l4 * reach


def equation_23(c, s, l4=L4, l3=L3):
    """Extracted as it must have been printed."""
    return l3 * (s[2] * s[4] - c[2] * c[3] * c[4]) - l4 * c[2] * c[3]


def test_equations_7_23_and_8_give_the_position_with_sines_of_q_without_offset():
    arm, q = alfaiz(), random_postures()
    c, s = cosines_and_sines(q)
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    printed = np.stack([equation_7(c, s), equation_23(c, s), equation_8(c, s)], axis=1)
    np.testing.assert_allclose(position, printed, rtol=0, atol=1e-13)


@pytest.mark.parametrize("equation", [equation_7, equation_8, equation_23])
def test_sines_of_theta_with_its_offset_miss_the_position(equation):
    arm, q = alfaiz(), random_postures()
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    column = {equation_7: 0, equation_23: 1, equation_8: 2}[equation]
    error = abs(equation(*cosines_and_sines(q + OFFSET)) - position[:, column])
    assert error.max() > 0.5


def test_equations_7_and_8_as_extracted_miss_the_position():
    arm, q = alfaiz(), random_postures()
    c, s = cosines_and_sines(q)
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    reach_7 = s[1] * s[2] + c[1] * c[2] * s[2]
    reach_8 = c[1] * s[2] - c[2] * s[1] * s[2]
    extracted_7 = -L3 * (c[4] * reach_7 + c[1] * c[2] * s[4]) - L4 * reach_7
    extracted_8 = L3 * (c[4] * reach_8 - c[2] * s[1] * s[4]) + L4 * reach_8
    assert abs(extracted_7 - position[:, 0]).max() > 0.5
    assert abs(extracted_8 - position[:, 2]).max() > 0.5


def test_the_lengths_keep_their_places_when_they_change():
    arm, q = alfaiz(upper_arm=0.35, forearm=0.2), random_postures(100)
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    c, s = cosines_and_sines(q)
    np.testing.assert_allclose(position[:, 1], equation_23(c, s, l4=0.35, l3=0.2), rtol=0, atol=1e-13)


def test_equation_6_gives_the_elbow_angle_from_the_distance():
    """Eq. (5) is printed with tg for tg² and a minus sign; eq. (6) holds with tg² and a plus."""
    arm, q = alfaiz(), random_postures()
    position, _ = hand_pose(arm.chain, q, arm.lengths)
    tg2 = (position**2).sum(axis=1)
    np.testing.assert_allclose((tg2 - L4**2 - L3**2) / (2 * L4 * L3), np.cos(q[:, 3]), atol=1e-12)


def equation_38(q):
    """Extracted with most subscripts turned into 2; read from the matrix product's pattern and eq. 39-46."""
    c, s = cosines_and_sines(q)
    return matrices(
        [
            [c[5] * c[7] * s[6] - s[5] * s[7], -c[7] * s[5] - c[5] * s[6] * s[7], c[5] * c[6]],
            [-c[6] * c[7], c[6] * s[7], s[6]],
            [-c[5] * s[7] - c[7] * s[5] * s[6], s[5] * s[6] * s[7] - c[5] * c[7], -c[6] * s[5]],
        ]
    )


def wrist_rotation(chain, arm, q):
    """A_5 A_6 A_7 of eq. (36), its rotation."""
    T = joint_frames(chain, q, arm.lengths)
    return np.swapaxes(T[:, 4, :3, :3], 1, 2) @ T[:, 7, :3, :3]


def test_the_wrist_turns_as_in_equation_38():
    arm, q = alfaiz(), random_postures()
    np.testing.assert_allclose(wrist_rotation(arm.chain, arm, q), equation_38(q), rtol=0, atol=1e-13)


def test_the_wrist_entries_are_those_of_equations_39_to_46():
    arm, q = alfaiz(), random_postures()
    r = wrist_rotation(arm.chain, arm, q)
    c, s = cosines_and_sines(q)
    np.testing.assert_allclose(r[:, 1, 2], s[6], atol=1e-13)  # (39)
    np.testing.assert_allclose(r[:, 0, 2], c[5] * c[6], atol=1e-13)  # (41)
    np.testing.assert_allclose(r[:, 2, 2], -c[6] * s[5], atol=1e-13)  # (42)
    np.testing.assert_allclose(r[:, 1, 0], -c[6] * c[7], atol=1e-13)  # (45)
    np.testing.assert_allclose(r[:, 1, 1], c[6] * s[7], atol=1e-13)  # (46)
    np.testing.assert_allclose(np.tan(q[:, 4]) * r[:, 0, 2], -r[:, 2, 2], atol=1e-10)  # (43)


def test_inside_its_limits_the_wrist_is_recovered_by_equations_40_44_and_47():
    """With a four-quadrant arc tangent; eq. (47) needs both arguments reversed."""
    arm = alfaiz()
    q = np.random.default_rng(3).uniform(0.99 * arm.rom.lower, 0.99 * arm.rom.upper, (1000, 7))
    r = wrist_rotation(arm.chain, arm, q)
    np.testing.assert_allclose(np.arcsin(r[:, 1, 2]), q[:, 5], atol=1e-9)
    np.testing.assert_allclose(np.arctan2(-r[:, 2, 2], r[:, 0, 2]), q[:, 4], atol=1e-9)
    np.testing.assert_allclose(np.arctan2(r[:, 1, 1], -r[:, 1, 0]), q[:, 6], atol=1e-9)


def test_the_alpha_6_of_table_1_does_not_satisfy_equation_38():
    arm, q = alfaiz(), random_postures()
    rows = list(arm.chain.links)
    rows[5] = replace(rows[5], alpha=-pi / 2)
    as_tabled = wrist_rotation(replace(arm.chain, links=tuple(rows)), arm, q)
    error = abs(as_tabled - equation_38(q)).max(axis=(1, 2))
    assert error.max() > 1.9
    assert np.median(error) > 0.5
    assert abs(as_tabled[:, 1, 2] + np.sin(q[:, 5])).max() < 1e-13  # (39) with the wrong sign


def test_the_convention_is_modified():
    arm = alfaiz()
    assert arm.chain.convention is DHConvention.MODIFIED
    standard = replace(arm.chain, convention=DHConvention.STANDARD)
    q = random_postures()
    error = hand_pose(standard, q, arm.lengths)[0] - hand_pose(arm.chain, q, arm.lengths)[0]
    assert abs(error).max() > 0.3


def test_the_wrist_centre_and_the_hand_share_one_point_and_the_arm_hangs_along_y():
    arm = alfaiz()
    T = joint_frames(arm.chain, np.zeros((1, 7)), arm.lengths)[0]
    np.testing.assert_allclose(T[4, :3, 3], [0, -L4, 0], atol=1e-15)
    for frame in (5, 6, 7, 8):
        np.testing.assert_allclose(T[frame, :3, 3], [0, -L4 - L3, 0], atol=1e-15)


def test_limits_are_those_documented():
    arm = alfaiz()
    np.testing.assert_allclose(np.rad2deg(arm.rom.lower), [-180, -180, -180, 0, -90, -90, -180])
    np.testing.assert_allclose(np.rad2deg(arm.rom.upper), [180, 180, 180, 145, 90, 90, 180])


@pytest.mark.parametrize("name", ["upper_arm", "forearm"])
@pytest.mark.parametrize("value", [-0.1, 300.0, np.nan])
def test_impossible_lengths_are_refused_by_name_and_value(name, value):
    with pytest.raises(ArmModelError, match=rf"segment length '{name}' is {value:g}, expected 0 to 5 m"):
        alfaiz(**{name: value})
