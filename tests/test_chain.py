"""The DH chain: order, names, and what makes no chain."""

from __future__ import annotations

import numpy as np
import pytest

from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.errors import ArmModelError

ROWS = (
    DHLink("shoulder", d="upper_arm"),
    DHLink("spacer", a="offset", joint=JointType.FIXED),
    DHLink("slide", a="upper_arm", joint=JointType.PRISMATIC),
    DHLink("wrist", d="forearm", a="offset"),
)


def test_fixed_rows_have_no_joint_variable():
    chain = DHChain(ROWS)
    assert chain.dof == 3
    assert chain.joint_names == ("shoulder", "slide", "wrist")
    assert chain.moving_links == (ROWS[0], ROWS[2], ROWS[3])


def test_length_names_come_once_in_order_of_first_use():
    assert DHChain(ROWS).length_names == ("upper_arm", "offset", "forearm")


def test_a_chain_is_standard_and_starts_and_ends_at_its_rows_unless_told():
    chain = DHChain(list(ROWS))
    assert chain.links == ROWS
    assert chain.convention is DHConvention.STANDARD
    np.testing.assert_array_equal(chain.base, np.eye(4))
    np.testing.assert_array_equal(chain.tool, np.eye(4))


def test_base_and_tool_are_read_only_copies():
    T = np.eye(4)
    chain = DHChain(ROWS, base=T, tool=T)
    T[0, 3] = 7.0
    assert chain.base[0, 3] == 0.0
    assert chain.tool[0, 3] == 0.0
    for matrix in (chain.base, chain.tool):
        with pytest.raises(ValueError, match="read-only"):
            matrix[0, 3] = 1.0


def test_two_rows_of_one_name_are_refused():
    with pytest.raises(ArmModelError, match="joint name 'wrist' occurs twice"):
        DHChain((*ROWS, DHLink("wrist")))


def test_a_fixed_row_may_not_share_a_joint_s_name_either():
    with pytest.raises(ArmModelError, match="'shoulder' occurs twice"):
        DHChain((DHLink("shoulder"), DHLink("shoulder", joint=JointType.FIXED)))


@pytest.mark.parametrize("links", [(), (DHLink("spacer", joint=JointType.FIXED),)])
def test_a_chain_that_cannot_move_is_refused(links):
    with pytest.raises(ArmModelError, match="at least one row that moves"):
        DHChain(links)


@pytest.mark.parametrize("convention", ["standard", None, JointType.FIXED])
def test_the_convention_must_be_of_the_enum(convention):
    with pytest.raises(ArmModelError) as caught:
        DHChain(ROWS, convention=convention)
    assert f"convention is {convention!r}, expected a DHConvention" in str(caught.value)


def test_rows_must_be_links():
    with pytest.raises(ArmModelError, match="DHLink rows, got dict"):
        DHChain(({"name": "elbow"},))


@pytest.mark.parametrize("where", ["base", "tool"])
def test_a_base_or_tool_that_is_not_rigid_is_refused_by_name(where):
    with pytest.raises(ArmModelError, match=f"{where} transform is not rigid"):
        DHChain(ROWS, **{where: np.diag([1.0, 1.0, -1.0, 1.0])})
