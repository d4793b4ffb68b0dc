"""Small sampled linear systems: frequency response and poles."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Sampled(NamedTuple):
    """A sampled linear system with one input and one output: x⁺ = A x + b u, y = c x + d u.

    Attributes:
        A: Shape (m, m).
        b: Shape (m,).
        c: Shape (m,).
        d: Direct part.
        step: Sampling time, in [s].
    """

    A: Array
    b: Array
    c: Array
    d: float
    step: float

    def response(self, omega: Array) -> Complex:
        """Frequency response c (z - A)⁻¹ b + d at z = e^{jωT}.

        Args:
            omega: Frequencies, shape (k,), in [rad/s].

        Returns:
            Shape (k,).

        Source:
            Åström & Wittenmark, Computer-Controlled Systems (1997), §2.
        """
        z = np.exp(1j * omega * self.step)
        matrices = z[:, None, None] * np.eye(len(self.A)) - self.A
        states = np.linalg.solve(matrices, np.broadcast_to(self.b, (len(z), len(self.b)))[:, :, None])
        return np.asarray(states[:, :, 0] @ self.c + self.d)

    def to_control(self) -> Any:
        """The same system as `control.StateSpace` of python-control, for its plots and designs.

        Returns:
            A `control.StateSpace` with this sampling time.

        Source:
            python-control.
        """
        import control

        return control.ss(self.A, self.b[:, None], self.c[None, :], [[self.d]], self.step)


def in_series(first: Sampled, second: Sampled) -> Sampled:
    """Two systems, the output of the first being the input of the second.

    Args:
        first: The first.
        second: The second.

    Returns:
        The whole.

    Source:
        None (block diagram algebra).
    """
    n, m = len(first.A), len(second.A)
    A = np.zeros((n + m, n + m))
    A[:n, :n], A[n:, n:], A[n:, :n] = first.A, second.A, np.outer(second.b, first.c)
    b = np.concatenate([first.b, second.b * first.d])
    c = np.concatenate([second.d * first.c, second.c])
    return Sampled(A, b, c, first.d * second.d, first.step)


def closed_poles(loop: Sampled) -> Complex:
    """Poles of a loop closed by negative unit feedback.

    Args:
        loop: The open loop.

    Returns:
        Poles in the z plane; all inside the unit circle if the loop is stable.

    Source:
        Åström & Wittenmark 1997, §3.
    """
    return np.asarray(np.linalg.eigvals(loop.A - np.outer(loop.b, loop.c) / (1.0 + loop.d)))
