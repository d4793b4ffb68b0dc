"""Axes by their anatomical names: "x forward, y up, z right"."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import OptionError

Array = NDArray[np.float64]
Words = tuple[tuple[str, str], tuple[str, str], tuple[str, str]]

# Each direction and its opposite; the three directions in this order are right-handed.
BODY: Words = (("up", "down"), ("right", "left"), ("forward", "backward"))
# Of a left hand; those of a right hand are left-handed in this order.
HAND: Words = (("fingers", "proximal"), ("ulnar", "radial"), ("dorsal", "palmar"))


def named_axes(text: str, words: Words, what: str, handed: int = 1) -> Array:
    """The matrix that turns components along x, y, z into components along three named directions.

    Two axes are enough: the third follows, because x, y, z are right-handed.

    Args:
        text: Such as "x forward, y up, z right" or "x forward, z up".
        words: The three directions with their opposites, `BODY` or `HAND`.
        what: The argument, for messages.
        handed: 1 if the three directions are right-handed in their order, -1 if left-handed.

    Returns:
        Shape (3, 3): row k holds the components of direction k along x, y and z.

    Raises:
        OptionError: If the text names an axis or direction twice, another word, or left-handed axes.

    Source:
        None (definition).
    """
    matrix = np.zeros((3, 3))
    for part in text.replace(";", ",").split(","):
        axis, k, sign = _one(part, words, what, text)
        if matrix[:, axis].any() or matrix[k].any():
            raise OptionError(f"{what} {text!r}: {part.strip()!r} says something a second time")
        matrix[k, axis] = sign
    named = int(np.abs(matrix).sum())
    if named < 2:
        raise OptionError(f"{what} {text!r}: name two or three axes, {_example(words)}")
    if named == 2:
        matrix = _completed(matrix, handed)
    if np.linalg.det(matrix) * handed < 0:
        raise OptionError(
            f"{what} {text!r}: these axes are left-handed; recordings have right-handed axes, so one "
            "direction is named with the wrong sign"
        )
    return matrix


def _one(part: str, words: Words, what: str, text: str) -> tuple[int, int, float]:
    pieces = part.lower().replace("=", " ").split()
    opposites = {
        word: (k, sign) for k, pair in enumerate(words) for word, sign in zip(pair, (1.0, -1.0), strict=True)
    }
    if len(pieces) != 2 or pieces[0] not in ("x", "y", "z") or pieces[1] not in opposites:
        raise OptionError(
            f"{what} {text!r}: cannot read {part.strip()!r}, expected x, y or z and one of "
            f"{', '.join(opposites)}: {_example(words)}"
        )
    return "xyz".index(pieces[0]), *opposites[pieces[1]]


def _completed(matrix: Array, handed: int) -> Array:
    full = matrix.copy()
    row = int(np.flatnonzero(~matrix.any(axis=1))[0])
    column = int(np.flatnonzero(~matrix.any(axis=0))[0])
    full[row, column] = 1.0
    if np.linalg.det(full) * handed < 0:
        full[row, column] = -1.0
    return full


def _example(words: Words) -> str:
    return f'for example "x {words[0][0]}, y {words[1][0]}"'
