"""Al-Faiz, eq. (1)-(35), solutions and swivel: verdicts are reached, and wrong statements turn them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import sympy as sp
from sympy import atan2, cos, pi, sin

from derivations.alfaiz import (
    elbow_angle,
    shoulder_phi,
    shoulder_position,
    shoulder_radius,
    shoulder_second_angle,
    shoulder_third_angle,
    solution_count,
    swivel_meaning,
    table,
    transforms,
)
from derivations.alfaiz.chain import L3, L4, OFFSETS, Q
from derivations.alfaiz.closed_form import Lengths, elbow_frame, phi_of, pose, solutions
from derivations.alfaiz.elementary_transforms import homogeneous, modified_row, rot_x, rot_z, shift
from derivations.alfaiz.exact_borders import check_with_borders
from derivations.alfaiz.facts import IdentityWithFacts
from derivations.alfaiz.letters import in_letters, in_words
from derivations.alfaiz.no_other_solutions import shoulder_and_elbow_count, wrist_counts
from derivations.alfaiz.swivel_geometry import ElbowCircle
from derivations.branch import Branch
from derivations.claim import Claim, Fault, Verdict
from derivations.identity import Identity

MODULES = (
    transforms,
    table,
    elbow_angle,
    shoulder_position,
    shoulder_phi,
    shoulder_radius,
    shoulder_second_angle,
    shoulder_third_angle,
    solution_count,
    swivel_meaning,
)
CLAIMS: dict[str, Claim] = {claim.equation: claim for module in MODULES for claim in module.CLAIMS}
IDENTITIES = [name for name, claim in CLAIMS.items() if isinstance(claim.body, Identity)]


def numbers(equation: str) -> range:
    first, _, last = equation.partition("-")
    return range(int(first), int(last or first) + 1) if first.isdigit() else range(0)


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


FAULTS = {
    "1": Fault.WORDING,
    "2": Fault.MISPRINT,
    "Table 1": Fault.MISPRINT,
    "5": Fault.MISPRINT,
    **dict.fromkeys(("20", "21", "22", "35"), Fault.BRANCH),
}


def test_every_correction_has_its_kind() -> None:
    assert {name: claim.fault for name, claim in CLAIMS.items() if claim.fault} == FAULTS


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("5", "l4 = l3 = 1, θ4 = 0 (straight arm): printed tg = 0, true 2"),
        ("20", "dx = 0, dz = -1, φ = 0: printed 0, true π"),
        ("20", "dx = -1, dz = 0, φ = 0: printed -π/2, true π/2"),
        ("22", "r·cos φ = 3/20, θ4 = π/2, l3 = 6/25, l4 = 3/10: printed π/6, true 5·π/6"),
        ("35", "k5 = 0, k6 = -1: printed 0, true π"),
    ],
)
def test_counterexamples_are_in_the_inputs_of_the_formula(name: str, words: str) -> None:
    assert words in CLAIMS[name].check().counterexample


def test_what_is_displayed_is_what_is_checked() -> None:
    """A mutated statement is displayed mutated; abbreviations put back give the checked expression."""
    named = [name for name in IDENTITIES if getattr(CLAIMS[name].body, "names", None) is not None]
    assert {"9-10", "11-12", "15-18", "19", "24-25", "28-29", "33-34"} <= set(named)
    for name in named:
        body = CLAIMS[name].body
        assert isinstance(body, IdentityWithFacts)
        shown = body.printed_formulas()
        assert len(shown) == len(body.printed)
        for i in range(len(body.printed)):
            wrong = body.printed.copy()
            wrong[i] = -wrong[i]
            other = dataclasses.replace(body, printed=wrong).printed_formulas()
            changed = [(a.left, a.right) != (b.left, b.right) for a, b in zip(shown, other, strict=True)]
            assert changed == [k == i for k in range(len(shown))]


def test_letters_are_names_only() -> None:
    form = shoulder_position.printed_dx()
    s, c, theta = (sp.symbols(f"{x}_1:8") for x in ("s", "c", "theta"))
    assert in_letters(form).free_symbols == {*s[:4], *c[:4], L3, L4}
    back = dict(zip((*s, *c), (*map(sin, Q), *map(cos, Q)), strict=True))
    assert in_letters(form).xreplace(back) == form
    assert str(in_letters(Q[0] + sin(Q[1]))) == f"{s[1]} + {theta[0]}"
    assert in_words(sp.sqrt(3) * pi / 2) == "√3·π/2"


def test_every_equation_from_1_to_35_has_one_claim() -> None:
    assert sorted(k for name in CLAIMS for k in numbers(name)) == list(range(1, 36))
    assert len(CLAIMS) == sum(len(module.CLAIMS) for module in MODULES)
    assert {"Table 1", "A_1…A_7", "solutions", "swivel"} < set(CLAIMS)


@pytest.mark.parametrize("name", IDENTITIES)
def test_a_turned_sign_turns_the_verdict_of_an_identity(name: str) -> None:
    body = CLAIMS[name].body
    assert isinstance(body, Identity)
    for i in range(len(body.printed)):
        wrong = body.printed.copy()
        wrong[i] = -wrong[i]
        assert dataclasses.replace(body, printed=wrong).check().verdict is Verdict.FALSE


def test_equation_1_holds_only_with_the_factors_exchanged() -> None:
    R, t = sp.Matrix(rot_z(sp.Symbol("u"))[:3, :3]), sp.Matrix(sp.symbols("x y z"))
    rot, trans = homogeneous(R, sp.zeros(3, 1)), shift(*t)
    assert trans * rot == homogeneous(R, t)
    assert rot * trans != homogeneous(R, t)


def test_equation_2_would_hold_with_the_right_product() -> None:
    right, matrix = transforms.corrected_product(), transforms.printed_matrix()
    assert transforms.check_row(right, matrix).verdict is Verdict.HOLDS
    assert transforms.check_row(transforms.printed_product(), matrix).verdict is Verdict.FALSE
    alpha, theta, a, d = sp.symbols("alpha theta a d", real=True)
    standard = sp.Matrix(rot_z(theta) * shift(0, 0, d) * shift(a, 0, 0) * rot_x(alpha))
    assert transforms.check_row(standard, standard).verdict is Verdict.FALSE, "no modified row"
    assert modified_row(0.0, theta, a, d) == rot_z(theta) + shift(a, 0, d) - sp.eye(4)


def test_table_1_is_wrong_in_row_6_only() -> None:
    right = table.Table(alpha=(1, 1, -1, 1, -1, 1, -1))
    assert table.check_table(right, right).verdict is Verdict.HOLDS
    for row in (0, 4, 5):
        alpha = tuple(-x if i == row else x for i, x in enumerate(right.alpha))
        wrong = table.Table(alpha=alpha)
        assert table.check_table(wrong, right).verdict is Verdict.CORRECTED
        assert table.check_table(wrong, wrong).verdict is Verdict.FALSE
    assert table.check_table(table.Table(), right).counterexample.startswith("row 6:")
    for change in ({"offsets": (0,) * 7}, {"a": (0, 0, 0, L3, L4, 0, 0)}):
        wrong = dataclasses.replace(right, **change)
        assert table.check_table(wrong, wrong).verdict is Verdict.FALSE


def test_the_link_matrices_need_the_offsets() -> None:
    assert table.check_product(OFFSETS).verdict is Verdict.DEFINITION
    assert table.check_product((0,) * 7).verdict is Verdict.FALSE


def test_the_law_of_cosines_needs_both_corrections() -> None:
    right = elbow_angle.corrected_squared_distance()
    printed = elbow_angle.printed_distance()
    assert elbow_angle.check_distance(printed, right).verdict is Verdict.CORRECTED
    assert elbow_angle.check_distance(printed, printed).verdict is Verdict.FALSE
    assert elbow_angle.check_distance(right, printed).verdict is Verdict.FALSE


def test_the_elbow_angle_knows_a_wrong_sign() -> None:
    tg = sp.Symbol("tg", positive=True)
    right = elbow_angle.printed_cosine(tg**2)
    assert elbow_angle.check_elbow(right).verdict is Verdict.HOLDS
    assert elbow_angle.check_elbow(-right).verdict is Verdict.FALSE
    assert elbow_angle.check_elbow(elbow_angle.printed_cosine(tg)).verdict is Verdict.FALSE


def test_coordinates_know_wrong_readings() -> None:
    dx = shoulder_position.printed_dx
    check = shoulder_position.check_coordinate
    assert check(lambda: dx((2, 2, 2)), 0, dx).verdict is Verdict.FALSE
    assert check(lambda: -dx(), 0, dx).verdict is Verdict.FALSE
    assert check(dx, 2, dx).verdict is Verdict.FALSE
    undecided = check(dx, 0, lambda reading: dx() if reading != (2, 2, 2) else dx(reading))
    assert undecided.verdict is Verdict.FALSE, "more than one reading holds"
    turned = shoulder_position.printed_dy().subs(Q[1], -Q[1])
    assert check(lambda: turned, 1, lambda _: turned).verdict is Verdict.FALSE


def test_lost_quadrants_are_found() -> None:
    first, second = shoulder_phi.theta1_branch(), shoulder_second_angle.theta2_branch()
    for branch in (first, second, shoulder_third_angle.theta3_branch()):
        assert branch.check().verdict is Verdict.CORRECTED
        assert dataclasses.replace(branch, corrected=-branch.corrected).check().verdict is Verdict.FALSE
        assert dataclasses.replace(branch, printed_domain=None, corrected=branch.printed).check().verdict is (
            Verdict.FALSE
        )


def test_a_printed_case_of_its_own_is_seen_only_exactly() -> None:
    x = Q[1]
    border = [{x: pi / 2}, {x: -pi / 2}]
    two = atan2(sin(x), cos(x))
    right = Branch("x", two, x, {x: (-pi, pi)})
    assert check_with_borders(right, border).verdict is Verdict.HOLDS
    spoilt = sp.Piecewise((two, sp.Ne(cos(x), 0)), (pi / 2, True))
    hidden = Branch("x", spoilt, x, {x: (-pi, pi)}, points=15)
    assert hidden.check().verdict is Verdict.HOLDS, "rounding hides it"
    assert check_with_borders(hidden, border).verdict is Verdict.FALSE
    half = {x: (-pi / 2, pi / 2)}
    mended = Branch("x", sp.atan(sin(x) / cos(x)), x, {x: (-pi, pi)}, half, spoilt, points=15)
    assert check_with_borders(mended, border).verdict is Verdict.FALSE


def test_printed_and_corrected_azimuth_and_radius_do_not_mix() -> None:
    printed, corrected = shoulder_radius.PRINTED, shoulder_radius.CORRECTED
    check = shoulder_radius.check_radius
    assert check(printed, corrected).verdict is Verdict.CORRECTED
    assert check(corrected, corrected).verdict is Verdict.HOLDS
    mixed = dataclasses.replace(printed, radius=corrected.radius)
    assert check(mixed, corrected).verdict is Verdict.FALSE
    assert check(printed, mixed).verdict is Verdict.FALSE
    other_mix = dataclasses.replace(corrected, radius=printed.radius)
    assert other_mix.is_right(sp.Integer(2), sp.Integer(-1))
    assert not other_mix.is_right(sp.Integer(0), sp.Integer(-1))


def test_the_linear_system_knows_a_wrong_sign() -> None:
    k3, k4 = shoulder_second_angle.printed_k3(), shoulder_second_angle.printed_k4()
    system = shoulder_second_angle.printed_system
    assert shoulder_second_angle.check_system(system(k3, k4)).verdict is Verdict.HOLDS
    assert shoulder_second_angle.check_system(system(k3, -k4)).verdict is Verdict.FALSE
    assert shoulder_second_angle.check_system(system(k3, k4).T * sp.diag(1, -1)).verdict is Verdict.FALSE


@pytest.mark.parametrize("case", solution_count.COUNTS)
def test_a_wrong_number_of_solutions_is_found(case: str) -> None:
    stated = dict(solution_count.COUNTS)
    stated[case] += 1
    evidence = solution_count.check_counts(stated)
    assert evidence.verdict is Verdict.FALSE
    assert evidence.counterexample


def test_algebra_allows_four_times_two_solutions() -> None:
    assert shoulder_and_elbow_count() == 4
    assert wrist_counts() == (2, 2, 2)


def test_eight_solutions_share_two_elbows() -> None:
    lengths = Lengths()
    q = np.array([0.4, -0.3, 0.5, 0.8, 0.7, 0.2, -0.4])
    found = solutions(pose(q, lengths), phi_of(q, lengths), lengths)
    assert len(found) == 8
    elbows = np.array([elbow_frame(x, lengths)[:3, 3] for x in found])
    assert len(np.unique(np.round(elbows, 9), axis=0)) == 2
    flexing = [x for x in found if x[3] >= 0]
    assert len(flexing) == 4
    assert len([x for x in flexing if np.cos(x[5]) > 0]) == 2


def test_the_swivel_formula_knows_a_turned_sign() -> None:
    right = swivel_meaning.tangent_of_phi

    def turned(*values: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        above, below = right(*values)
        return -above, below

    def shifted(sin_psi: sp.Expr, cos_psi: sp.Expr, *others: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        return right(-sin_psi, -cos_psi, *others)

    for wrong in (turned, shifted):
        evidence = swivel_meaning.check_swivel(wrong)
        assert evidence.verdict is Verdict.FALSE
        assert evidence.counterexample


def test_the_angle_at_the_shoulder_does_not_take_the_sign_of_the_elbow() -> None:
    def signed(theta4: sp.Expr) -> sp.Expr:
        return L3 * sin(theta4) / (L4 + L3 * cos(theta4))

    evidence = swivel_meaning.check_swivel(swivel_meaning.tangent_of_phi, signed)
    assert evidence.verdict is Verdict.FALSE
    assert "θ4 = -" in evidence.counterexample


@pytest.mark.parametrize("height", [0.05, 0.35])
def test_phi_of_psi_turns_back_only_if_the_wrist_is_low(height: float) -> None:
    circle = ElbowCircle(np.array([0.1, -height, 0.2]), Lengths())
    psi = np.linspace(-np.pi, np.pi, 2001)
    above, below = swivel_meaning.tangent_of_phi(
        np.sin(psi), np.cos(psi), np.sin(circle.beta), np.cos(circle.beta), np.tan(circle.gamma)
    )
    steps = np.diff(np.unwrap(np.arctan2(above, below)))
    low = abs(circle.beta) < circle.gamma
    assert low == (height == 0.05)
    assert (steps.min() < 0 < steps.max()) == low
    assert abs(steps.sum()) == pytest.approx(0 if low else 2 * np.pi, abs=1e-9)


def test_the_elbow_circle_is_the_chains() -> None:
    rng = np.random.default_rng(5)
    lengths = Lengths(0.31, 0.27)
    for _ in range(50):
        q = rng.uniform(-np.pi, np.pi, 7)
        q[3] = rng.choice([-1, 1]) * rng.uniform(0.1, 3.0)
        elbow = elbow_frame(q, lengths)[:3, 3]
        circle = ElbowCircle(pose(q, lengths)[:3, 3], lengths)
        np.testing.assert_allclose(circle.elbow(circle.psi(elbow)), elbow, atol=1e-12)
        assert np.tan(circle.gamma) == pytest.approx(
            lengths.l3 * abs(np.sin(q[3])) / (lengths.l4 + lengths.l3 * np.cos(q[3]))
        )


def test_the_forearm_and_the_upper_arm_keep_their_letters() -> None:
    assert shoulder_position.k1().coeff(L4) == sin(Q[2])
    assert (shoulder_position.k1() / L3).expand().coeff(cos(Q[3])) == sin(Q[2])
