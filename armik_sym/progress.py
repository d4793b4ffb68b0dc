"""What long computations tell a caller while they run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """One report of a running computation.

    Attributes:
        stage: What is being done, in a few words.
        iteration: How many iterations of that stage are done.
        violation: Largest violation of the constraints now, in [m] or [rad]; 0 if not known.
    """

    stage: str
    iteration: int = 0
    violation: float = 0.0


ProgressCallback = Callable[[Progress], None]
