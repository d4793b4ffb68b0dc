"""Nguyen 2021, eq. 1, 9-16 and Tables 1, 2, 4, 5: checks reach their verdicts, wrong statements turn them."""

from __future__ import annotations

import dataclasses
import itertools

import pytest
import sympy as sp

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.range_of_motion import RangeOfMotion
from derivations.claim import Claim, Fault, Formula, Verdict
from derivations.nguyen2021 import (
    cost,
    crossover,
    dh_table,
    direction_cosines,
    elbow_direction,
    final_scaling_factor,
    forward_kinematics,
    mutation,
    range_of_motion,
    scaling_factor,
    settings,
)
from derivations.nguyen2021.anatomy import LEFT, RIGHT, UP, senses
from derivations.nguyen2021.chain import Q, frame
from derivations.nguyen2021.isade import GENERATIONS, generations_needed

MODULES = (range_of_motion, mutation, scaling_factor, final_scaling_factor, crossover, cost, settings)
CLAIMS = {claim.equation: claim for module in MODULES for claim in module.CLAIMS}
KINEMATICS = (dh_table, forward_kinematics, elbow_direction)


@pytest.mark.parametrize("equation", CLAIMS)
def test_the_check_reaches_the_verdict_of_the_claim(equation: str) -> None:
    claim: Claim = CLAIMS[equation]
    evidence = claim.check()
    assert evidence.verdict is claim.verdict
    assert claim.printed_formulas()
    assert bool(evidence.counterexample) == (claim.verdict is Verdict.CORRECTED)
    assert bool(claim.correction) == bool(claim.corrected_formulas()) == (claim.verdict is Verdict.CORRECTED)


def test_nothing_of_this_part_is_missing() -> None:
    assert list(CLAIMS) == "Table 1|Table 2|9|10|11|12|13|14|15|16|Table 5".split("|")


def test_every_correction_says_what_is_wrong() -> None:
    claims = [claim for module in (*MODULES, *KINEMATICS) for claim in module.CLAIMS]
    assert all((claim.fault is None) == (claim.verdict is not Verdict.CORRECTED) for claim in claims)
    faults = {claim.equation: claim.fault for claim in claims if claim.fault is not None}
    assert faults.pop("13") is Fault.WORDING
    assert faults.pop("16") is Fault.MODEL
    assert faults == dict.fromkeys(("Table 1", "Table 4", "1", "4-5", "14"), Fault.MISPRINT)


def test_what_is_shown_is_what_is_checked() -> None:
    shown = {
        "9": mutation.PRINTED_BEST_1,
        "10": mutation.PRINTED_BEST_2,
        "11": mutation.PRINTED_RAND_TO_BEST_1,
        "12": scaling_factor.PRINTED_BY_RANK,
        "13": scaling_factor.PRINTED_MEAN,
        "14": final_scaling_factor.PRINTED_FACTOR,
        "15": crossover.PRINTED_ADAPTATION,
        "16": cost.PRINTED_COST,
    }
    for equation, expression in shown.items():
        formula: Formula = CLAIMS[equation].printed_formulas()[0]
        assert formula.right is expression
        assert "operatorname" not in sp.latex(formula.right)
    assert "X_{r1,j}^G - X_{r2,j}^G" in sp.latex(mutation.PRINTED_BEST_1)


# Table 4 and eq. (1)


def test_a_table_and_a_position_that_agree_turn_the_verdict() -> None:
    table, position = sp.Matrix(dh_table.PRINTED_TABLE), forward_kinematics.printed_position()
    assert dh_table.check_table(table, position).verdict is Verdict.CORRECTED
    with_offset = position + dh_table.missing_term().subs(sp.Symbol("d_2", real=True), 7)
    assert dh_table.check_table(table, with_offset).verdict is Verdict.HOLDS
    table[1, 1] = 0
    assert dh_table.check_table(table, position).verdict is Verdict.HOLDS
    assert dh_table.check_table(table, -position).verdict is Verdict.FALSE


@pytest.mark.parametrize("entry", [(0, 1), (1, 0), (2, 3), (4, 1), (6, 2)])
def test_another_entry_of_the_table_turns_the_verdict(entry: tuple[int, int]) -> None:
    table = sp.Matrix(dh_table.PRINTED_TABLE)
    table[entry] = 1 - table[entry]
    evidence = dh_table.check_table(table, forward_kinematics.printed_position())
    assert evidence.verdict is Verdict.FALSE
    assert f"row {entry[0] + 1}, column {entry[1] + 1}" in evidence.counterexample


def test_the_rotations_are_free_of_the_offset_and_the_positions_are_not() -> None:
    d2 = sp.Symbol("d_2", real=True)
    assert dh_table.rotations_are_free_of_d2()
    assert frame(5, d2_mm=d2)[:3, 3].has(d2)
    assert dh_table.missing_term() == d2 * frame(1)[:3, 2]


def test_a_transform_that_is_not_rigid_or_not_a_row_turns_the_verdict() -> None:
    printed, corrected = forward_kinematics.printed_transform(), forward_kinematics.corrected_transform()
    assert forward_kinematics.check_transform(corrected, corrected).verdict is Verdict.HOLDS
    for i in range(3):
        for j in range(4):
            wrong = corrected.copy()
            wrong[i, j] = 1 - wrong[i, j]
            assert forward_kinematics.check_transform(printed, wrong).verdict is Verdict.FALSE


# Mutation


@pytest.mark.parametrize(
    ("printed", "strategy"),
    [
        (mutation.PRINTED_BEST_1, mutation.BEST_1),
        (mutation.PRINTED_BEST_2, mutation.BEST_2),
        (mutation.PRINTED_RAND_TO_BEST_1, mutation.RAND_TO_BEST_1),
    ],
)
def test_a_turned_sign_or_a_swapped_individual_turns_the_verdict(
    printed: sp.Expr, strategy: mutation.Strategy
) -> None:
    assert mutation.check_mutant(printed, strategy).verdict is Verdict.DEFINITION
    individuals = sorted(printed.free_symbols - {mutation.F}, key=str)
    wrong = [printed.subs(x, -x) for x in individuals]
    wrong += [printed.subs({x: y, y: x}, simultaneous=True) for x, y in itertools.pairwise(individuals)]
    wrong += [sp.expand(printed) - term + (-term) for term in sp.expand(printed).args]
    assert len(wrong) >= 7
    for form in wrong:
        evidence = mutation.check_mutant(form, strategy)
        assert evidence.verdict is Verdict.FALSE
        assert evidence.counterexample


def test_only_the_strategy_that_aims_at_the_best_feels_the_sign_of_F() -> None:
    assert mutation.ignores_the_sign_of_F(mutation.PRINTED_BEST_1, mutation.BEST_1)
    assert mutation.ignores_the_sign_of_F(mutation.PRINTED_BEST_2, mutation.BEST_2)
    assert not mutation.ignores_the_sign_of_F(mutation.PRINTED_RAND_TO_BEST_1, mutation.RAND_TO_BEST_1)


# Scale factor


@pytest.mark.parametrize(
    "wrong",
    [
        scaling_factor.PRINTED_BY_RANK.subs(scaling_factor.ALPHA, -scaling_factor.ALPHA),
        1 - scaling_factor.PRINTED_BY_RANK,
        scaling_factor.PRINTED_BY_RANK.subs(scaling_factor.RANK, scaling_factor.RANK + 1),
        scaling_factor.PRINTED_BY_RANK / 2,
    ],
)
def test_another_sigmoid_turns_the_verdict(wrong: sp.Expr) -> None:
    assert scaling_factor.check_by_rank(wrong).verdict is Verdict.FALSE


def test_a_mean_that_rises_turns_the_verdict() -> None:
    f_min, f_max, mean = scaling_factor.F_MIN, scaling_factor.F_MAX, scaling_factor.PRINTED_MEAN
    rising = mean.subs({f_min: f_max, f_max: f_min}, simultaneous=True)
    constant = mean.subs(scaling_factor.ITER, 0)
    for wrong in (rising, constant, mean + f_min):
        assert scaling_factor.check_mean(wrong).verdict is Verdict.FALSE


def test_words_that_do_not_cross_the_bounds_turn_the_verdict() -> None:
    mean, bounds = scaling_factor.PRINTED_MEAN, scaling_factor.CORRECTED_BOUNDS
    assert scaling_factor.check_mean(mean, bounds).verdict is Verdict.HOLDS
    assert scaling_factor.check_mean(mean, bounds[::-1]).verdict is Verdict.CORRECTED


def test_the_final_factor_stays_in_the_stated_ranges_and_in_no_smaller_ones() -> None:
    module = final_scaling_factor
    for factor, (low, high) in (
        (module.PRINTED_FACTOR, module.PRINTED_RANGE),
        (module.CORRECTED_FACTOR, module.CORRECTED_RANGE),
    ):
        assert module.stays_between(factor, (low, high))
        for limits in ((low + sp.Rational(1, 50), high), (low, high - sp.Rational(1, 50))):
            assert not module.stays_between(factor, limits)
    assert not module.stays_between(module.PRINTED_FACTOR, module.CORRECTED_RANGE)
    assert not module.stays_between(module.CORRECTED_FACTOR, module.PRINTED_RANGE)


def test_the_check_of_the_final_factor_takes_either_sign_for_what_it_is() -> None:
    printed, corrected = final_scaling_factor.PRINTED_FACTOR, final_scaling_factor.CORRECTED_FACTOR
    assert final_scaling_factor.check_factor(corrected, corrected).verdict is Verdict.HOLDS
    for wrong in (printed, -corrected, -printed, corrected - 1, scaling_factor.F_RANK):
        assert final_scaling_factor.check_factor(printed, wrong).verdict is Verdict.FALSE


def test_the_factor_is_negative_where_the_rank_is_above_the_zero_curve() -> None:
    values = {**scaling_factor.EXAMPLE, scaling_factor.ITER: 60}
    mean = scaling_factor.PRINTED_MEAN.subs(values)
    zero = 50 * (0.5 + float(sp.log(1 / mean - 1)) / 4)
    assert final_scaling_factor.negative_ranks(final_scaling_factor.PRINTED_FACTOR, 60) == 50 - int(zero)
    assert final_scaling_factor.negative_ranks(final_scaling_factor.CORRECTED_FACTOR, 60) == 0


def test_a_search_with_the_plus_sign_arrives() -> None:
    assert all(generations_needed(1, 50, seed) < GENERATIONS for seed in range(5))


# Crossover


@pytest.mark.parametrize(
    "wrong",
    [
        (1 - crossover.TAU) * crossover.C + crossover.TAU * crossover.P,
        crossover.TAU * crossover.C - (1 - crossover.TAU) * crossover.P,
        crossover.TAU * crossover.C + (1 - crossover.TAU) ** 2 * crossover.P,
    ],
)
def test_another_rule_for_the_crossover_rate_turns_the_verdict(wrong: sp.Expr) -> None:
    assert crossover.check_rule(wrong).verdict is Verdict.FALSE


def test_the_rule_for_the_crossover_rate_is_read_off_the_printed_cases() -> None:
    tau, rand_1, rand_2, rate = crossover.TAU, crossover.RAND_1, crossover.RAND_2, crossover.CR
    same = sp.Piecewise((rate, sp.Ge(rand_1, tau)), (rand_2, True))
    assert sp.expand(crossover.rule_of(same) - crossover.PRINTED_RULE) == 0
    for wrong in (
        sp.Piecewise((rate, sp.Le(rand_1, tau)), (rand_2, True)),
        sp.Piecewise((rand_2, sp.Ge(rand_1, tau)), (rate, True)),
    ):
        assert crossover.check_rule(crossover.rule_of(wrong)).verdict is Verdict.FALSE


# Cost and settings


def test_another_cost_turns_the_verdict() -> None:
    printed, corrected = cost.PRINTED_COST, cost.CORRECTED_COST
    assert [cost.cosines_compared(c) for c in (printed, corrected)] == [3, 9]
    assert cost.check_cost(corrected, corrected).verdict is Verdict.HOLDS
    assert cost.check_cost(printed, printed).verdict is Verdict.FALSE
    (x, wanted), (rx, rx_wanted) = cost.POSITION[0], cost.COSINES[0]
    i = cost.FOUND[1, 1] - cost.WANTED[1, 1]
    two = printed.subs({rx: 0, rx_wanted: 0})
    four = printed.subs((rx - rx_wanted) ** 2, (rx - rx_wanted) ** 2 + i**2)
    turned = printed.subs(wanted, -wanted)
    squares = printed.replace(sp.Pow, lambda base, power: base if power == sp.Rational(1, 2) else base**power)
    for wrong in (two, four, turned, squares, printed.subs({x: 2 * x}), printed.subs(cost.A, 2 * cost.A)):
        assert wrong != printed
        assert cost.check_cost(wrong, corrected).verdict is Verdict.FALSE


def test_five_cosines_never_suffice_and_six_only_as_two_columns_or_rows() -> None:
    assert not any(direction_cosines.determining(n) for n in range(1, 6))
    assert direction_cosines.determining(6)[0] == (0, 1, 2, 3, 4, 5)
    assert len(direction_cosines.determining(6)) == 6
    assert direction_cosines.two_whole_lines_suffice()
    first, second = direction_cosines.collision((0, 4, 8))
    assert first != second
    assert first.diagonal() == second.diagonal()
    for R in (first, second):
        assert sp.eye(3) == R * R.T
        assert R.det() == 1


def test_the_weights_decide_whether_the_arm_moves() -> None:
    meters = sp.Rational(1, 1000)
    assert cost.best_turn(meters, a=2, b=1) == 0.0
    assert cost.best_turn(meters, a=1, b=2) == 0.1


def test_settings_that_agree_or_do_not_suffice_turn_the_verdict() -> None:
    assert settings.check_settings(150, 150).verdict is Verdict.HOLDS
    assert settings.check_settings(30, 600).verdict is Verdict.FALSE


# Tables 1 and 2


def test_other_lengths_turn_the_verdict() -> None:
    lengths = range_of_motion.HUMAN_LENGTHS, range_of_motion.MODEL_LENGTHS
    right, wrong = ((*lengths[1][:3], total) for total in ("0.73", "0.75"))
    assert range_of_motion.check_lengths(lengths[0], right).verdict is Verdict.HOLDS
    assert range_of_motion.check_lengths(lengths[0], wrong).verdict is Verdict.CORRECTED
    assert range_of_motion.check_lengths((*lengths[0][:3], "0.7"), wrong).verdict is Verdict.FALSE
    assert range_of_motion.check_lengths(lengths[0], ("0.28", "0.25", "0.2", "0.73")).verdict is Verdict.FALSE


@pytest.mark.parametrize("movement", range_of_motion.MODEL_DEG)
def test_a_turned_row_turns_the_verdict_unless_it_is_symmetric(movement: str) -> None:
    first, second = range_of_motion.MODEL_DEG[movement]
    turned = {**range_of_motion.MODEL_DEG, movement: (-first, -second)}
    expected = Verdict.DEFINITION if first == -second else Verdict.FALSE
    assert range_of_motion.check_limits(turned).verdict is expected


def test_the_human_column_and_a_catalogue_with_the_printed_sign_turn_the_verdict() -> None:
    assert range_of_motion.check_limits(range_of_motion.HUMAN_DEG).verdict is Verdict.FALSE
    arm = ehmcs()
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[6], upper[6] = -upper[6], -lower[6]
    as_printed = dataclasses.replace(arm, rom=RangeOfMotion(lower, upper))
    evidence = range_of_motion.check_limits(range_of_motion.MODEL_DEG, (lambda: as_printed,))
    assert evidence.verdict is Verdict.FALSE
    assert "radial_deviation" in evidence.counterexample


def test_on_the_other_side_of_the_body_the_turns_about_the_arm_count_the_other_way() -> None:
    for arm in (ehmcs(), human()):
        left, right = senses(arm, LEFT), senses(arm, RIGHT)
        changed = {name for name in left if left[name] != right[name]}
        assert changed == {
            "shoulder_abduction",
            "shoulder_internal_rotation",
            "forearm_pronation",
            "wrist_flexion",
        }
        assert left["radial_deviation"] == right["radial_deviation"] == -1


def test_the_fingers_go_on_along_the_forearm_of_the_hanging_arm() -> None:
    hanging = dict.fromkeys(Q, 0)
    assert sp.Matrix(frame(7)[:3, 0].subs(hanging)) == -UP
    assert sp.Matrix((frame(5) - frame(3)).subs(hanging)[:3, 3]) == -336 * UP
