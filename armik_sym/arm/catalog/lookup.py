"""Finding an arm of the catalogue by its name."""

from __future__ import annotations

from collections.abc import Callable

from armik_sym.arm.catalog.alfaiz import alfaiz
from armik_sym.arm.catalog.ehmcs import ehmcs
from armik_sym.arm.catalog.human import human
from armik_sym.arm.model import Arm
from armik_sym.errors import UnknownNameError

_BUILDERS: dict[str, Callable[[], Arm]] = {"alfaiz": alfaiz, "ehmcs": ehmcs, "human": human}


def names() -> tuple[str, ...]:
    """Names of the arms in the catalogue, in alphabetical order."""
    return tuple(sorted(_BUILDERS))


def by_name(name: str) -> Arm:
    """The arm of that name, with its default lengths and range of motion.

    Args:
        name: One of `names()`.

    Returns:
        The arm.

    Raises:
        UnknownNameError: If the catalogue has no such arm.

    Source:
        None (bookkeeping).
    """
    if name not in _BUILDERS:
        raise UnknownNameError("arm", name, names())
    return _BUILDERS[name]()
