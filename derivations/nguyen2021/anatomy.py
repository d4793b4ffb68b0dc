"""Which way every joint of Nguyen 2021 turns, read from the chain.

The base frame says x up and z forward; that leaves y to one side. The arm hangs at q = 0 with the thumb
forward (the neutral posture from which Table 2 counts). Everything else follows from the chain.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from armik_sym.arm import Arm
from armik_sym.symbolic import express
from derivations.from_casadi import to_sympy
from derivations.random_points import evaluate

UP, FORWARD, SIDE_Y = sp.Matrix([1, 0, 0]), sp.Matrix([0, 0, 1]), sp.Matrix([0, 1, 0])
LEFT, RIGHT = 1, -1  # side of the body: y points to the right, so medial is +y for a left arm
_ELBOW, _WRIST, _HAND = 3, 5, 7  # frames
_LENGTH = sp.Rational(3, 10)


@dataclass(frozen=True)
class Movement:
    """The movement Table 2 names first, as the direction in which it carries a point or the fingers.

    Attributes:
        frame: Frame that is looked at.
        column: Its column: 3 for the origin, 0 to 2 for an axis; -1 for the radial side of the hand.
        direction: Where the movement carries it: "forward", "medial" or "lateral".
        bent: Whether it is looked at with the elbow bent by 90°.
    """

    frame: int
    column: int
    direction: str
    bent: bool = False


MOVEMENTS: Mapping[str, Movement] = {
    "shoulder_abduction": Movement(_ELBOW, 3, "lateral"),
    "shoulder_flexion": Movement(_ELBOW, 3, "forward"),
    "shoulder_internal_rotation": Movement(_WRIST, 3, "medial", bent=True),
    "elbow_flexion": Movement(_WRIST, 3, "forward"),
    "forearm_pronation": Movement(_HAND, -1, "medial", bent=True),
    "wrist_flexion": Movement(_HAND, 0, "medial"),
    "radial_deviation": Movement(_HAND, 0, "forward"),
}

# The movement of Table 2 that each joint of the catalogue makes, whichever way it counts.
MOVEMENT_OF_JOINT = {
    **{name: name for name in MOVEMENTS},
    "wrist_extension": "wrist_flexion",
    "wrist_ulnar_deviation": "radial_deviation",
}


def senses(arm: Arm, side: int) -> dict[str, int]:
    """Whether each joint increases in the movement Table 2 names first (+1) or in the second (-1).

    Args:
        arm: An arm with the joints and the base frame of the E-HMCS.
        side: `LEFT` or `RIGHT`, the side of the body the arm is taken for.

    Returns:
        The sign for every movement of Table 2, in the order of the joints.

    Raises:
        ValueError: If a joint does not carry its point straight in the direction of the movement, or if
            CasADi disagrees.

    Source:
        Nguyen 2021, Tables 2 and 4, through `armik_sym.symbolic`.
    """
    expressions = express(arm)
    q = sp.symbols(f"q1:{arm.dof + 1}", real=True)
    lengths = [_LENGTH] * expressions.lengths.numel()
    frames = [to_sympy(T, [expressions.q, expressions.lengths], [q, lengths]) for T in expressions.frames]
    found = {}
    for k, joint in enumerate(arm.chain.joint_names):
        movement = MOVEMENTS[MOVEMENT_OF_JOINT[joint]]
        posture = dict.fromkeys(q, sp.Integer(0))
        if movement.bent:
            posture[q[arm.joint_index("elbow_flexion")]] = sp.pi / 2
        point = _point(frames[movement.frame], movement.column, dict.fromkeys(q, sp.Integer(0)))
        velocity = sp.Matrix(point.diff(q[k]))
        found[MOVEMENT_OF_JOINT[joint]] = _sense(velocity, posture, _direction(movement.direction, side))
    return found


def _point(T: sp.Matrix, column: int, zero: Mapping[sp.Symbol, sp.Expr]) -> sp.Matrix:
    if column >= 0:
        return sp.Matrix(T[:3, column])
    radial = T[:3, :3].subs(zero).T * FORWARD  # in the hand: where the thumb points at q = 0
    return sp.Matrix(T[:3, :3] * radial)


def _direction(name: str, side: int) -> sp.Matrix:
    return {"forward": FORWARD, "medial": side * SIDE_Y, "lateral": -side * SIDE_Y}[name]


def _sense(velocity: sp.Matrix, posture: Mapping[sp.Symbol, sp.Expr], direction: sp.Matrix) -> int:
    there = velocity.subs(posture)
    along = there.dot(direction)
    if along == 0 or sp.Matrix(there - along * direction) != sp.zeros(3, 1):
        raise ValueError(f"the joint carries its point along {list(there)}, not {list(direction)}")
    symbols = list(posture)
    numbers = np.array([[float(value) for value in posture.values()]])
    in_casadi = evaluate(velocity.dot(direction), symbols, numbers)[0]
    if abs(in_casadi - float(along)) > 1e-12:
        raise ValueError(f"exactly {along}, but {in_casadi} in CasADi")
    return int(sp.sign(along))
