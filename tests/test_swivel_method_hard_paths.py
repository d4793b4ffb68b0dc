"""The best through the map where steps are large, joints locked, or turning from limit to limit."""

from __future__ import annotations

import numpy as np
from spherical_arms import ARMS, poses

import armik_sym as ak
from armik_sym.arm import Arm
from armik_sym.trajectory.objective import objective
from armik_sym.trajectory.options import TrajectoryOptions

TURN = 2 * np.pi


def path_made_by(arm: Arm, time: np.ndarray, q: np.ndarray) -> ak.HandPath:
    return ak.HandPath(time, *poses(arm, q))


def cost_of(arm: Arm, time: np.ndarray, q: np.ndarray) -> float:
    return objective(arm, time, q, TrajectoryOptions())


def test_a_path_of_few_samples_with_large_steps_costs_no_more_than_its_own_motion() -> None:
    for seed in range(6):
        rng = np.random.default_rng(seed)
        arm = ARMS["odd_standard"]
        time = np.cumsum(rng.uniform(0.3, 0.7, 16))
        inner = 0.45 * arm.rom.width * rng.uniform(-1, 1, (16, 7)) * rng.choice([0.1, 0.6], (16, 1))
        q = arm.rom.middle + inner
        found = ak.solve(arm, path_made_by(arm, time, q))
        assert found.ok, found.reasons
        assert found.cost is not None
        assert found.cost <= cost_of(arm, time, q) * (1 + 1e-6)


def test_locked_joints_and_one_that_turns_from_limit_to_limit() -> None:
    """Only one trajectory: nothing but rounding decides whether it is inside its range."""
    arm, n = ARMS["alfaiz"], 60
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    lower[0] = upper[0] = 0.4
    lower[2], upper[2] = -1.3, -1.3 + 1.1 * TURN
    arm = arm.with_rom(lower, upper)
    time = np.linspace(0, 4, n)
    share = 0.5 - 0.3 * np.cos(1.5 * time)[:, None]
    q = arm.rom.lower + share * arm.rom.width
    q[:, 2] = np.linspace(lower[2], upper[2], n)
    found = ak.solve(arm, path_made_by(arm, time, q), search="swivel")
    assert found.ok, found.reasons
    assert found.cost is not None
    assert found.cost <= cost_of(arm, time, q) * (1 + 1e-6)
