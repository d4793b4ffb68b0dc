"""Choosing among equivalent angles the ones closest to a neighbour."""

from __future__ import annotations

from collections.abc import Callable, Set

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FULL_TURN = 2 * np.pi


def nearest_of_two(one: Array, other: Array, near: Array) -> Array:
    """Of two solutions and all their full turns the one nearest to a neighbour: min ‖q - near‖.

    Args:
        one: First solution, shape (n, 3), in [rad].
        other: Second solution, shape (n, 3), in [rad].
        near: Neighbour, shape (n, 3) or (3,), in [rad].

    Returns:
        Shape (n, 3), in [rad].

    Source:
        None (minimum over a lattice: every angle on its own).
    """
    one, other = turned_to(one, near), turned_to(other, near)
    closer = ((one - near) ** 2).sum(axis=-1) <= ((other - near) ** 2).sum(axis=-1)
    return np.where(closer[..., np.newaxis], one, other)


def turned_to(angles: Array, near: Array) -> Array:
    """The same angles, moved by full turns to within half a turn of a neighbour.

    Args:
        angles: Any shape, in [rad].
        near: Same shape, in [rad].

    Returns:
        Same shape, in [rad].

    Source:
        None (rounding).
    """
    return np.asarray(angles - _FULL_TURN * np.round((angles - near) / _FULL_TURN))


def along_path(
    one: Array,
    other: Array,
    near: Array,
    singular: Set[int],
    again: Callable[[int, float], Array],
    other_of: Callable[[Array], Array],
) -> Array:
    """A continuous path through solutions: each sample nearest to the one before.

    Args:
        one: First solution of every sample, shape (n, 3), in [rad].
        other: Second solution of every sample, shape (n, 3), in [rad].
        near: Where the path comes from, shape (3,), in [rad].
        singular: Samples whose first angle is not determined.
        again: Solution of a sample (index) with a given first angle, shape (3,).
        other_of: The second solution that belongs to a first one.

    Returns:
        Shape (n, 3), in [rad].

    Source:
        None (greedy continuation).
    """
    path = np.empty_like(one)
    for k in range(len(one)):
        a, b = one[k], other[k]
        if k in singular:
            a = again(k, float(near[0]))
            # The first angle of the other branch is free as well: keep it where it was.
            b = other_of(a)
            b[0], b[2] = a[0], a[2]
        near = path[k] = nearest_of_two(a, b, near)
    return path
