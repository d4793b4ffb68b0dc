"""What generated code depends on: an arm without its lengths, limits and name."""

from __future__ import annotations

from dataclasses import dataclass, field

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError


@dataclass(frozen=True)
class ArmStructure:
    """The part of an arm that decides its generated code; equal structures share compiled code.

    Attributes:
        key: Rows, convention, base, tool and pointing axis, hashable.
        arm: One arm of this structure.
    """

    key: tuple[object, ...]
    arm: Arm = field(compare=False)

    @classmethod
    def of(cls, arm: Arm) -> ArmStructure:
        """The structure of an arm.

        Args:
            arm: The arm.

        Returns:
            Its structure.

        Raises:
            OptionError: If it is no arm.

        Source:
            None (bookkeeping).
        """
        if not isinstance(arm, Arm):
            raise OptionError(
                f"arm is {arm!r}, expected an Arm: use load_arm(NAME or FILE), or the catalogue"
            )
        chain = arm.chain
        numbers = (chain.base.tobytes(), chain.tool.tobytes(), arm.pointing_axis.tobytes())
        return cls((chain.links, chain.convention, *numbers), arm)
