"""Arrays as C sees them."""

from __future__ import annotations

import ctypes
from typing import Any

from numpy.typing import NDArray


def address(array: NDArray[Any] | None) -> ctypes.c_void_p:
    """Address of the first entry of an array, or NULL.

    Args:
        array: A C-contiguous array, or None.

    Returns:
        The pointer; valid as long as the array lives.

    Source:
        None (packaging).
    """
    return ctypes.c_void_p(None if array is None else array.ctypes.data)
