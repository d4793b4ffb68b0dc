"""A swivel map in a few lines of text, and why samples have no posture."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.limit_words import limit_words
from armik_sym.swivel.constants import REACH
from armik_sym.swivel.postures_at import postures_at

if TYPE_CHECKING:
    from armik_sym.swivel.map_class import SwivelMap

Indices = NDArray[np.int64]

# At most this many blocked samples are looked at one by one; of more, evenly spaced ones.
_LOOKED_AT = 1000
_LINES = 8


def reasons(map_: SwivelMap, samples: Indices, branch: int | None = None) -> list[tuple[str, float]]:
    """The limit that blocks each of some samples, in words, and what is missing.

    Args:
        map_: The map.
        samples: Indices of samples, shape (k,).
        branch: Only this branch; the best one if left out.

    Returns:
        For each sample the words, such as "wrist flexion limit (73°)" or "out of reach", and by how much it
        is missed, in [deg], or in [mm] for "out of reach".

    Source:
        None (reporting).
    """
    why = map_.why_blocked(samples, branch)
    rom = map_.arm.rom
    q = postures_at(map_.intervals.curves, why.sample, why.branch, why.psi, backend=map_.backend).q
    found = []
    for row, joint, missing, shortfall in zip(q, why.joint, why.missing, why.shortfall, strict=True):
        if shortfall > REACH:
            found.append(("out of reach", 1000 * float(shortfall)))
        else:
            upper = bool(row[joint] - rom.upper[joint] > rom.lower[joint] - row[joint])
            found.append((limit_words(map_.arm, int(joint), upper), float(np.rad2deg(missing))))
    return found


def missing_words(words: str, missing: float) -> str:
    """A reason with its amount: "wrist flexion limit (73°) missed by 3.2°".

    Args:
        words: As of `reasons`.
        missing: By how much, in [deg] or [mm].

    Returns:
        The text.

    Source:
        None (reporting).
    """
    return f"{words} by {missing:.3g} mm" if words == "out of reach" else f"{words} missed by {missing:.3g}°"


def runs(samples: Indices) -> Iterator[Indices]:
    """Consecutive samples together.

    Args:
        samples: Indices, increasing, shape (k,).

    Yields:
        Runs of indices without a gap.

    Source:
        None (bookkeeping).
    """
    if len(samples):
        yield from np.split(samples, np.flatnonzero(np.diff(samples) > 1) + 1)


def blocked_lines(map_: SwivelMap) -> Iterator[str]:
    """One line per run of blocked samples with the same reason.

    Args:
        map_: The map.

    Yields:
        Lines.

    Source:
        None (reporting).
    """
    blocked = map_.blocked
    every = max(1, -(-len(blocked) // _LOOKED_AT))
    looked_at = blocked[::every]
    why = reasons(map_, looked_at)
    for run in runs(blocked):
        mine = np.flatnonzero((looked_at >= run[0]) & (looked_at <= run[-1]))
        if not mine.size:  # a run shorter than the spacing
            mine, found = np.zeros(1, dtype=np.int64), reasons(map_, run[:1])
            yield _line(map_, run[:1], run, found[0])
            continue
        words = [why[i][0] for i in mine]
        changes = [0, *(i for i in range(1, len(mine)) if words[i] != words[i - 1]), len(mine)]
        for a, b in itertools.pairwise(changes):
            first = run[0] if a == 0 else looked_at[mine[a]]
            last = run[-1] if b == len(mine) else looked_at[mine[b]] - 1
            worst = max(mine[a:b], key=lambda i: why[i][1])
            yield _line(map_, looked_at[worst : worst + 1], np.arange(first, last + 1), why[worst])


def _line(map_: SwivelMap, worst: Indices, run: Indices, why: tuple[str, float]) -> str:
    time = map_.path.time
    if len(run) == 1:
        return f"sample {run[0]} ({time[run[0]]:.3g} s): {missing_words(*why)}"
    return (
        f"samples {run[0]} to {run[-1]} ({time[run[0]]:.3g} to {time[run[-1]]:.3g} s): {missing_words(*why)} "
        f"at the worst (sample {worst[0]})"
    )


def summary(map_: SwivelMap) -> str:
    """A short, honest summary for people.

    Args:
        map_: The map.

    Returns:
        Text of a few lines.

    Source:
        None (reporting).
    """
    n, empty = len(map_), map_.intervals.empty
    blocked = "every sample has a posture" if not len(map_.blocked) else f"{len(map_.blocked)} blocked"
    lines = [f"swivel map: arm {map_.arm.name}, {n} samples over {map_.path.duration:.3g} s, {blocked}"]
    for branch in (int(b) for b in np.flatnonzero(~empty.all(axis=0))):
        there = ~empty[:, branch]
        width = np.rad2deg(map_.width[there, branch])
        text = f"  branch {branch}  {map_.branch_names[branch]}: "
        text += f"{width.min():.3g}° to {width.max():.3g}° wide"
        if not there.all():
            sample = int(np.argmin(there))
            (why,) = reasons(map_, np.array([sample]), branch)
            text += f" at {there.sum()} samples; none at sample {sample} ({missing_words(*why)})"
        lines.append(text)
    told = list(blocked_lines(map_))
    lines += [f"  blocked   {line}" for line in told[:_LINES]]
    if len(told) > _LINES:
        lines.append(f"  blocked   and {len(told) - _LINES} more stretches")
    return "\n".join(lines)
