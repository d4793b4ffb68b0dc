"""The pointwise methods by name."""

from __future__ import annotations

from collections.abc import Callable

from armik_sym.pointwise.alfaiz.options import AlfaizOptions
from armik_sym.pointwise.alfaiz.run import run_alfaiz
from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.run import run_damped
from armik_sym.pointwise.differential_evolution.options import IsadeOptions, ProIsadeOptions
from armik_sym.pointwise.differential_evolution.run import run_isade
from armik_sym.pointwise.judging import Judging
from armik_sym.pointwise.solve_pointwise import named
from armik_sym.solution import Solution

# Name: its options, and the function (arm, path, options, *, start, seed, backend, progress) → Solution.
METHODS: dict[str, tuple[type[Judging], Callable[..., Solution]]] = {
    name: (options, named(name, run))
    for name, options, run in (
        ("pro-isade", ProIsadeOptions, run_isade),
        ("isade", IsadeOptions, run_isade),
        ("lm", LmOptions, run_damped),
        ("sugihara", SugiharaOptions, run_damped),
        ("alfaiz", AlfaizOptions, run_alfaiz),
    )
}
