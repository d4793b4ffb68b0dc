"""Speed, acceleration and length of a sampled joint motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def joint_speed(time: Array, q: Array) -> Array:
    """Speed between samples: (q_{k+1} - q_k)/(t_{k+1} - t_k).

    Args:
        time: Time stamps, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Shape (n - 1, dof), in [rad/s].

    Source:
        None (forward differences).
    """
    return np.diff(q, axis=0) / np.diff(time)[:, None]


def joint_acceleration(time: Array, q: Array) -> Array:
    """Acceleration at inner samples: (v_k - v_{k-1})/½(t_{k+1} - t_{k-1}).

    Args:
        time: Time stamps, shape (n,), in [s].
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Shape (max(n - 2, 0), dof), in [rad/s²].

    Source:
        None (second divided differences).
    """
    return np.diff(joint_speed(time, q), axis=0) / (0.5 * (time[2:] - time[:-2]))[:, None]


def arc_length(q: Array) -> float:
    """Length of the way through joint space: Σ |q_{k+1} - q_k|.

    Args:
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Length, in [rad].

    Source:
        None (polygon length).
    """
    return float(np.linalg.norm(np.diff(q, axis=0), axis=1).sum())
