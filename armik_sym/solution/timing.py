"""Where the time of a solve went."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Timing:
    """Wall-clock times of one solve.

    Attributes:
        build: Building expressions and the problem, in [s].
        compile: Running the C compiler, in [s]; 0 if the cache had everything.
        solve: First guess and solver iterations, in [s].
    """

    build: float = 0.0
    compile: float = 0.0
    solve: float = 0.0

    @property
    def total(self) -> float:
        """All of it, in [s]."""
        return self.build + self.compile + self.solve
