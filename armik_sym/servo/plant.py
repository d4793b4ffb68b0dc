"""The joint that a controller sees: current loop, inertia, viscous friction, delay; discretised exactly."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from armik_sym.servo.linear import Sampled

Array = NDArray[np.float64]

_ROUNDING = 1e-9


@dataclass(frozen=True)
class JointPlant:
    """A joint from commanded torque to angle: J q̈ + B q̇ = τ - d, T τ̇ = u(t - delay) - τ.

    Attributes:
        inertia: J, of drive and load, in [kg m²].
        viscous: B, in [Nm s/rad].
        lag: T, of the current loop, in [s].
        delay: In [s].
        step: Sampling time, in [s]; the command is held in between.

    Source:
        Åström & Wittenmark, Computer-Controlled Systems (1997), §2.3 (sampling with a delay).
    """

    inertia: float
    viscous: float
    lag: float
    delay: float
    step: float

    @property
    def continuous(self) -> tuple[Array, Array, Array]:
        """A, b of the command, b of the load, for states q, q̇, τ."""
        J, B, T = self.inertia, self.viscous, self.lag
        A = np.array([[0.0, 1.0, 0.0], [0.0, -B / J, 1.0 / J], [0.0, 0.0, -1.0 / T]])
        return A, np.array([0.0, 0.0, 1.0 / T]), np.array([0.0, -1.0 / J, 0.0])

    @property
    def whole_delay(self) -> int:
        """Whole samples of the delay."""
        return math.floor(self.delay / self.step + _ROUNDING)

    def matrices(self) -> tuple[Array, Array, Array, Array]:
        """One sample, exactly: x⁺ = Φ x + Γ₀ u_{k-m} + Γ₁ u_{k-m-1} + Γ_d d_k, m whole samples of delay.

        Returns:
            Φ, shape (3, 3); Γ₀, Γ₁ and Γ_d, shape (3,).

        Source:
            Åström & Wittenmark 1997, eq. 2.12-2.13.
        """
        return self._matrices

    @cached_property
    def _matrices(self) -> tuple[Array, Array, Array, Array]:
        # Every pass of a simulation asks for them, and matrix exponentials are slow.
        part = max(self.delay - self.whole_delay * self.step, 0.0)
        phi, _, per_load = self._held(self.step)
        rest, late, _ = self._held(self.step - part)
        _, early, _ = self._held(part)
        return phi, late, rest @ early, per_load

    def _held(self, time: float) -> tuple[Array, Array, Array]:
        """e^{At}, ∫₀ᵗ e^{As} ds b and the same for the load, from one matrix exponential."""
        A, b, load = self.continuous
        whole = np.zeros((5, 5))
        whole[:3, :3], whole[:3, 3], whole[:3, 4] = A, b, load
        found = expm(whole * time)
        return found[:3, :3], found[:3, 3], found[:3, 4]

    def sampled(self) -> Sampled:
        """From command to angle, with the delayed commands as further states.

        Returns:
            The system.

        Source:
            Åström & Wittenmark 1997, §2.3.
        """
        phi, late, early, _ = self.matrices()
        m = self.whole_delay + 1
        A = np.zeros((3 + m, 3 + m))
        b = np.zeros(3 + m)
        A[:3, :3] = phi
        # States 3 … 3 + m - 1 hold u_{k-1} … u_{k-m}; Γ₁ acts on the oldest, Γ₀ on the one before it.
        A[:3, 2 + m] = early
        if m == 1:
            b[:3] = late
        else:
            A[:3, 1 + m] = late
        b[3] = 1.0
        for i in range(1, m):
            A[3 + i, 2 + i] = 1.0
        c = np.zeros(3 + m)
        c[0] = 1.0
        return Sampled(A, b, c, 0.0, self.step)
