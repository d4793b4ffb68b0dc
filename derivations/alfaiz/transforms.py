"""Al-Faiz, eq. (1) and (2): homogeneous matrices and the transform of one DH row."""

from __future__ import annotations

import math

import sympy as sp
from sympy import cos, sin

from derivations.alfaiz.elementary_transforms import homogeneous, modified_row, rot_x, rot_z, shift
from derivations.claim import Check, Claim, Evidence, Fault, Formula, Verdict
from derivations.identity import Identity

PAPER = "alfaiz"
_theta, _alpha, _a, _d = sp.symbols("theta alpha a d", real=True)
_TWISTS = {sp.Integer(0): 0.0, sp.pi / 2: math.pi / 2, -sp.pi / 2: -math.pi / 2, sp.pi: math.pi}


def printed_composition() -> sp.Matrix:
    """The last line of eq. (1) as printed: what "rot · trans" is said to be.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 1.
    """
    return homogeneous(_some_rotation(), _some_shift())


def printed_matrix() -> sp.Matrix:
    """The matrix of eq. (2) as printed, a for b (the text below it calls the link length a).

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 2.
    """
    c, s, ca, sa = cos(_theta), sin(_theta), cos(_alpha), sin(_alpha)
    return sp.Matrix(
        [
            [c, -s, 0, _a],
            [ca * s, ca * c, -sa, -_d * sa],
            [sa * s, sa * c, ca, _d * ca],
            [0, 0, 0, 1],
        ]
    )


def printed_product() -> sp.Matrix:
    """The product of eq. (2) as printed: Rot_z,α Trans_x,a Rot_z,θ Trans_z,d.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Al-Faiz, eq. 2.
    """
    return sp.Matrix(rot_z(_alpha) * shift(_a, 0, 0) * rot_z(_theta) * shift(0, 0, _d))


def corrected_product() -> sp.Matrix:
    """The product of eq. (2) with x for the first z.

    Returns:
        SymPy matrix of shape (4, 4).

    Source:
        Craig, Introduction to Robotics, eq. 3.6.
    """
    return sp.Matrix(rot_x(_alpha) * shift(_a, 0, 0) * rot_z(_theta) * shift(0, 0, _d))


def check_row(product: sp.Matrix, matrix: sp.Matrix, corrected: sp.Matrix | None = None) -> Evidence:
    """Whether a product of elementary transforms is a matrix, and the matrix a modified DH row.

    Args:
        product: The product as printed.
        matrix: The matrix as printed.
        corrected: The product with a correction.

    Returns:
        The evidence.

    Source:
        Al-Faiz, eq. 2.
    """
    found = Identity(product, matrix, corrected).check()
    for twist, number in _TWISTS.items():
        of_model = modified_row(number, _theta, _a, _d)
        row = Identity(matrix.subs(_alpha, twist), of_model).check()
        if row.verdict is not Verdict.HOLDS:
            return Evidence(
                Verdict.FALSE, f"the matrix is no modified row at alpha = {twist}", row.counterexample
            )
    words = "; the matrix is the model's modified row for alpha = 0, 90°, -90° and 180°"
    return Evidence(found.verdict, found.proof + words, found.counterexample)


def _some_rotation() -> sp.Matrix:
    """Any rotation: three turns about z, x, z."""
    u, v, w = sp.symbols("u v w", real=True)
    return sp.Matrix((rot_z(u) * rot_x(v) * rot_z(w))[:3, :3])


def _some_shift() -> sp.Matrix:
    return sp.Matrix(sp.symbols("t_x t_y t_z", real=True))


def _rot_times_trans() -> sp.Matrix:
    return sp.Matrix(homogeneous(_some_rotation(), sp.zeros(3, 1)) * shift(*_some_shift()))


def _trans_times_rot() -> sp.Matrix:
    return sp.Matrix(shift(*_some_shift()) * homogeneous(_some_rotation(), sp.zeros(3, 1)))


def _check_composition() -> Evidence:
    if Identity(_rot_times_trans(), printed_composition()).check().verdict is Verdict.HOLDS:
        return Evidence(Verdict.HOLDS, "rot · trans is the printed matrix")
    return Identity(_rot_times_trans(), printed_composition(), _trans_times_rot()).check()


_ROWS = r"\mathrm{Trans}_{x,a_i}\,\mathrm{Rot}_{z,\theta_i}\,\mathrm{Trans}_{z,d_i}"
_BLOCKS = r"\begin{bmatrix} R & t \\ 0 & 1 \end{bmatrix}"

CLAIMS = (
    Claim(
        PAPER,
        "1",
        "rotation and translation as 4 × 4 matrices",
        Verdict.CORRECTED,
        "The two matrices are right, their product is not: rot · trans shifts along the turned axes and "
        "gives [R, R·t; 0, 1]. The printed [R, t; 0, 1] is trans · rot. (If the last line only names the "
        "combined matrix, there is nothing to correct.)",
        Check(
            _check_composition,
            printed=(Formula(r"\mathrm{rot}\cdot\mathrm{trans}", _BLOCKS),),
            corrected=(Formula(r"\mathrm{trans}\cdot\mathrm{rot}", _BLOCKS),),
        ),
        derivation="Both products are multiplied out for an arbitrary rotation (turns about z, x, z) and an "
        "arbitrary shift. Only eq. (2) is used later; it multiplies in its own order.",
        correction="exchange the factors: trans · rot = [R, t; 0, 1]",
        fault=Fault.WORDING,
        extraction="in the stored matrix of trans the block t (3 × 1) stands in one row of the last column; "
        "rot and trans side by side are read as a product",
    ),
    Claim(
        PAPER,
        "2",
        "the transform of one DH row",
        Verdict.CORRECTED,
        "The matrix is the modified (proximal) Denavit-Hartenberg transform, with b for the link length a. "
        "The product in front of it turns about z where it has to turn about x. Program the matrix; and "
        "do not read Table 1 in the standard (distal) convention of the textbook the paper cites.",
        Check(
            lambda: check_row(printed_product(), printed_matrix(), corrected_product()),
            printed=(
                Formula("A_i", r"\mathrm{Rot}_{z,\alpha_i}\," + _ROWS),
                Formula("A_i", printed_matrix().subs(_a, sp.Symbol("b"))),
            ),
            corrected=(Formula("A_i", r"\mathrm{Rot}_{x,\alpha_i}\," + _ROWS),),
        ),
        derivation="The four elementary transforms are multiplied out and compared with the printed matrix.",
        correction="Rot_x,α for Rot_z,α; a for b",
        fault=Fault.MISPRINT,
    ),
)
