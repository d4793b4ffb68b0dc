"""Random smooth joint motions inside the range of motion, and the hand paths they make."""

from __future__ import annotations

import numpy as np

from armik_sym.arm import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.motion.hand_path import HandPath


def smooth_angles(arm: Arm, n: int, seed: int, width: float = 0.8, most: float = 1.0) -> np.ndarray:
    """Four sine waves per joint, inside the given share of its range, swinging `most` rad at most."""
    rng = np.random.default_rng(seed)
    s = np.linspace(0, 1, n)
    q = np.empty((n, arm.dof))
    for j in range(arm.dof):
        size, phase = rng.normal(size=4) / np.arange(1, 5), rng.uniform(0, 2 * np.pi, 4)
        wave = sum(size[i] * np.sin(np.pi * (i + 1) * s + phase[i]) for i in range(4))
        wave = 2 * (wave - wave.min()) / max(np.ptp(wave), 1e-9) - 1
        half = 0.5 * width * arm.rom.width[j]
        swing = min(half, most)
        q[:, j] = arm.rom.middle[j] + rng.uniform(-1, 1) * (half - swing) + swing * wave
    return q


def path_of(arm: Arm, q: np.ndarray, time: np.ndarray | None = None, *, turned: bool = True) -> HandPath:
    """The path of the hand while the joints move through `q`; 4 s unless times are given."""
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    time = np.linspace(0.0, 4.0, len(q)) if time is None else time
    return HandPath(time, position, rotation if turned else None)


def smooth_path(arm: Arm, n: int, seed: int, **kind: float) -> tuple[HandPath, np.ndarray]:
    """A path and the angles that made it."""
    q = smooth_angles(arm, n, seed, **kind)
    return path_of(arm, q), q


def uneven_time(n: int, seed: int, duration: float = 4.0) -> np.ndarray:
    """Increasing time stamps whose steps differ up to a factor of five."""
    steps = np.random.default_rng(seed).uniform(0.2, 1.0, n - 1)
    return np.concatenate([[0.0], np.cumsum(steps)]) * duration / steps.sum()


def objective(time: np.ndarray, q: np.ndarray, middle: np.ndarray, weights: tuple[float, ...]) -> float:
    """½∫ w_v|q̇|² + w_a|q̈|² + w_p|q - middle|² dt, summed sample by sample in the plainest way."""
    total, n = 0.0, len(time)
    for k in range(n - 1):
        h = time[k + 1] - time[k]
        total += weights[0] * h * np.sum(((q[k + 1] - q[k]) / h) ** 2)
        total += weights[2] * h * np.sum((q[k] - middle) ** 2 + (q[k + 1] - middle) ** 2) / 2
    for k in range(1, n - 1):
        h0, h1 = time[k] - time[k - 1], time[k + 1] - time[k]
        a = ((q[k + 1] - q[k]) / h1 - (q[k] - q[k - 1]) / h0) / (0.5 * (h0 + h1))
        total += weights[1] * 0.5 * (h0 + h1) * np.sum(a**2)
    return 0.5 * total
