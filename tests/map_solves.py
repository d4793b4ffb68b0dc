"""Solves over the swivel map that several tests look at, and what they promise."""

from __future__ import annotations

import pytest
from exact_solves import check
from sample_arms import ARMS

import armik_sym as ak
from armik_sym.motion.hand_path import HandPath

EHMCS = ARMS["ehmcs"]
MAP_STAGES = ["swivel map", "global path", "one curve"]


def thin(path, every=4):
    return HandPath(path.time[::every], path.position[::every], path.rotation[::every])


DRINKING = thin(ak.load_task("drinking_lift").path)


def stages_of(arm, path, **options):
    """What the solve went through, and the solution."""
    seen = []
    solution = ak.solve(arm, path, progress=lambda report: seen.append(report.stage), **options)
    return list(dict.fromkeys(seen)), solution


def over_the_map(arm, path, **options):
    """A solution that came from the swivel map alone."""
    stages, solution = stages_of(arm, path, **options)
    assert set(stages) <= set(MAP_STAGES), stages
    return check(solution)


def same_cost(arm, path, **options):
    """Both methods at the same optimum, whatever the task."""
    mine = over_the_map(arm, path, **options)
    other = check(ak.solve(arm, path, search="full-space", **options))
    assert mine.cost == pytest.approx(other.cost, rel=1e-6)
    return mine, other
