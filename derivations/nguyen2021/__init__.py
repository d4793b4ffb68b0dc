"""Nguyen, Bui, Pham (2021): the exoskeleton E-HMCS, ISADE and Pro-ISADE.

Using proposed optimization algorithm for solving inverse kinematics of human upper limb applying in
rehabilitation robotic. Artificial Intelligence Review, doi:10.1007/s10462-021-10041-z.
"""

from __future__ import annotations

from derivations.claim import Claim


def claims() -> tuple[Claim, ...]:
    """The claims about this paper, in its order.

    Returns:
        The claims.

    Source:
        Nguyen 2021.
    """
    from derivations.nguyen2021 import (
        angle_conversion,
        cost,
        crossover,
        dh_table,
        elbow_direction,
        final_scaling_factor,
        forward_kinematics,
        mutation,
        range_of_motion,
        scaling_factor,
        settings,
    )

    modules = (
        range_of_motion,
        dh_table,
        forward_kinematics,
        elbow_direction,
        angle_conversion,
        mutation,
        scaling_factor,
        final_scaling_factor,
        crossover,
        cost,
        settings,
    )
    return tuple(claim for module in modules for claim in module.CLAIMS)
