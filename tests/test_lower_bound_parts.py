"""The inequalities that the lower bound is made of, each against brute force."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lower_bound_instances import intervals_along, motion, objective, posture_at
from spherical_arms import ARMS

from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.swivel.intervals import feasible_intervals
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.trajectory.lower_bound.arcs import ANYWHERE, anywhere, arcs_of, near_pole
from armik_sym.trajectory.lower_bound.box_minimum import line_minimum, square_minimum
from armik_sym.trajectory.lower_bound.cells import Cells, cells_of
from armik_sym.trajectory.lower_bound.chain import chain_at, knots_within
from armik_sym.trajectory.lower_bound.linearised import beside, linearised, objective_of, smoothed
from armik_sym.trajectory.lower_bound.passes import both_ways, least_chain
from armik_sym.trajectory.lower_bound.propagate import Layer, layer_of, step
from armik_sym.trajectory.lower_bound.triple_rates import least_sine, triple_rates

GRID = np.linspace(-1, 1, 201)
numbers = st.floats(-1e3, 1e3).map(lambda x: 0.0 if abs(x) < 1e-6 else x)


@settings(max_examples=300)
@given(numbers, numbers, numbers, numbers, numbers)
def test_minima_on_line_and_square(a: float, b: float, haa: float, hab: float, hbb: float) -> None:
    x, y = GRID[:, None], GRID
    line = (a * GRID + 0.5 * haa * GRID**2).min()
    found = float(line_minimum(np.array(a), np.array(haa)))
    assert line - 1e-4 * (abs(haa) + 1) <= found <= line + 1e-9
    values = a * x + b * y + 0.5 * haa * x**2 + hab * x * y + 0.5 * hbb * y**2
    size = abs(haa) + abs(hab) + abs(hbb) + 1
    found = float(square_minimum(*(np.array(z) for z in (a, b, haa, hab, hbb))))
    assert values.min() - 1e-4 * size <= found <= values.min() + 1e-12 * size


@settings(max_examples=100)
@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(0.1, 3), st.floats(0.1, 3), st.floats(-1e-9, 1e-9))
def test_minimum_of_nearly_flat_valleys(a: float, b: float, u: float, w: float, off: float) -> None:
    """Where the pair of cells is one straight line the matrix has no determinant to speak of."""
    haa, hab, hbb = u * u, -u * w, w * w + off
    x, y = GRID[:, None], GRID
    values = a * x + b * y + 0.5 * haa * x**2 + hab * x * y + 0.5 * hbb * y**2
    found = float(square_minimum(*(np.array(z) for z in (a, b, haa, hab, hbb))))
    assert values.min() - 1e-2 <= found <= values.min() + 1e-12


@pytest.mark.parametrize("weights", [(1.0, 0.01, 1e-3), (0.0, 0.01, 0.0), (1.0, 0.0, 0.0), (0.3, 0.02, 0.5)])
def test_linearised_objective_is_below_and_touches(weights: tuple[float, float, float]) -> None:
    rng = np.random.default_rng(0)
    time, q = motion(ehmcs(), rng, 30, 1.0)
    rest = ehmcs().rom.middle
    f = objective_of(time, *weights, rest)
    assert f.value(q) == pytest.approx(objective(time, q, rest, *weights), rel=1e-9)
    for span in (0.0, 0.05):
        away = smoothed(f, f.gradient(q), 0.1 * rng.normal(size=q.shape), span)
        seen = linearised(f, f.gradient(q), away)
        assert seen.loss >= 0

        def below(e: np.ndarray, seen=seen) -> float:
            chain = 0.5 * np.sum(f.stiffness[:, None] * np.diff(e, axis=0) ** 2)
            chain += 0.5 * np.sum(f.posture[:, None] * e**2)
            return float(f.value(q) - seen.loss + np.sum(seen.force * e) + chain)

        for size in (1e-3, 0.1, 3.0):
            e = size * rng.normal(size=q.shape)
            assert below(e) <= f.value(q + e) * (1 + 1e-9)
        assert below(-away) == pytest.approx(f.value(q - away), rel=1e-9)


def test_smoothing_takes_less_than_it_brings() -> None:
    rng = np.random.default_rng(1)
    time, q = motion(ehmcs(), rng, 60, 1.0)
    q = q + 1e-4 * rng.normal(size=q.shape)
    f = objective_of(time, 1.0, 0.01, 1e-3, ehmcs().rom.middle)
    g, nothing = f.gradient(q), np.zeros_like(q)
    span = 0.05

    def cost(away: np.ndarray) -> float:
        seen = linearised(f, g, away)
        return seen.loss + float(np.sum(span**2 * np.square(seen.force).sum(axis=1) / (24 * f.durations)))

    best = cost(smoothed(f, g, nothing, span))
    for _ in range(20):
        assert best <= cost(smoothed(f, g, nothing, span) + 1e-4 * rng.normal(size=q.shape)) * (1 + 1e-12)
    assert best < 0.5 * cost(nothing)


@pytest.mark.parametrize("weights", [(1.0, 1e-3), (1.0, 0.0), (0.0, 0.4), (2.0, 5.0)])
def test_chain_is_the_least_over_what_is_between_knots(weights: tuple[float, float]) -> None:
    rng = np.random.default_rng(2)
    n, dof = 14, 3
    time = np.cumsum(rng.uniform(0.01, 0.05, n))
    f = objective_of(time, weights[0], 0.0, weights[1], np.zeros(dof))
    force = rng.normal(size=(n, dof))
    for knots in ([0, 3, 4, 9, 13], [2, 3, 8], [1, 12], list(range(n))):
        at = np.array(knots)
        chain = chain_at(f, force, at)
        free = np.setdiff1d(np.arange(n), at)
        K = (np.diag(f.posture) + objective_of(time, weights[0], 0, 0, np.zeros(dof)).K.toarray()).astype(
            float
        )
        e = rng.normal(size=(n, dof))
        right = -(force + K[:, at] @ e[at])[free]
        e[free] = np.linalg.solve(K[np.ix_(free, free)], right) if free.size else 0
        least = 0.5 * np.sum(e * (K @ e)) + np.sum(force * e)
        k = e[at]
        found = 0.5 * np.sum(chain.weight[:, None] * k**2) + np.sum(chain.force * k) - chain.sag
        found += 0.5 * np.sum(chain.stiffness[:, None] * np.diff(k, axis=0) ** 2)
        assert found == pytest.approx(least, rel=1e-9, abs=1e-9)
        assert (chain.weight >= 0).all()
        assert chain.sag >= 0


def test_knots_keep_to_their_budget_and_avoid_what_they_can() -> None:
    rng = np.random.default_rng(3)
    time = np.linspace(0, 2, 120)
    f = objective_of(time, 1.0, 0.01, 1e-3, np.zeros(2))
    force = 0.05 * np.column_stack([np.sin(3 * time), np.cos(5 * time)])
    nowhere = np.zeros(120, dtype=bool)
    counts = []
    for budget in (0.0, 1e-3, 1e-2, 1e-1):
        knots = knots_within(f, force, budget, nowhere)
        assert (knots[0], knots[-1]) == (0, 119)
        assert chain_at(f, force, knots).sag <= budget
        counts.append(len(knots))
    assert counts[0] == 120
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] < 30
    avoid = rng.uniform(size=120) < 0.2
    avoid[[0, 119]] = True
    knots = knots_within(f, force, 1e-1, avoid)
    assert not avoid[knots].any()
    everything = knots_within(f, force, 0.0, np.ones(120, dtype=bool))
    np.testing.assert_array_equal(everything, np.arange(120))


def test_trajectory_beside_a_chain_is_the_least() -> None:
    rng = np.random.default_rng(4)
    time, q = motion(ehmcs(), rng, 40, 1.0)
    f = objective_of(time, 1.0, 0.01, 1e-3, ehmcs().rom.middle)
    knots = np.arange(0, 40, 3)
    chain = 0.1 * rng.normal(size=(len(knots), 7))
    e = beside(f, f.gradient(q), knots, chain)
    ahead = beside(f, f.gradient(q) * 0, knots, chain * 0)
    assert np.abs(ahead).max() == 0
    towards = [np.linalg.norm(x[knots] - chain) for x in (e, 0 * e)]
    assert towards[0] < towards[1]


@pytest.mark.parametrize("name", ARMS)
def test_rates_and_their_bounds(name: str) -> None:
    """Against differences of the angles themselves, far from the poles and next to them."""
    rng = np.random.default_rng(5)
    arm = ARMS[name]
    n = 60
    q = rng.uniform(-np.pi, np.pi, (n, 7))
    q[:20, 1] = rng.uniform(-0.02, 0.02, 20) - recognise(arm).shoulder.offset
    curve = intervals_along(arm, q).curves[0]
    centre, half = rng.uniform(-np.pi, np.pi, n), 10 ** rng.uniform(-3, -0.5, n)
    for i in range(2):
        side = rng.choice([-1.0, 1.0], n)
        nothing = np.zeros(n)
        bounds = triple_rates(curve.parts[:, i], side, centre, half)
        far = np.isfinite(bounds.largest_curvature).all(axis=1)
        assert far.sum() > 30
        scan, h = np.linspace(-1, 1, 41), 1e-5
        angles = []
        for psi in [centre + x * half for x in scan]:
            angles.append(triple_rates(curve.parts[:, i], side, psi, nothing).angles)
            around = [triple_rates(curve.parts[:, i], side, psi + z, nothing) for z in (-h, h)]
            step_ = around[1].angles - around[0].angles
            rate = (step_ - 2 * np.pi * np.rint(step_ / (2 * np.pi))) / (2 * h)
            exact = triple_rates(curve.parts[:, i], side, psi, nothing).rate
            np.testing.assert_allclose(rate[far], exact[far], rtol=1e-5, atol=1e-5)
            assert (np.abs(rate) <= bounds.largest_rate * (1 + 1e-6) + 1e-5)[np.abs(rate) < 1e3].all()
            curved = (around[1].rate - around[0].rate) / (2 * h)
            assert (np.abs(curved) <= bounds.largest_curvature * (1 + 1e-5) + 1e-4)[far].all()
        tight = bounds.largest_curvature[far] < 10 * np.abs(curved[far]).max(axis=1, keepdims=True) + 10
        assert tight.mean() > 0.5


def test_least_sine_over_stretches() -> None:
    rng = np.random.default_rng(6)
    n = 300
    share = rng.uniform(0, 1, n)
    cosine = np.column_stack([share * rng.uniform(-1, 1, n), *(rng.uniform(-0.5, 0.5, (2, n)) * (1 - share))])
    centre, half = rng.uniform(-4, 4, n), rng.uniform(0, 4, n)
    sine, flat = least_sine(cosine, centre, half)
    psi = centre[:, None] + half[:, None] * np.linspace(-1, 1, 4001)
    values = cosine[:, :1] + cosine[:, 1:2] * np.cos(psi) + cosine[:, 2:] * np.sin(psi)
    np.testing.assert_allclose(flat, np.abs(values).max(axis=1), atol=1e-5)
    assert (flat >= np.abs(values).max(axis=1)).all()
    np.testing.assert_allclose(sine, np.sqrt(1 - flat**2), atol=1e-12)


def inside(cells: Cells, arc: int, x: float, q: np.ndarray) -> bool:
    rows = cells.arc == arc
    away = np.abs(q - cells.centre[rows] - cells.tangent[rows] * x)
    allowed = np.where(cells.smooth[rows, None], cells.spread[rows] * x * x + 3e-9, cells.spread[rows])
    return bool((away <= np.minimum(allowed, cells.spread[rows]) + 1e-8).all(axis=1).any())


@pytest.mark.parametrize("kind", ["ehmcs", "human", "alfaiz", "odd_standard", "wide", "pole", "locked"])
@pytest.mark.parametrize("width", [0.5, 0.05])
def test_every_posture_of_an_arc_is_in_one_of_its_cells(kind: str, width: float) -> None:
    rng = np.random.default_rng(7)
    arm = ARMS.get(kind, alfaiz() if kind == "wide" else human())
    if kind == "wide":
        arm = arm.with_rom(1.4 * arm.rom.lower, 1.4 * arm.rom.upper)
    q = arm.rom.random_postures(rng, 12)
    if kind == "pole":
        q[:, 1] = rng.uniform(-2e-3, 2e-3, 12) - recognise(arm).shoulder.offset
    if kind == "locked":
        q[:, 2] = 0.2
        arm = arm.with_rom(*(np.where(np.arange(7) == 2, 0.2, r) for r in (arm.rom.lower, arm.rom.upper)))
    intervals = intervals_along(arm, q)
    n = len(q)
    arcs = arcs_of(intervals, np.arange(n), width)
    assert (arcs.high - arcs.low <= width * (1 + 1e-9)).all()
    cells = cells_of(intervals, arcs, (np.tile(arm.rom.lower, (n, 1)), np.tile(arm.rom.upper, (n, 1))))
    assert (np.diff(cells.arc) >= 0).all()
    for i in rng.choice(len(arcs), min(len(arcs), 120), replace=False):
        for x in (-1.0, -0.3, 0.0, 0.6, 1.0):
            psi = 0.5 * (arcs.low[i] + arcs.high[i]) + 0.5 * x * (arcs.high[i] - arcs.low[i])
            for wish in (arm.rom.lower, arm.rom.middle, arm.rom.upper):
                posture = posture_at(intervals, arcs.sample[i], arcs.branch[i], psi, wish)
                assert arm.rom.margin(posture).min() < -1e-7 or inside(cells, i, x, posture)
    if kind == "wide":
        assert len(cells.arc) > len(arcs)


def test_arcs_cover_the_intervals_and_halves_cover_the_arcs() -> None:
    rng = np.random.default_rng(8)
    intervals = intervals_along(human(), human().rom.random_postures(rng, 6))
    samples = np.array([1, 2, 4])
    arcs = arcs_of(intervals, samples, 0.3)
    total = (intervals.end - intervals.start)[np.isin(intervals.sample, samples)].sum()
    assert (arcs.high - arcs.low).sum() == pytest.approx(total)
    chosen = rng.uniform(size=len(arcs)) < 0.5
    halves, parent = arcs.halved(chosen)
    assert len(halves) == len(arcs) + chosen.sum()
    np.testing.assert_array_equal(halves.sample, arcs.sample[parent])
    for i in range(len(arcs)):
        mine = parent == i
        assert halves.low[mine].min() == arcs.low[i]
        assert halves.high[mine].max() == arcs.high[i]
        assert (halves.high - halves.low)[mine].sum() == pytest.approx(arcs.high[i] - arcs.low[i])


def test_samples_without_intervals_may_be_anywhere_in_their_box() -> None:
    arm = ehmcs()
    intervals = feasible_intervals(
        recognise(arm), np.array([[3.0, 0, 0], [0.3, 0.1, 0.0]]), np.array([np.eye(3)] * 2)
    )
    arcs = arcs_of(intervals, np.array([0, 1]), 0.2)
    assert arcs.branch[0] == ANYWHERE
    box = np.tile(arm.rom.lower, (2, 1)), np.tile(arm.rom.upper, (2, 1))
    cells = cells_of(intervals, anywhere(np.array([0])), box)
    np.testing.assert_allclose(cells.centre[0] - cells.spread[0], arm.rom.lower, atol=1e-8)
    np.testing.assert_allclose(cells.centre[0] + cells.spread[0], arm.rom.upper, atol=1e-8)


def test_samples_next_to_a_pole_are_found() -> None:
    arm = alfaiz()
    spherical = recognise(arm)
    assert spherical.wrist is not None
    for joint, pole in ((1, -spherical.shoulder.offset), (5, -spherical.wrist.offset)):
        q = np.array([[0.3, 1.0, 0.2, 1.0, 0.1, 1.0, 0.1]])
        q[0, joint] = pole - 1e-3 * np.sign(pole)
        assert near_pole(intervals_along(arm, q)).all()
    still = np.array([[0.1, 0.6, 0.2, 1.0, 0.1, 0.6, 0.1]])
    assert not near_pole(intervals_along(ehmcs(), still)).any()


def random_layer(rng: np.random.Generator, m: int, weight: float, force: np.ndarray) -> tuple[Layer, tuple]:
    dof = len(force)
    parts = (
        rng.normal(size=(m, dof)),
        10 ** rng.uniform(-3, 0) * rng.normal(size=(m, dof)),
        10 ** rng.uniform(-5, 0) * rng.uniform(size=(m, dof)),
        rng.uniform(size=m) < 0.5,
    )
    return layer_of(*parts, weight, force), parts


def random_point(rng: np.random.Generator, parts: tuple, i: int) -> tuple[float, np.ndarray]:
    centre, tangent, spread, smooth = parts
    x = float(rng.choice([rng.uniform(-1, 1), -1.0, 1.0]))
    rho = spread[i] * rng.choice([-1.0, 1.0, 0.3], len(centre[i])) * (x * x if smooth[i] else 1.0)
    return x, centre[i] + tangent[i] * x + rho


def parabola(node: np.ndarray, x: float) -> float:
    return float(node[0] + node[1] * x + 0.5 * node[2] * x * x)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 100_000))
def test_layers_steps_and_passes_stay_below_every_chain(seed: int) -> None:
    rng = np.random.default_rng(seed)
    dof, J = 3, 4
    weights, forces = rng.uniform(0, 2, J), rng.normal(size=(J, dof))
    stiffness = np.where(rng.uniform(size=J - 1) < 0.1, 0.0, 10 ** rng.uniform(-1, 2, J - 1))
    made = [random_layer(rng, int(rng.integers(1, 6)), w, f) for w, f in zip(weights, forces, strict=True)]
    layers = [layer for layer, _ in made]
    passes = both_ways(layers, stiffness)
    value = step(layers[0], layers[0].node, layers[1], stiffness[0])
    for _ in range(60):
        cell = [int(rng.integers(len(layer.radius))) for layer in layers]
        x, e = zip(
            *(random_point(rng, parts, i) for (_, parts), i in zip(made, cell, strict=True)), strict=True
        )
        node = [0.5 * w * v @ v + f @ v for w, f, v in zip(weights, forces, e, strict=True)]
        edge = [0.5 * C * np.sum((b - a) ** 2) for C, a, b in zip(stiffness, e[:-1], e[1:], strict=True)]
        slack = 1e-9 * (1 + sum(map(abs, node)) + sum(edge))
        for j in range(J):
            assert parabola(layers[j].node[:, cell[j]], x[j]) <= node[j] + slack
            assert passes.through[j][cell[j]] <= sum(node) + sum(edge) + slack
        assert parabola(value[:, cell[1]], x[1]) <= node[0] + edge[0] + node[1] + slack
    chain = least_chain(passes, layers, stiffness, 1, 0)
    assert chain.shape == (J, dof)
    own = layers[1].centre[0] - chain[1]
    assert np.linalg.norm(own) <= np.linalg.norm(layers[1].tangent[0]) * (1 + 1e-9)


def test_steps_between_fine_cells_are_near_the_truth() -> None:
    """A circle in three dimensions, two knots: the bound of each cell against a dense scan."""
    radius, stiffness = 1.0, 4.0
    force = np.array([0.3, -0.2, 0.1])

    def circle(psi: np.ndarray, turn: float) -> np.ndarray:
        return radius * np.column_stack([np.cos(psi), np.sin(psi) * np.cos(turn), np.sin(psi) * np.sin(turn)])

    errors = []
    for count in (40, 80, 160):
        half = np.pi / count
        psi = -np.pi + half * (2 * np.arange(count) + 1)
        layers = []
        for turn in (0.0, 0.4):
            tangent = circle(psi + np.pi / 2, turn) * half
            spread = np.full((count, 3), 0.5 * half**2)
            layers.append(layer_of(circle(psi, turn), tangent, spread, np.ones(count, bool), 0.1, force))
        found = min(through.min() for through in both_ways(layers, np.array([stiffness])).through)
        dense = np.linspace(-np.pi, np.pi, 1001)
        a, b = circle(dense, 0.0), circle(dense, 0.4)
        cost = 0.5 * stiffness * (2 * radius**2 - 2 * a @ b.T) + (a @ force)[:, None] + b @ force + 0.1
        assert found <= cost.min()
        errors.append(cost.min() - found)
    assert errors[2] < 0.1 * errors[0]
    assert errors[2] < 5e-3
