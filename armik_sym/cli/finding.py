"""What a check of `armik doctor` found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

_REINSTALL = "install it again: pip install --force-reinstall armik_sym"


@dataclass(frozen=True)
class Finding:
    """What a check found.

    Attributes:
        what: What was looked for.
        state: "found", "missing", or "broken" if it is there but does not work.
        detail: Version, place, or what is wrong.
        remedy: How to get or mend it; empty if nothing is wrong.
        essential: True if nothing can be solved without it.
    """

    what: str
    state: Literal["found", "missing", "broken"]
    detail: str
    remedy: str = ""
    essential: bool = False


def reinstall(what: str, detail: str) -> Finding:
    """A finding that something essential of the package itself is not right.

    Args:
        what: What was looked for.
        detail: What is wrong.

    Returns:
        The finding.

    Source:
        None (command line).
    """
    return Finding(what, "broken", detail, _REINSTALL, essential=True)
