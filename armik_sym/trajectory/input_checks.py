"""Refusing tasks that contradict themselves, before any solver starts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm
from armik_sym.errors import LimitError, OptionError
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution.motion_rates import joint_acceleration, joint_speed
from armik_sym.symbolic import Orientation

Array = NDArray[np.float64]


def check_enough_joints(arm: Arm, orientation: Orientation) -> None:
    """Refuse exact tracking with more equations per sample than joints: m ≤ dof.

    Args:
        arm: The arm.
        orientation: What of the path is tracked.

    Raises:
        OptionError: If there are fewer joints than equations.

    Source:
        None (degrees of freedom).
    """
    if arm.dof >= orientation.equations:
        return
    fits = [mode.value for mode in Orientation if mode.equations <= arm.dof]
    lower = f" orientation={' or '.join(repr(mode) for mode in fits)}, or" if fits else ""
    raise OptionError(
        f"orientation {orientation.value!r} asks {orientation.equations} equations of every sample, but arm "
        f'{arm.name!r} has {arm.dof} joints: use{lower} tracking="soft"'
    )


def raise_too_fast(arm: Arm, path: HandPath, q: Array, max_speed: Array, max_acceleration: Array) -> None:
    """Raise the error for a path that can be followed, but not within the rate limits.

    Args:
        arm: The arm.
        path: The hand path.
        q: Angles that follow the path without the limits, shape (n, dof), in [rad].
        max_speed: Speed limits, shape (dof,), in [rad/s].
        max_acceleration: Acceleration limits, shape (dof,), in [rad/s²].

    Raises:
        LimitError: Always; names joint, sample and rate.

    Source:
        None (reporting).
    """
    speed = np.abs(joint_speed(path.time, q))
    acceleration = np.abs(joint_acceleration(path.time, q))
    name, rates, limits, per = "max_speed", speed, max_speed, "/s"
    if not np.any(speed > max_speed):
        name, rates, limits, per = "max_acceleration", acceleration, max_acceleration, "/s²"
    k, i = (int(index) for index in np.unravel_index(int(np.argmax(rates / limits)), rates.shape))
    unit = joint_unit(arm, i)
    raise LimitError(
        f"the path can be followed, but no motion within {name} was found: without the limit the best one "
        f"moves {arm.joint_names[i]} at {unit.text(rates[k, i], 4, per)} after sample {k} (allowed "
        f'{unit.text(limits[i], 4, per)}). Raise {name}, slow the path down, or use tracking="soft".'
    )


def check_hand_speed(arm: Arm, path: HandPath, max_speed: Array) -> None:
    """Refuse a path whose hand outruns any motion the speed limits allow.

    |v_hand| ≤ Σ_revolute reach·v_i + Σ_prismatic v_i; the straight line between two samples is no
    longer than any way the hand could take.

    Args:
        arm: The arm.
        path: The hand path.
        max_speed: Speed limits, shape (dof,), in [rad/s].

    Raises:
        LimitError: If the hand is faster between two samples.

    Source:
        None (bound of the Jacobian by the reach).
    """
    fastest = float(np.where(arm.rotates, arm.reach, 1.0) @ max_speed)
    speed = np.linalg.norm(np.diff(path.position, axis=0), axis=1) / np.diff(path.time)
    k = int(np.argmax(speed))
    if speed[k] > fastest:
        raise LimitError(
            f"between samples {k} and {k + 1} the hand moves at {speed[k]:.4g} m/s, but with max_speed the "
            f"hand of arm {arm.name!r} cannot exceed {fastest:.4g} m/s: raise max_speed or slow the path down"
        )
