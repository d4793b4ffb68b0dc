"""How far a loop is from instability: gain, phase and delay margin, peak of the sensitivity."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from armik_sym.servo.linear import Sampled, closed_poles

Array = NDArray[np.float64]

_POINTS = 1500
_LOWEST = 1e-2


@dataclass(frozen=True)
class LoopMargins:
    """Margins of a loop.

    Attributes:
        stable: Whether the closed loop is stable; the rest means nothing if not.
        gain: The gain may grow by this factor; infinite if any.
        gain_down: The gain may fall to this part, 0 if to nothing.
        phase: The phase may fall by this much at the crossover that has the least left, in [rad].
        crossover: The last frequency at which the gain is 1, in [rad/s]; NaN if never.
        delay: The loop may be later by this much, in [s].
        sensitivity: Largest amplification of disturbances: max |1/(1 + L)|.
        bandwidth: Where the closed loop L/(1 + L) has fallen by 3 dB, in [rad/s]; NaN if it does not.

    Source:
        Åström & Murray, Feedback Systems (2008), §9.3 and §11.1.
    """

    stable: bool
    gain: float
    gain_down: float
    phase: float
    crossover: float
    delay: float
    sensitivity: float
    bandwidth: float


def loop_margins(loop: Sampled) -> LoopMargins:
    """Margins of a sampled loop, by bisection on its exact frequency response.

    python-control finds the same; its polynomial method, though, warns of lost digits for a loop with slow
    integral action at 1 kHz, so the response is used here, and its `stability_margins` in the tests.

    Args:
        loop: The open loop, cut where the margins are wanted.

    Returns:
        The margins.

    Source:
        Åström & Murray 2008, §9.3.
    """
    top = math.pi / loop.step
    omega = np.geomspace(_LOWEST, top * (1 - 1e-9), _POINTS)
    L = loop.response(omega)
    crossings = _zeros(omega, np.abs(L) - 1.0, lambda w: abs(_at(loop, w)) - 1.0)
    real_axis = [w for w in _zeros(omega, L.imag, lambda w: _at(loop, w).imag) if _at(loop, w).real < 0]
    at_axis = [-_at(loop, w).real for w in real_axis] + ([-L[-1].real] if L[-1].real < 0 else [])
    phases = [(math.pi + float(np.angle(_at(loop, w)))) % (2 * math.pi) for w in crossings]
    delays = [phase / w for phase, w in zip(phases, crossings, strict=True)]
    signed = [p - 2 * math.pi if p > math.pi else p for p in phases]
    closed = np.abs(L / (1 + L)) - math.sqrt(0.5)
    fallen = _zeros(omega, closed, lambda w: abs(_at(loop, w) / (1 + _at(loop, w))) - math.sqrt(0.5))
    return LoopMargins(
        stable=bool(np.all(np.abs(closed_poles(loop)) < 1.0)),
        gain=min((1 / g for g in at_axis if g < 1.0), default=math.inf),
        gain_down=max((1 / g for g in at_axis if g > 1.0), default=0.0),
        phase=min(signed, key=abs, default=math.inf),
        crossover=crossings[-1] if crossings else math.nan,
        delay=min(delays, default=math.inf),
        sensitivity=_peak(loop, omega, L),
        bandwidth=fallen[-1] if fallen else math.nan,
    )


def _at(loop: Sampled, omega: float) -> complex:
    return complex(loop.response(np.array([omega]))[0])


def _zeros(omega: Array, values: Array, function: Callable[[float], float]) -> list[float]:
    change = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
    return [float(brentq(function, omega[i], omega[i + 1], xtol=1e-10)) for i in change]


def _peak(loop: Sampled, omega: Array, L: NDArray[np.complex128]) -> float:
    size = np.abs(1 + L)
    i = int(np.argmin(size))
    low, high = omega[max(i - 1, 0)], omega[min(i + 1, len(omega) - 1)]
    found = minimize_scalar(lambda w: abs(1 + _at(loop, w)), bounds=(low, high), method="bounded")
    return float(1.0 / min(found.fun, size[i]))
