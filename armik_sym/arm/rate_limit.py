"""Speed and acceleration limits of joints."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import LimitError


def rate_limit(name: str, value: float | ArrayLike | None, arm: Arm) -> NDArray[np.float64]:
    """A speed or acceleration limit as one number per joint: |rate| ≤ limit.

    Args:
        name: Name of the option, for messages.
        value: One number, one per joint, or None for no limit.
        arm: The arm.

    Returns:
        Limits, shape (dof,), in [rad/s] or [rad/s²]; infinite where there is none.

    Raises:
        LimitError: If a limit is not positive, or their number does not fit the arm.

    Source:
        None (bookkeeping).
    """
    try:
        limits = np.asarray(np.inf if value is None else value, dtype=np.float64)
    except (TypeError, ValueError):
        raise LimitError(f"{name} is {value!r}, expected one number or {arm.dof}, one per joint") from None
    if limits.ndim > 1 or (limits.ndim == 1 and limits.shape != (arm.dof,)):
        raise LimitError(f"{name} has shape {limits.shape}, expected one number or {arm.dof}, one per joint")
    limits = np.broadcast_to(limits, (arm.dof,)).copy()
    bad = np.flatnonzero(~(limits > 0))
    if bad.size:
        i = int(bad[0])
        raise LimitError(
            f"{name} of joint {arm.joint_names[i]!r} is {limits[i]:g}: -{name} ≤ rate ≤ {name} leaves no "
            "motion at all; give a positive number, or None for no limit"
        )
    return limits
