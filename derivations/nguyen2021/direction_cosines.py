"""How many of its nine direction cosines determine a rotation."""

from __future__ import annotations

import functools
import itertools

import sympy as sp

from derivations.exact_zero import is_exactly_zero
from derivations.nguyen2021.chain import frame
from derivations.random_points import largest_difference

_ROUNDING = 1e-9


def collision(entries: tuple[int, ...]) -> tuple[sp.Matrix, sp.Matrix] | None:
    """Two different rotations that agree in some of their nine direction cosines.

    Args:
        entries: The entries compared, 0 to 8, row by row.

    Returns:
        The first such pair among the 24 rotations of a cube, or None.

    Source:
        None (search).
    """
    seen: dict[tuple[sp.Expr, ...], sp.Matrix] = {}
    for R in _cube_rotations():
        key = tuple(R[k] for k in entries)
        if key in seen:
            return seen[key], R
        seen[key] = R
    return None


@functools.cache
def _cube_rotations() -> tuple[sp.Matrix, ...]:
    found = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            R = sp.zeros(3, 3)
            for row, column in enumerate(order):
                R[row, column] = signs[row]
            if R.det() == 1:
                found.append(R)
    return tuple(found)


def determining(count: int) -> list[tuple[int, ...]]:
    """The choices of so many direction cosines for which no two rotations of a cube agree.

    Args:
        count: How many of the nine are compared.

    Returns:
        The choices, each as its entries 0 to 8, row by row.

    Source:
        None (search).
    """
    return [entries for entries in itertools.combinations(range(9), count) if collision(entries) is None]


def two_whole_lines_suffice() -> bool:
    """Whether six cosines determine a rotation exactly if they are two whole columns, or two whole rows.

    No other six do (see `determining`); of these the third follows as a cross product.

    Returns:
        True if proved, for R_0^5 of the chain and in CasADi at 1,000 random points.

    Source:
        None (a rotation is right-handed).
    """
    lines = [[(3 * i, 3 * i + 1, 3 * i + 2) for i in range(3)], [(i, i + 3, i + 6) for i in range(3)]]
    pairs = sorted(tuple(sorted(a + b)) for kind in lines for a, b in itertools.combinations(kind, 2))
    R = frame(5)[:3, :3]
    for matrix in (R, R.T):
        for i in range(3):
            third = matrix[:, i - 2].cross(matrix[:, i - 1])
            exact = all(is_exactly_zero(a - b) for a, b in zip(third, matrix[:, i], strict=True))
            if not exact or largest_difference(third, matrix[:, i]) > _ROUNDING:
                return False
    return determining(6) == pairs


def half_turn_unseen() -> str:
    """Orientations that differ by half a turn and agree in three cosines, in words.

    Returns:
        The words, empty if they do not agree.

    Source:
        None (two examples).
    """
    quarter, half = sp.rot_axis3(sp.pi / 2), sp.rot_axis1(sp.pi)
    if quarter.diagonal() != quarter.T.diagonal() or half[:, 0] != sp.eye(3)[:, 0]:
        return ""
    return (
        f"quarter turns by +90° and -90° about z have the same diagonal {tuple(quarter.diagonal())}; turns "
        f"by 0° and 180° about x the same first column {tuple(half[:, 0])}: cost 0 for an orientation half a "
        "turn off"
    )
