"""Nguyen 2021, Tables 1 and 2: segment lengths and range of motion."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping

import numpy as np
import sympy as sp

from armik_sym.arm import Arm
from armik_sym.arm.catalog import ehmcs, human
from armik_sym.symbolic import express
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.from_casadi import to_sympy
from derivations.nguyen2021.anatomy import LEFT, MOVEMENT_OF_JOINT, RIGHT, senses
from derivations.random_points import evaluate

PAPER = "nguyen2021"

# Table 1 in [m]: upper arm, lower arm, hand, total.
HUMAN_LENGTHS = ("0.3", "0.24", "0.18", "0.72")
MODEL_LENGTHS = ("0.28", "0.26", "0.19", "0.74")

# Table 2 in degrees: limit of the movement named first, limit of its opposite.
HUMAN_DEG = {
    "shoulder_abduction": (175, -50),
    "shoulder_flexion": (165, -50),
    "shoulder_internal_rotation": (70, -45),
    "elbow_flexion": (145, 0),
    "forearm_pronation": (75, -110),
    "wrist_flexion": (75, -70),
    "radial_deviation": (20, -40),
}
MODEL_DEG = {**HUMAN_DEG, "shoulder_flexion": (180, -180), "wrist_flexion": (73, -73)}

_OPPOSITES = {
    "shoulder_abduction": ("shoulder_abduction", "shoulder_adduction"),
    "shoulder_flexion": ("shoulder_flexion", "shoulder_extension"),
    "shoulder_internal_rotation": ("shoulder_internal_rotation", "shoulder_external_rotation"),
    "elbow_flexion": ("elbow_flexion", "elbow_extension"),
    "forearm_pronation": ("forearm_pronation", "forearm_supination"),
    "wrist_flexion": ("wrist_flexion", "wrist_extension"),
    "radial_deviation": ("radial_deviation", "ulnar_deviation"),
}

Limits = Mapping[str, tuple[int, int]]


def stretched_reach() -> sp.Expr:
    """Distance from the shoulder to the fingertips of the hanging human arm with the lengths of the model.

    Returns:
        The distance, in [m].

    Raises:
        ArithmeticError: If CasADi disagrees.

    Source:
        Nguyen 2021, Tables 1 and 4, through `armik_sym.symbolic`.
    """
    expressions = express(human())
    lengths = sp.symbols("upper_arm forearm hand", positive=True)
    inputs = [expressions.q, expressions.lengths]
    reach = to_sympy(expressions.position, inputs, [[sp.Integer(0)] * 7, lengths]).norm()
    numbers = [float(x) for x in MODEL_LENGTHS[:3]]
    exact = reach.subs(dict(zip(lengths, map(sp.Rational, MODEL_LENGTHS), strict=False)))
    in_casadi = evaluate(reach, list(lengths), np.array([numbers]))[0]
    if abs(in_casadi - float(exact)) > 1e-12:
        raise ArithmeticError(f"exactly {exact}, but {in_casadi} in CasADi")
    return sp.simplify(exact)


def check_lengths(human_lengths: tuple[str, ...], model_lengths: tuple[str, ...]) -> Evidence:
    """Do the segments add up to the total, and are they those of the catalogue?

    Args:
        human_lengths: Upper arm, lower arm, hand and total of a human, in [m].
        model_lengths: The same of the model.

    Returns:
        The verdict.

    Source:
        Nguyen 2021, Table 1.
    """
    columns = [[sp.Rational(x) for x in column] for column in (human_lengths, model_lengths)]
    sums = [sum(column[:3]) for column in columns]
    adds_up = [total == column[3] for total, column in zip(sums, columns, strict=True)]
    catalogue = [sp.Rational(str(length)) for length in human().lengths.values()]
    if catalogue != columns[1][:3] or stretched_reach() != sums[1]:
        return Evidence(Verdict.FALSE, "not the lengths of the catalogue", f"catalogue: {catalogue}")
    if all(adds_up):
        return Evidence(Verdict.HOLDS, "both totals are the sums of their segments, exactly")
    return Evidence(
        Verdict.CORRECTED if adds_up[0] else Verdict.FALSE,
        f"human: {float(sums[0]):g} m, as printed; model: {float(sums[1]):g} m, which is also the reach of "
        "the stretched arm in the catalogue's chain, exactly and in CasADi",
        f"{' + '.join(model_lengths[:3])} = {float(sums[1]):g}, printed {model_lengths[3]}",
    )


def limits_of_joints(arm: Arm, table: Limits, side: int) -> dict[str, tuple[int, int]]:
    """The limits of Table 2 with the sign in which the joints count.

    Args:
        arm: An arm of the catalogue.
        table: Limits by movement: of the one named first, of its opposite.
        side: The side of the body the arm is taken for.

    Returns:
        Lower and upper limit of every joint, in degrees, by movement.

    Source:
        Nguyen 2021, Tables 2 and 4.
    """
    return {name: _sorted(sign, table[name]) for name, sign in senses(arm, side).items()}


def turned_rows(arm: Arm, table: Limits, side: int) -> list[str]:
    """The rows of Table 2 that a joint counts the other way round, and for which it makes a difference.

    Args:
        arm: An arm of the catalogue.
        table: Limits by movement.
        side: The side of the body the arm is taken for.

    Returns:
        Names of the movements, in the order of the joints.

    Source:
        Nguyen 2021, Tables 2 and 4.
    """
    limits = limits_of_joints(arm, table, side)
    return [name for name, interval in limits.items() if interval != _sorted(1, table[name])]


def _sorted(sign: int, limits: tuple[int, int]) -> tuple[int, int]:
    low, high = sorted(sign * limit for limit in limits)
    return low, high


def _catalogue_limits(arm: Arm) -> dict[str, tuple[int, int]]:
    degrees = np.rint(np.rad2deg([arm.rom.lower, arm.rom.upper])).astype(int).T
    movements = [MOVEMENT_OF_JOINT[joint] for joint in arm.chain.joint_names]
    return {name: (int(low), int(high)) for name, (low, high) in zip(movements, degrees, strict=True)}


def check_limits(table: Limits, arms: tuple[Callable[[], Arm], ...] = (ehmcs, human)) -> Evidence:
    """Are the limits of Table 2 those of the joint variables of Table 4, read from the chain?

    Args:
        table: Limits by movement.
        arms: Arms to compare.

    Returns:
        The verdict.

    Source:
        Nguyen 2021, Tables 2 and 4.
    """
    for arm in (build() for build in arms):
        wanted, used = limits_of_joints(arm, table, LEFT), _catalogue_limits(arm)
        if wanted != used:
            name = next(name for name in wanted if wanted[name] != used[name])
            words = f"{arm.name}, {name}: {wanted[name]} from the table, {used[name]} in the catalogue"
            return Evidence(Verdict.FALSE, "not the limits of the catalogue", words)
    left, right = ([turned_rows(build(), table, side) for build in arms] for side in (LEFT, RIGHT))
    if not any(left):
        return Evidence(Verdict.HOLDS, "every joint counts as the table does")
    if not any(right):
        return Evidence(Verdict.HOLDS, "every joint of a right arm counts as the table does")
    return Evidence(
        Verdict.DEFINITION,
        "direction of every joint from the derivative of the chain, exactly and in CasADi, for E-HMCS and "
        f"human arm alike: rows turned on a left arm: {_words(left)}; on a right arm: {_words(right)}. No "
        "side of the body makes all rows agree; with the rows of the left arm turned, the limits are the "
        f"catalogue's. Beyond the column Human: {_beyond(table)}",
    )


def _words(rows: list[list[str]]) -> str:
    alike = all(set(row) == set(rows[0]) for row in rows)
    return " / ".join(", ".join(row) for row in (rows[:1] if alike else rows)).replace("_", " ")


def _beyond(table: Limits) -> str:
    """Movements whose limits lie outside those of the column Human."""
    found = [
        f"{names[k].replace('_', ' ')} {table[name][k]}° (human {HUMAN_DEG[name][k]}°)"
        for name, names in _OPPOSITES.items()
        for k in (0, 1)
        if abs(table[name][k]) > abs(HUMAN_DEG[name][k])
    ]
    return ", ".join(found) or "nothing"


def _total(metres: sp.Rational | str) -> Formula:
    segments = " + ".join(MODEL_LENGTHS[:3])
    return Formula(rf"\text{{model, in m: }} {segments}", f"{float(metres):g}")


def _row(name: str, human_deg: Limits, model_deg: Limits) -> Formula:
    """One row of Table 2, as printed."""
    first, second = _OPPOSITES[name]
    joint, opposite = first.split("_")[0], second.split("_")
    words = " / ".join((first, "_".join(opposite[1:] if opposite[0] == joint else opposite)))
    columns = [rf"{table[name][0]}/{table[name][1]}" for table in (human_deg, model_deg)]
    right = rf"{columns[0]}^\circ \text{{ (human)}},\quad {columns[1]}^\circ \text{{ (model)}}"
    return Formula(rf"\text{{{words.replace('_', ' ')}}}", right, ":")


CLAIMS = (
    Claim(
        PAPER,
        "Table 1",
        "segment lengths",
        Verdict.CORRECTED,
        "The segments of the model add up to 0.73 m, not to the printed 0.74 m (one unit of the last digit; "
        "rounding of the three lengths may explain it). The catalogue uses the segments. Do not mix them "
        "with Table 4, whose forearm is 336 mm against 260 mm here.",
        Check(
            functools.partial(check_lengths, HUMAN_LENGTHS, MODEL_LENGTHS),
            (_total(MODEL_LENGTHS[3]),),
            (_total(sum(map(sp.Rational, MODEL_LENGTHS[:3]))),),
        ),
        derivation="Sum of the column, and length of the hanging arm in the chain.",
        correction="total length of the model: 0.73 m",
        fault=Fault.MISPRINT,
    ),
    Claim(
        PAPER,
        "Table 2",
        "range of motion, and which way the joint variables count",
        Verdict.DEFINITION,
        "The table prints movements, not intervals of q1 to q7, and no sign convention; the chain of Table 4 "
        "fixes it. On a left arm the joint variables count as the table counts but for the last row: q7 "
        "increases towards the little finger (ulnar), so radial 20 / ulnar -40 is -20° ≤ q7 ≤ 40°. No side "
        "of the body makes all rows agree. The model's ±180° of shoulder flexion (human: 165/-50) and its "
        "-73° of wrist extension (human: -70) go beyond the human column: narrow them for a patient.",
        Check(
            functools.partial(check_limits, MODEL_DEG),
            tuple(_row(name, HUMAN_DEG, MODEL_DEG) for name in MODEL_DEG),
        ),
        derivation="The arm hangs at q = 0 with the thumb forward; x is up and z forward (the elbow bends "
        "towards z). Then q1 to q5 increase in the movement named first, if the arm is a left one; q6 "
        "increases in extension, which ±73° does not show. When q7 increases from 0 the fingers turn "
        "backward, away from the thumb, which is ulnar: q7 = 40° is 40° of ulnar deviation, which the table "
        "allows, and q7 = -40° would be 40° of radial deviation, twice what it allows. That the thumb points "
        "forward at q = 0 is assumed, not printed. The table lists pronation under the elbow, the text under "
        "the wrist; it is the same joint, q5.",
    ),
)
