"""Which of the motions whole turns apart is meant: against trying them all."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm import RangeOfMotion
from armik_sym.trajectory.whole_turns import in_best_turn

TURN = 2 * np.pi
WIDE = np.array([True, False])


@given(
    middle=st.floats(-20, 20),
    swing=st.floats(0, 9),
    width=st.floats(TURN, 30),
    aim=st.floats(-20, 20),
    seed=st.integers(0, 9),
)
def test_the_best_turn_of_all(middle, swing, width, aim, seed):
    rng = np.random.default_rng(seed)
    q = middle + swing * rng.uniform(-1, 1, (6, 2))
    share = rng.uniform(0.1, 1, 6)
    rom = RangeOfMotion(np.array([-0.4 * width, -1.0]), np.array([0.6 * width, 1.0]))
    wish = np.array([aim, 0.0])
    found = in_best_turn(q, WIDE, rom, wish, share)
    assert np.array_equal(found[:, 1], q[:, 1])
    turns = (found[:, 0] - q[:, 0]) / TURN
    assert np.abs(turns - np.rint(turns[0])).max() < 1e-9

    def beyond(k):
        return max(0.0, -rom.margin(q + TURN * np.array([k, 0]))[:, 0].min())

    def cost(k):
        return share @ (q[:, 0] + TURN * k - aim) ** 2

    tried = np.arange(-12, 13)
    inside = [k for k in tried if beyond(k) == 0]
    k = int(np.rint(turns[0]))
    if inside:
        assert beyond(k) < 1e-9
        assert cost(k) <= min(cost(other) for other in inside) * (1 + 1e-9) + 1e-9
    else:
        assert beyond(k) <= min(beyond(other) for other in tried) + 1e-9
