"""Everything kinematic about an arm, as CasADi expressions that users can build on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import casadi as ca

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError
from armik_sym.symbolic.geometric_jacobian import geometric_jacobian
from armik_sym.symbolic.link_transform import link_transform
from armik_sym.symbolic.orientation import quaternion, roll_pitch_yaw

LengthMode = Literal["parameter", "baked"]


@dataclass(frozen=True, eq=False)
class ArmExpressions:
    """Symbolic kinematics of one arm.

    Attributes:
        arm: The arm they belong to.
        q: Joint variables, SX of shape (dof, 1), in [rad].
        lengths: Segment lengths, SX of shape (n_lengths, 1), in [m]; empty if baked in.
        frames: T_base_i for the base and after every row, SX of shape (4, 4) each.
        T_base_hand: Pose of the hand frame, SX of shape (4, 4), in [m].
    """

    arm: Arm
    q: ca.SX
    lengths: ca.SX
    frames: tuple[ca.SX, ...]
    T_base_hand: ca.SX

    @property
    def position(self) -> ca.SX:
        """Position of the hand, SX of shape (3, 1), in [m]."""
        return self.T_base_hand[:3, 3]

    @property
    def rotation(self) -> ca.SX:
        """Rotation of the hand frame to the base, SX of shape (3, 3)."""
        return self.T_base_hand[:3, :3]

    @property
    def jacobian(self) -> ca.SX:
        """Geometric Jacobian [v; ω] = J q̇ in the base frame, SX of shape (6, dof), in [m/rad], [1]."""
        return geometric_jacobian(self.arm.chain, self.frames, self.T_base_hand)

    def analytic_jacobian(self, representation: str = "roll_pitch_yaw") -> ca.SX:
        """Analytic Jacobian d[p; φ(R)]/dq for a chosen representation φ of the rotation.

        Args:
            representation: "roll_pitch_yaw" (3 rows), "quaternion" (w, x, y, z) or "matrix"
                (nine entries, row by row).

        Returns:
            SX of shape (3 + rows, dof).

        Raises:
            OptionError: If the representation is unknown.

        Source:
            Siciliano et al., Robotics (2009), §3.6.
        """
        choices: dict[str, Callable[[ca.SX], ca.SX]] = {
            "roll_pitch_yaw": roll_pitch_yaw,
            "quaternion": quaternion,
            "matrix": lambda R: ca.vec(R.T),
        }
        if representation not in choices:
            raise OptionError(f"representation {representation!r} is unknown: valid are {', '.join(choices)}")
        orientation = choices[representation](self.rotation)
        return ca.jacobian(ca.vertcat(self.position, orientation), self.q)

    def function(self, quantity: str) -> ca.Function:
        """One quantity as a CasADi Function of (q, lengths), common subexpressions shared.

        Args:
            quantity: "pose", "position", "rotation", "jacobian" or "analytic_jacobian".

        Returns:
            Function (q, lengths) → quantity, dense.

        Raises:
            OptionError: If the quantity is unknown.

        Source:
            None (packaging).
        """
        expressions: dict[str, Callable[[], ca.SX]] = {
            "pose": lambda: self.T_base_hand,
            "position": lambda: self.position,
            "rotation": lambda: self.rotation,
            "jacobian": lambda: self.jacobian,
            "analytic_jacobian": self.analytic_jacobian,
        }
        if quantity not in expressions:
            raise OptionError(f"quantity {quantity!r} is unknown: valid are {', '.join(expressions)}")
        result = ca.cse(ca.densify(expressions[quantity]()))
        return ca.Function(quantity, [self.q, self.lengths], [result], ["q", "lengths"], [quantity])


def express(arm: Arm, lengths: LengthMode = "parameter") -> ArmExpressions:
    """Build the symbolic kinematics of an arm.

    T_base_hand(q) = base · Π T_i(q_i) · tool.

    Args:
        arm: The arm.
        lengths: "parameter" keeps segment lengths as symbols, "baked" puts their numbers in.

    Returns:
        The expressions.

    Raises:
        OptionError: If `lengths` is neither.

    Source:
        Nguyen 2021, eq. 2; Al-Faiz, eq. 3.
    """
    if lengths not in ("parameter", "baked"):
        raise OptionError(f"lengths is {lengths!r}, expected 'parameter' or 'baked'")
    names = arm.chain.length_names if lengths == "parameter" else ()
    symbols = ca.SX.sym("lengths", len(names))
    values: Mapping[str, ca.SX | float] = (
        {name: symbols[i] for i, name in enumerate(names)} if names else dict(arm.lengths)
    )
    q = ca.SX.sym("q", arm.dof)
    T = ca.SX(ca.DM(arm.chain.base))
    frames = [T]
    column = 0
    for link in arm.chain.links:
        q_i = q[column] if link.moves else ca.SX(0)
        column += link.moves
        T = T @ link_transform(link, arm.chain.convention, q_i, values)
        frames.append(T)
    return ArmExpressions(arm, q, symbols, tuple(frames), T @ ca.SX(ca.DM(arm.chain.tool)))
