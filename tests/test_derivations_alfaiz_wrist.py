"""Al-Faiz, eq. (36)-(63): verdicts are reached by the checks, and wrong statements turn them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

from derivations.alfaiz import (
    axis_angle,
    damped_svd_step,
    levenberg_marquardt,
    log_derivative,
    newton_step,
    orientation_residual,
    residuals,
    wrist_angles,
    wrist_rotation,
    wrist_together,
)
from derivations.alfaiz.chain import Q, between, frame
from derivations.alfaiz.exact_borders import with_borders
from derivations.alfaiz.facts import BranchWithFacts, Fact, with_facts
from derivations.branch import Branch
from derivations.claim import Claim, Evidence, Fault, Verdict
from derivations.identity import Identity

MODULES = (
    wrist_rotation,
    wrist_angles,
    residuals,
    orientation_residual,
    newton_step,
    levenberg_marquardt,
    damped_svd_step,
)
CLAIMS: dict[str, Claim] = {claim.equation: claim for module in MODULES for claim in module.CLAIMS}
IDENTITIES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Identity)]
BRANCHES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Branch)]


def numbers(equation: str) -> range:
    first, _, last = equation.partition("-")
    return range(int(first), int(last or first) + 1)


@pytest.mark.parametrize("name", CLAIMS)
def test_the_check_reaches_the_verdict(name: str) -> None:
    claim = CLAIMS[name]
    evidence = claim.check()
    assert evidence.verdict is claim.verdict, evidence.proof
    assert claim.printed_formulas()
    if claim.verdict in (Verdict.CORRECTED, Verdict.FALSE):
        assert evidence.counterexample
        assert claim.correction
        assert claim.corrected_formulas()


def test_every_equation_from_36_to_63_has_one_claim() -> None:
    assert [n for name in CLAIMS for n in numbers(name)] == list(range(36, 64))


@pytest.mark.parametrize("name", IDENTITIES)
def test_a_turned_sign_turns_the_verdict_of_an_identity(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Identity)
    right = body.printed if body.corrected is None else body.corrected
    for i in range(len(right)):
        wrong = right.copy()
        wrong[i] = -wrong[i]
        assert Identity(wrong, body.derived).check().verdict is Verdict.FALSE


@pytest.mark.parametrize("name", BRANCHES)
def test_a_turned_sign_turns_the_verdict_of_a_branch(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Branch)
    assert dataclasses.replace(body, printed=-body.printed).check().verdict is Verdict.FALSE
    if body.corrected is not None:
        assert dataclasses.replace(body, corrected=-body.corrected).check().verdict is Verdict.FALSE


def test_a_fact_that_fails_turns_the_verdict() -> None:
    held = Evidence(Verdict.HOLDS, "proved")
    assert with_facts(held, (Fact("1 = 1", lambda: True),)).proof == "proved; 1 = 1"
    failed = with_facts(held, (Fact("1 = 2", lambda: False),))
    assert failed.verdict is Verdict.FALSE
    assert failed.proof == "not true: 1 = 2"
    body = CLAIMS["44"].body
    assert isinstance(body, BranchWithFacts)
    wrong = dataclasses.replace(body, facts=(Fact("no", lambda: False),))
    assert wrong.check().verdict is Verdict.FALSE


def test_36_notices_the_wrong_order_of_the_factors() -> None:
    bent = dict.fromkeys(Q[:4], sp.pi / 2)
    reach, total = sp.Matrix(frame(4).subs(bent)), sp.Matrix(frame(7).subs(bent))
    assert wrist_rotation.check_product(sp.Matrix(reach.inv() * total)).verdict is Verdict.HOLDS
    assert wrist_rotation.check_product(sp.Matrix(total * reach.inv())).verdict is Verdict.FALSE
    assert wrist_rotation.check_product(between(4, 7)).verdict is Verdict.FALSE


def test_37_names_a_rotation_with_a_constant_shift() -> None:
    T = wrist_rotation.wrist().copy()
    T[0, 0] = -T[0, 0]
    assert wrist_rotation.check_names(T).verdict is Verdict.FALSE
    moved = wrist_rotation.wrist().copy()
    moved[1, 3] = moved[0, 3]
    assert wrist_rotation.check_names(moved).verdict is Verdict.FALSE


def test_38_fails_with_the_twist_of_table_1() -> None:
    tabled = sp.Matrix(wrist_rotation.wrist(-1)[:3, :3])
    assert Identity(wrist_rotation.printed_rotation(), tabled).check().verdict is Verdict.FALSE


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("44", "r13 = -1, r33 = 0, θ6 = 0: printed 0, true π"),
        ("44", "r13 = 0, r33 = 1, θ6 = 0: printed π/2, true -π/2"),
        ("47", "r22 = 0, r21 = 1, θ6 = 0: printed 0, true π"),
        ("47", "r22 = -1, r21 = 0, θ6 = 0: printed π/2, true -π/2"),
        ("51", "‖l‖ = √3, r11 + r22 + r33 = 0: printed -π/3, true 2·π/3"),
        ("53", "r23 = -1, r32 = 1): printed (0, 0, -2), true (2, 0, 0)"),
    ],
)
def test_counterexamples_are_in_the_inputs_of_the_formula(name: str, words: str) -> None:
    assert words in CLAIMS[name].check().counterexample


def test_every_correction_has_its_kind() -> None:
    assert {name: claim.fault for name, claim in CLAIMS.items() if claim.fault} == {
        "44": Fault.BRANCH,
        "47": Fault.BRANCH,
        "51": Fault.BRANCH,
        "53": Fault.MISPRINT,
        "55-56": Fault.MODEL,
        "60-61": Fault.WORDING,
        "63": Fault.MISPRINT,
    }
    assert all(claim.fault for claim in CLAIMS.values() if claim.verdict is Verdict.CORRECTED)


def test_40_holds_for_a_wrist_that_bends_by_90_degrees_only() -> None:
    body = CLAIMS["40"].body
    assert isinstance(body, BranchWithFacts)
    wider = {**body.domain, Q[5]: (-sp.pi, sp.pi)}
    assert dataclasses.replace(body, domain=wider).check().verdict is Verdict.FALSE
    assert not wrist_angles.theta6_for_all_angles(wrist_angles.PRINTED[Q[5]])


def test_44_meets_its_zero_denominator_exactly() -> None:
    body = CLAIMS["44"].body
    assert isinstance(body, BranchWithFacts)
    minus = body.printed.subs(sp.pi / 2, -sp.pi / 2)
    found = with_borders(dataclasses.replace(body, printed=minus), body.check(), body.borders).counterexample
    assert "r13 = 0, r33 = -1, θ6 = 0: printed -π/2, true π/2" in found
    spoilt = dataclasses.replace(body, corrected=body.printed)
    assert with_borders(spoilt, body.check(), body.borders).verdict is Verdict.FALSE


def test_atan2_with_the_sign_on_the_wrong_part_is_half_a_turn_off() -> None:
    R = wrist_rotation.printed_rotation()
    assert wrist_angles.half_turn_off(-R[1, 1], R[1, 0])
    assert not wrist_angles.half_turn_off(R[1, 1], -R[1, 0])


def test_the_share_of_orientations_tells_printed_from_corrected() -> None:
    assert wrist_together.a_quarter_is_reproduced(wrist_angles.PRINTED)
    assert not wrist_together.a_quarter_is_reproduced(wrist_angles.CORRECTED)
    half = {**wrist_angles.CORRECTED, Q[6]: wrist_angles.PRINTED[Q[6]]}
    _, right = wrist_together.reproduced(half)
    assert 0.45 < right.mean() < 0.55


def test_the_wrist_has_two_solutions_and_a_singularity() -> None:
    q5, q6, q7 = Q[4:]
    assert wrist_together.is_second_solution(q5 + sp.pi, sp.pi - q6, q7 + sp.pi)
    assert not wrist_together.is_second_solution(q5 + sp.pi, -q6, q7 + sp.pi)
    R = wrist_rotation.printed_rotation()
    assert wrist_together.singular_at_right_angle(sp.Matrix([R[0, 2], R[1, 0]]))
    assert not wrist_together.singular_at_right_angle(sp.Matrix([R[1, 2]]))


def test_50_counts_from_the_hand_to_the_target() -> None:
    assert residuals.check_sign(-residuals.printed_residual()).verdict is Verdict.FALSE


def test_50_knows_the_right_from_the_left_jacobian() -> None:
    right = log_derivative.inverse_right_jacobian
    assert log_derivative.is_derivative_of_the_arm(right)
    assert log_derivative.leaves_the_residual(right)

    def left(c: sp.Matrix, delta: sp.Expr) -> sp.Matrix:
        return right(-c, delta)

    def none(_c: sp.Matrix, _delta: sp.Expr) -> sp.Matrix:
        return sp.eye(3)

    def half(c: sp.Matrix, _delta: sp.Expr) -> sp.Matrix:
        return sp.eye(3) + log_derivative.cross_matrix(c) / 2

    for wrong in (left, none, half):
        assert not log_derivative.is_derivative(wrong)
        assert log_derivative.largest_miss(wrong) > 0.1


def test_52_notices_the_other_order_and_the_transpose() -> None:
    there, here = axis_angle.target_rotation(), axis_angle.current_rotation()
    for wrong in (sp.Matrix(here.T * there), sp.Matrix(here * there.T)):
        assert orientation_residual.check_difference_rotation(wrong).verdict is Verdict.FALSE


def test_53_is_the_right_vector_reflected() -> None:
    assert axis_angle.is_mirrored(axis_angle.printed_l, axis_angle.MIRROR)
    assert axis_angle.is_mirrored(axis_angle.corrected_l, sp.eye(3))
    assert not axis_angle.is_mirrored(axis_angle.corrected_l, axis_angle.MIRROR)
    assert not axis_angle.is_mirrored(axis_angle.printed_l, sp.eye(3))


@pytest.mark.parametrize(("degrees", "grows"), [(0, True), (55, True), (65, False), (90, False)])
def test_a_step_with_the_printed_l_moves_away_within_60_degrees(degrees: int, grows: bool) -> None:
    assert (axis_angle.growth(axis_angle.printed_l, degrees) > 1) is grows
    assert axis_angle.growth(axis_angle.corrected_l, degrees) < 0.1


def test_55_needs_its_minus_and_a_pseudo_inverse() -> None:
    def plus(J: np.ndarray, e: np.ndarray) -> np.ndarray:
        return -newton_step.corrected_step(J, e)

    printed, corrected = newton_step.printed_step, newton_step.corrected_step
    assert newton_step.check_step(printed, plus).verdict is Verdict.FALSE
    assert newton_step.check_step(corrected, corrected).verdict is Verdict.HOLDS
    assert newton_step.check_step(lambda J, e: -J.T @ e, printed).verdict is Verdict.FALSE


@pytest.mark.parametrize("component", [lambda x: x**2, lambda x: 2 * x, sp.sign])
def test_57_notices_another_sum_of_squares(component: Callable[[sp.Expr], sp.Expr]) -> None:
    assert newton_step.check_minimised(component).verdict is Verdict.FALSE


def test_60_61_hold_for_neither_another_sign_nor_another_factor() -> None:
    def turned(e: sp.Matrix, factor: int) -> sp.Matrix:
        form = levenberg_marquardt.normal_equations(e, factor)
        form[:, 4] = -form[:, 4]
        return form

    def tripled(e: sp.Matrix, factor: int) -> sp.Matrix:
        return levenberg_marquardt.normal_equations(e, 3 * factor)

    def doubled(e: sp.Matrix, factor: int) -> sp.Matrix:
        return levenberg_marquardt.normal_equations(e, 2 * factor)

    assert levenberg_marquardt.check_derivatives(turned).verdict is Verdict.FALSE
    assert levenberg_marquardt.check_derivatives(tripled).verdict is Verdict.FALSE
    assert levenberg_marquardt.check_derivatives(doubled).verdict is Verdict.HOLDS


def test_62_notices_a_turned_sign_and_a_lost_damping() -> None:
    right = levenberg_marquardt.printed_step
    for wrong in (
        lambda J, e, mu, inverse: -right(J, e, mu, inverse),
        lambda J, e, mu, inverse: right(J, e, 2 * mu, inverse),
        lambda J, e, mu, inverse: right(J, e, -mu, inverse),
    ):
        assert levenberg_marquardt.check_step(wrong).verdict is Verdict.FALSE


def test_63_notices_what_stands_behind_and_inside_the_bracket() -> None:
    printed, right = damped_svd_step.PRINTED, damped_svd_step.CORRECTED
    assert damped_svd_step.check_step(right, right).verdict is Verdict.HOLDS
    turned = damped_svd_step.SvdStep(right.bracket, lambda U, S, V: -V @ S.T @ U.T)
    without_U = damped_svd_step.SvdStep(right.bracket, lambda _U, S, V: V @ S.T)
    swapped = damped_svd_step.SvdStep(lambda S, V, k: right.bracket(S, V.T, k), right.behind)
    for wrong in (turned, without_U, swapped):
        assert damped_svd_step.check_step(printed, wrong).verdict is Verdict.FALSE
