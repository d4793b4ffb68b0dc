"""Random smooth joint motions through a wanted posture at a wanted moment, and their time stamps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

HARMONICS = 4
# A joint this near to a limit, as a share of its swing, turns round there instead of passing.
_TURNS_ROUND = 0.25


@dataclass(frozen=True, eq=False)
class Clock:
    """Time stamps, shape (n,) in [s], and how far the motion has come by then: phase, shape (n,), 0 to 1.

    `moment` is the phase of the wanted posture, `at` the sample at or just before it.
    """

    time: np.ndarray
    phase: np.ndarray
    moment: float
    at: int

    @property
    def exact(self) -> bool:
        """Whether the moment is a sample, not between two."""
        return bool(self.phase[self.at] == self.moment)


def random_clock(
    rng: np.random.Generator,
    *,
    exact: bool = True,
    slow: bool = False,
    long: bool = False,
    rests: bool = False,
) -> Clock:
    """60-120 samples, sometimes up to 300, in 1-6 s at 50-200 Hz; a third of them unevenly spaced.

    `slow`: 2 s at least. `long`: 4 s at least, at 50 Hz. `rests`: the motion stops on its way once or twice
    and stands still at the end.
    """
    n = int(rng.integers(60, 121)) if rng.random() < 0.85 else int(rng.integers(150, 301))
    n = int(rng.integers(200, 301)) if long else max(n, 101) if slow else n
    duration = n / 50 if long else rng.uniform(max(2.0 if slow else 1.0, n / 200), min(6.0, n / 50))
    time = _time_stamps(rng, n, duration)
    phase = _with_rests(rng, time / duration) if rests else time / duration
    at = int(rng.integers(int(0.3 * n), int(0.7 * n)))
    moment = phase[at] if exact else 0.5 * (phase[at] + phase[at + 1])
    return Clock(time, phase, float(moment), at)


def _time_stamps(rng: np.random.Generator, n: int, duration: float) -> np.ndarray:
    steps, kind = np.ones(n - 1), rng.random()
    if kind < 0.2:  # a clock that jitters
        steps = rng.uniform(0.4, 1.6, n - 1)
    elif kind < 0.35:  # samples lost
        steps[rng.integers(0, n - 1, 3)] = 3.0
    return np.concatenate([[0.0], np.cumsum(steps)]) * duration / steps.sum()


def _with_rests(rng: np.random.Generator, share: np.ndarray) -> np.ndarray:
    """Minimum-jerk moves (10x³ - 15x⁴ + 6x⁵) with rests between; share and result run from 0 to 1."""
    moves = int(rng.integers(2, 4))
    lasts = rng.uniform(0.6, 1.0, 2 * moves)  # move, rest, move, rest, …
    lasts[1::2] *= 0.6
    edges = np.concatenate([[0.0], np.cumsum(lasts) / lasts.sum()])
    stops = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.0, moves))])
    stops /= stops[-1]
    phase = np.zeros_like(share)
    for i in range(moves):
        x = np.clip((share - edges[2 * i]) / (edges[2 * i + 1] - edges[2 * i]), 0, 1)
        phase += (stops[i + 1] - stops[i]) * x**3 * (10 + x * (6 * x - 15))
    return phase


@dataclass(frozen=True, eq=False)
class Waves:
    """One sum of sine waves of the phase per joint: sizes, phases and turns per unit of phase, (dof, h)."""

    size: np.ndarray
    shift: np.ndarray
    turns: np.ndarray

    def __call__(self, phase: np.ndarray) -> np.ndarray:
        return (self.size * np.sin(2 * np.pi * self.turns * phase[:, None, None] + self.shift)).sum(axis=2)

    def slope(self, phase: np.ndarray) -> np.ndarray:
        """Derivative with respect to the phase."""
        inner = 2 * np.pi * self.turns * phase[:, None, None] + self.shift
        return (2 * np.pi * self.turns * self.size * np.cos(inner)).sum(axis=2)


def random_waves(
    rng: np.random.Generator, dof: int, moment: float, crossing: tuple[int, ...], loops: int = 0
) -> Waves:
    """Waves that move on at the moment in the `crossing` joints, at half their top speed at least.

    Their turns are half-integers, or multiples of `loops` for a motion that repeats itself so often.
    """
    order = np.arange(1, HARMONICS + 1)
    turns = np.tile(loops * order if loops else 0.5 * order, (dof, 1)).astype(float)
    size, shift = (
        rng.normal(size=(dof, HARMONICS)) / order ** (3 if loops else 1.5),
        rng.uniform(0, 2 * np.pi, (dof, HARMONICS)),
    )
    everywhere = np.linspace(0, 1, 200)
    while True:
        waves = Waves(size, shift, turns)
        top, now = np.abs(waves.slope(everywhere)).max(axis=0), np.abs(waves.slope(np.array([moment])))[0]
        slow = [j for j in crossing if now[j] < 0.5 * top[j]]
        if not slow:
            return waves
        shift[slow] = rng.uniform(0, 2 * np.pi, (len(slow), HARMONICS))


def motion_through(
    clock: Clock,
    waves: Waves,
    posture: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    *,
    swing: np.ndarray,
    top_speed: float,
    turning: dict[int, int],
    crossing: tuple[int, ...],
) -> np.ndarray:
    """Joint angles with q(moment) = posture, inside lower … upper and not faster than `top_speed` [rad/s].

    Joints in `turning` turn round at the posture and stay above (1) or below (-1) it; so does any other
    joint that is very near to a limit, unless it is one of the `crossing` ones.
    """
    wave = waves(clock.phase) - waves(np.array([clock.moment]))
    q = np.empty_like(wave)
    for j in range(wave.shape[1]):
        shape = wave[:, j] / np.abs(wave[:, j]).max()
        room = posture[j] - lower[j], upper[j] - posture[j]
        side = turning.get(j, 0)
        if not side and j not in crossing and min(room) < _TURNS_ROUND * swing[j]:
            side = 1 if room[0] < room[1] else -1
        if side:
            shape = side * shape**2
        size = min(
            swing[j],
            room[0] / -shape.min() if shape.min() < 0 else np.inf,
            room[1] / shape.max() if shape.max() > 0 else np.inf,
            top_speed / np.abs(np.diff(shape) / np.diff(clock.time)).max(),
        )
        q[:, j] = posture[j] + size * shape
    return np.clip(q, lower, upper)  # rounding only: the size keeps it inside
