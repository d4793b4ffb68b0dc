"""What a user can choose about the method of Al-Faiz."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from armik_sym.errors import OptionError
from armik_sym.pointwise.judging import Judging, positive_number, whole_number

# Room for swivel angles in the C loop.
MOST = 256


@dataclass(frozen=True, kw_only=True)
class AlfaizOptions(Judging):
    """Choices for `solve(..., method="alfaiz")`.

    Every posture looked at reaches the pose exactly; the one free number and the branches are chosen for the
    range of motion. Defaults by experiment, see `benchmarks/alfaiz.py`.

    Following is greedy: each sample takes the posture nearest to the one before and never looks ahead. In a
    tight range of motion this can run into a dead end, from which only a jump leads on, although a smooth
    motion exists. `reached` says nothing about that; the largest step between samples does.

    Attributes:
        search: "corrected", or "printed" for the equations and the objective (57) as printed, which
            lose quadrants, miss many poses and know no range of motion.
        prefer: What decides among the postures inside the range of motion: "nearest" to the posture before
            (where none is known, "margin"), or "margin", farthest from all limits, each pose by itself.
        grid: Swivel angles looked at over the full turn, besides one for every stretch between joint limits.
        refinements: Times the surroundings of the best one are looked at more closely, eight times each.
        near: A posture is taken without looking round if no joint moved farther than this from the posture
            before, in [rad].
        tolerance: A sample counts as reached if position error, in [m], and rotation error, in [rad], are
            at most this.

    Raises:
        OptionError: If a value makes no sense.

    Source:
        Al-Faiz, §3.2.
    """

    search: Literal["corrected", "printed"] = "corrected"
    prefer: Literal["nearest", "margin"] = "nearest"
    grid: int = 32
    refinements: int = 2
    near: float = 0.05
    tolerance: float = 1e-9

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.search not in ("corrected", "printed"):
            raise OptionError(f"search is {self.search!r}: valid are corrected, printed")
        if self.prefer not in ("nearest", "margin"):
            raise OptionError(f"prefer is {self.prefer!r}: valid are nearest, margin")
        whole_number("grid", self.grid, 4)
        if self.grid > MOST:
            raise OptionError(f"grid is {self.grid!r}, expected at most {MOST}")
        whole_number("refinements", self.refinements, 0)
        if self.refinements > MOST:
            raise OptionError(f"refinements is {self.refinements!r}, expected at most {MOST}")
        positive_number("near", self.near)
        positive_number("tolerance", self.tolerance)
