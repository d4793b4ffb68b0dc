"""Nguyen 2021, §4.2 and Table 5: the settings of the search."""

from __future__ import annotations

import functools

import numpy as np
import sympy as sp

from derivations.claim import Check, Claim, Evidence, Formula, Verdict
from derivations.nguyen2021.chain import Q, frame
from derivations.random_points import evaluate

PAPER = "nguyen2021"

# Table 5, the text of §4.2, and the averages of Table 6.
TABLE_ITER_MAX, TEXT_ITER_MAX = 150, 600
MAX_ERROR_TEXT = "1e-5"
MAX_ERROR_MM = sp.Float(MAX_ERROR_TEXT)
SEARCH_SPACE = sp.pi / 100
AVERAGE_GENERATIONS = ("27.7000", "41.4200", "26.6857", "34.8667", "31.2333")
AVERAGE_ERROR_MM = ("1.9551e-6", "2.3364e-6", "1.8448e-6", "2.1415e-6", "1.9633e-6")


def check_settings(table_iter_max: int, text_iter_max: int) -> Evidence:
    """Is one largest number of generations given, and what hangs on it?

    Args:
        table_iter_max: The one of Table 5.
        text_iter_max: The one of §4.2.

    Returns:
        `Verdict.NOT_CHECKABLE` if they differ and the averages of Table 6 do not decide.

    Source:
        Nguyen 2021, Tables 5 and 6, §4.2.
    """
    generations = max(sp.Rational(text) for text in AVERAGE_GENERATIONS)
    if max(sp.Float(text) for text in AVERAGE_ERROR_MM) > MAX_ERROR_MM:
        return Evidence(Verdict.FALSE, "Table 6 exceeds the largest error of Table 5", "see Table 6")
    degrees = sp.Rational(SEARCH_SPACE * 180 / sp.pi)
    base = (
        f"errors of Table 6 are below 1e-5 mm; π/100 = {float(degrees):g}°, by which one shoulder joint "
        f"carries the wrist of the stretched arm {_carried_mm():.1f} mm"
    )
    if table_iter_max == text_iter_max:
        return Evidence(Verdict.HOLDS, base)
    if generations > min(table_iter_max, text_iter_max):
        return Evidence(Verdict.FALSE, base, "Table 6 needs more generations than the smaller iter_max")
    left = [float(1 - generations / largest) for largest in (table_iter_max, text_iter_max)]
    return Evidence(
        Verdict.NOT_CHECKABLE,
        f"{base}; by generation {float(generations):g}, the largest average of Table 6, F^mean (n_iter = 1) "
        f"still has {left[0]:.2f} of its fall ahead with iter_max = {table_iter_max}, {left[1]:.2f} with "
        f"{text_iter_max}",
    )


def _carried_mm() -> float:
    stretched = dict.fromkeys(Q[1:], sp.Integer(0))
    p = frame(5).subs(stretched)[:3, 3]
    chord = sp.Matrix(p - p.subs(Q[0], 0)).norm()
    return float(evaluate(chord, [Q[0]], np.array([[float(SEARCH_SPACE)]]))[0])


CLAIMS = (
    Claim(
        PAPER,
        "Table 5",
        "settings of the search",
        Verdict.NOT_CHECKABLE,
        "iter_max is 150 here and 600 in §4.2; Table 6 (27 to 41 generations on average) fits both, but F "
        "depends on it through eq. (13). Population, α, F_min, F_max, n_iter, a, b, the first CR and the "
        "odds of the three strategies are not printed at all: the search cannot be repeated from the paper.",
        Check(
            functools.partial(check_settings, TABLE_ITER_MAX, TEXT_ITER_MAX),
            (
                Formula("iter_{max}", sp.Integer(TABLE_ITER_MAX)),
                Formula(r"\text{Max distance Error (mm)}", rf"\text{{{MAX_ERROR_TEXT}}}"),
                Formula(
                    r"\text{Searching space } [ubs_{i+1}, lbs_{i+1}]",
                    rf"q_{{oi}} \pm {sp.latex(SEARCH_SPACE)}",
                ),
                Formula(r"\text{Cross. rate}", r"\text{Equation (15)}"),
                Formula("F_w", r"\text{Equations (12-14)}"),
            ),
        ),
        derivation="The search space is printed as [ubs, lbs], upper bound first. F_w is the F of eq. (14), "
        "by a name that occurs nowhere else. ±1.8° per sample bounds the speed of every joint, whatever the "
        "data; the time between samples is not printed.",
    ),
)
