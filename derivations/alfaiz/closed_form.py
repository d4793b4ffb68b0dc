"""The corrected inverse solution of Al-Faiz with all its branches, in numbers."""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import casadi as ca
import numpy as np

from armik_sym.arm.catalog import alfaiz
from armik_sym.symbolic import express

_MARGIN = 1e-9
_SAME = 1e-4


@dataclass(frozen=True)
class Lengths:
    """Segment lengths, in [m].

    Attributes:
        l4: Upper arm.
        l3: Forearm.
    """

    l4: float = 0.30
    l3: float = 0.24


@functools.cache
def _functions() -> tuple[ca.Function, ca.Function]:
    e = express(alfaiz())
    inputs = [e.q, e.lengths]
    return (
        ca.Function("pose", inputs, [ca.densify(e.T_base_hand)]),
        ca.Function("elbow", inputs, [ca.densify(e.frames[4])]),
    )


def pose(q: np.ndarray, lengths: Lengths) -> np.ndarray:
    """Pose of the hand frame of the chain, through CasADi.

    Args:
        q: Joint angles, shape (7,), in [rad].
        lengths: Segment lengths.

    Returns:
        Homogeneous transform, shape (4, 4).

    Source:
        Al-Faiz, eq. 3, through `armik_sym.symbolic`.
    """
    return np.asarray(_functions()[0](q, [lengths.l4, lengths.l3]))


def elbow_frame(q: np.ndarray, lengths: Lengths) -> np.ndarray:
    """Frame 4 of the chain, its origin the elbow, through CasADi.

    Args:
        q: Joint angles, shape (7,), in [rad].
        lengths: Segment lengths.

    Returns:
        Homogeneous transform, shape (4, 4).

    Source:
        Al-Faiz, eq. 3, through `armik_sym.symbolic`.
    """
    return np.asarray(_functions()[1](q, [lengths.l4, lengths.l3]))


def phi_of(q: np.ndarray, lengths: Lengths) -> float:
    """φ of a posture, r being a distance.

    Args:
        q: Joint angles, shape (7,), in [rad].
        lengths: Segment lengths.

    Returns:
        φ in [rad].

    Source:
        Al-Faiz, eq. 17-18.
    """
    p = pose(q, lengths)[:3, 3]
    return float(np.arctan2(-p[0], p[2]) - q[0])


def sine_of_theta3(position: np.ndarray, phi: float, lengths: Lengths) -> float:
    """The argument of the arc sine in eq. (22); a solution exists if it lies within ±1.

    Args:
        position: Wrist, shape (3,), in [m].
        phi: In [rad].
        lengths: Segment lengths.

    Returns:
        The sine, NaN if the wrist is out of reach.

    Source:
        Al-Faiz, eq. 6, 21 and 22, corrected.
    """
    cosine = (position @ position - lengths.l4**2 - lengths.l3**2) / (2 * lengths.l4 * lengths.l3)
    if abs(cosine) > 1 + _MARGIN:
        return float("nan")
    return float(np.hypot(position[0], position[2]) * np.cos(phi) / (lengths.l3 * cosine + lengths.l4))


def solutions(T: np.ndarray, phi: float, lengths: Lengths) -> np.ndarray:
    """All postures with a given pose of the hand and a given φ, by eq. (4)-(47) with every branch.

    Args:
        T: Pose of the hand, shape (4, 4).
        phi: In [rad].
        lengths: Segment lengths.

    Returns:
        Different postures, shape (n, 7), in [rad].

    Source:
        Al-Faiz, eq. 4-47, corrected.
    """
    p = T[:3, 3]
    sine = sine_of_theta3(p, phi, lengths)
    if not abs(sine) <= 1 + _MARGIN:
        return np.empty((0, 7))
    elbow = np.arccos(np.clip((p @ p - lengths.l4**2 - lengths.l3**2) / (2 * lengths.l4 * lengths.l3), -1, 1))
    third = np.arcsin(np.clip(sine, -1, 1))
    first = np.arctan2(-p[0], p[2]) - phi
    found = []
    for q4, q3, second_wrist in itertools.product((elbow, -elbow), (third, np.pi - third), (False, True)):
        k2 = np.hypot(p[0], p[2]) * np.sin(phi)
        k3, k4 = (lengths.l3 * np.cos(q4) + lengths.l4) * np.cos(q3), lengths.l3 * np.sin(q4)
        q2 = np.arctan2(k3 * k2 + k4 * p[1], k4 * k2 - k3 * p[1])
        q = np.array([first, q2, q3, q4, 0.0, 0.0, 0.0])
        q[4:] = _wrist(elbow_frame(q, lengths)[:3, :3].T @ T[:3, :3], other=second_wrist)
        found.append(q)
    return _different(found)


def _wrist(R: np.ndarray, *, other: bool) -> tuple[float, float, float]:
    q6 = np.arcsin(np.clip(R[1, 2], -1, 1))
    q5, q7 = np.arctan2(-R[2, 2], R[0, 2]), np.arctan2(R[1, 1], -R[1, 0])
    return (q5 + np.pi, np.pi - q6, q7 + np.pi) if other else (q5, q6, q7)


def _different(postures: list[np.ndarray]) -> np.ndarray:
    kept: list[np.ndarray] = []
    for q in postures:
        if all(np.abs(np.remainder(q - k + np.pi, 2 * np.pi) - np.pi).max() > _SAME for k in kept):
            kept.append(q)
    return np.array(kept)
