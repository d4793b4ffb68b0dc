"""All claims, in the order of the papers, and which equations they cover."""

from __future__ import annotations

import re
from types import ModuleType

from derivations import alfaiz, nguyen2021
from derivations.claim import Claim

PAPERS: dict[str, ModuleType] = {"nguyen2021": nguyen2021, "alfaiz": alfaiz}

# Every numbered equation of the two papers, and the tables that define or contradict them.
EQUATIONS: dict[str, tuple[str, ...]] = {
    "nguyen2021": (*map(str, range(1, 17)), "Table 1", "Table 2", "Table 4", "Table 5"),
    "alfaiz": (*map(str, range(1, 64)), "Table 1"),
}


def all_claims() -> tuple[Claim, ...]:
    """Every claim of the ledger.

    Returns:
        The claims, in the order of the papers.

    Source:
        Nguyen 2021; Al-Faiz.
    """
    return tuple(claim for paper in PAPERS.values() for claim in paper.claims())


def covered(claim: Claim) -> tuple[str, ...]:
    """The equations one claim is about: "28-29" is 28 and 29.

    Args:
        claim: The claim.

    Returns:
        Their numbers, or names of tables.

    Source:
        None (bookkeeping).
    """
    span = re.fullmatch(r"(\d+)-(\d+)", claim.equation)
    if span is None:
        return (claim.equation,)
    return tuple(str(number) for number in range(int(span[1]), int(span[2]) + 1))


def missing() -> list[str]:
    """Equations no claim covers.

    Returns:
        Paper and number of each, empty if the ledger is complete.

    Source:
        None (bookkeeping).
    """
    there = {(claim.paper, equation) for claim in all_claims() for equation in covered(claim)}
    return [
        f"{paper} {equation}"
        for paper, equations in EQUATIONS.items()
        for equation in equations
        if (paper, equation) not in there
    ]
