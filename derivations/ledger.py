"""All claims, in the order of the papers."""

from __future__ import annotations

from derivations.claim import Claim
from derivations.nguyen2021 import elbow_direction, forward_kinematics


def all_claims() -> tuple[Claim, ...]:
    """Every claim of the ledger.

    Returns:
        The claims, in the order of the papers.

    Source:
        Nguyen 2021.
    """
    return (*forward_kinematics.CLAIMS, *elbow_direction.CLAIMS)
