"""A serial chain of DH links between a base and a tool."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.dh import DHConvention, DHLink
from armik_sym.arm.rigid_transform import check_rigid
from armik_sym.errors import ArmModelError


def _identity() -> NDArray[np.float64]:
    return np.eye(4)


@dataclass(frozen=True, eq=False)
class DHChain:
    """A serial kinematic chain: T_base_hand(q) = base · Π T_i(q_i) · tool.

    Attributes:
        links: The rows of the DH table, from base to hand.
        convention: Standard (distal) or modified (proximal).
        base: Fixed transform before the first row, shape (4, 4), in [m].
        tool: Fixed transform after the last row, shape (4, 4), in [m].

    Raises:
        ArmModelError: If no row moves, a joint name occurs twice, or base or tool is not rigid.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """

    links: tuple[DHLink, ...]
    convention: DHConvention = DHConvention.STANDARD
    base: NDArray[np.float64] = field(default_factory=_identity)
    tool: NDArray[np.float64] = field(default_factory=_identity)

    def __post_init__(self) -> None:
        object.__setattr__(self, "links", tuple(self.links))
        if not isinstance(self.convention, DHConvention):
            raise ArmModelError(f"convention is {self.convention!r}, expected a DHConvention")
        for link in self.links:
            if not isinstance(link, DHLink):
                raise ArmModelError(f"a chain is made of DHLink rows, got {type(link).__name__}")
        repeated = [name for name, count in Counter(link.name for link in self.links).items() if count > 1]
        if repeated:
            raise ArmModelError(f"joint name {repeated[0]!r} occurs twice: every row needs its own name")
        if self.dof == 0:
            raise ArmModelError("a chain needs at least one row that moves")
        object.__setattr__(self, "base", check_rigid(self.base, "base"))
        object.__setattr__(self, "tool", check_rigid(self.tool, "tool"))

    @property
    def moving_links(self) -> tuple[DHLink, ...]:
        """The rows that have a joint variable, from base to hand."""
        return tuple(link for link in self.links if link.moves)

    @property
    def dof(self) -> int:
        """Number of joint variables."""
        return len(self.moving_links)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joint variables, from base to hand."""
        return tuple(link.name for link in self.moving_links)

    @property
    def length_names(self) -> tuple[str, ...]:
        """Names of the segment lengths the rows refer to, in order of first use."""
        return tuple(dict.fromkeys(name for link in self.links for name in link.length_names))
