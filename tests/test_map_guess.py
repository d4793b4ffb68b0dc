"""The first guess from the swivel map for what the map cannot hold: positions, pointing, soft tracking."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from compiled_helpers import needs_cc
from exact_solves import check
from sample_arms import ARMS, custom
from smooth_motions import path_of, smooth_angles, smooth_path

import armik_sym as ak
from armik_sym.arm import DHConvention
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.motion.hand_path import HandPath
from armik_sym.solution.tracked_orientation import tracked_orientation
from armik_sym.trajectory.global_path.knots import knots
from armik_sym.trajectory.map_guess import map_guess
from armik_sym.trajectory.options import TrajectoryOptions
from armik_sym.trajectory.request import Request

EHMCS = ARMS["ehmcs"]
WAYS = [{"orientation": "none"}, {"orientation": "pointing"}, {"tracking": "soft"}]


def thin(path, every=4):
    return HandPath(path.time[::every], path.position[::every], path.rotation[::every])


def request(arm, path, start=None, backend="auto", **options):
    chosen = TrajectoryOptions(**options)
    limits = np.full(arm.dof, 10.0), np.full(arm.dof, np.inf)
    orientation = tracked_orientation(chosen.orientation, path)
    return Request(arm, path, orientation, chosen, *limits, start, 0, backend, None)


@pytest.mark.parametrize("options", WAYS, ids=str)
@pytest.mark.parametrize("name", ["ehmcs", "human", "alfaiz", "ehmcs_5dof", "ehmcs_4dof"])
def test_postures_at_knots_hold_the_hand_and_all_are_in_range(name, options):
    arm = ARMS[name]
    if arm.dof < 7:
        options = {"orientation": "none"}
    path, _ = smooth_path(arm, 40, 1)
    guess = map_guess(request(arm, path, **options))
    assert guess is not None
    assert guess.q.shape == (40, arm.dof)
    assert arm.rom.margin(guess.q).min() >= -1e-9
    at = knots(path, arm.reach)
    position, rotation = hand_pose(arm.chain, guess.q, arm.lengths)
    assert np.abs(position[at] - path.position[at]).max() < 1e-9
    if "orientation" not in options or options["orientation"] == "pointing":
        assert np.abs(rotation[at] - path.rotation[at]).max() < 1e-9


@pytest.mark.parametrize("arm", [custom(DHConvention.STANDARD), ARMS["human"]], ids=lambda arm: arm.name)
def test_arms_without_closed_form_have_no_guess(arm):
    path, _ = smooth_path(arm, 10, 0)
    guess = map_guess(request(arm, path, orientation="none"))
    assert (guess is None) == (arm.name != "human")


def test_samples_without_a_posture_are_passed_over_softly_and_stop_an_exact_guess():
    path, _ = smooth_path(EHMCS, 60, 1)
    position = path.position.copy()
    position[20:30] *= 3
    broken = HandPath(path.time, position, path.rotation)
    soft = map_guess(request(EHMCS, broken, tracking="soft"))
    assert soft is not None
    assert np.isfinite(soft.q).all()
    assert EHMCS.rom.margin(soft.q).min() >= -1e-9
    assert map_guess(request(EHMCS, broken, orientation="none")) is None
    far = HandPath(path.time, 10 * path.position, path.rotation)
    assert map_guess(request(EHMCS, far, tracking="soft")) is None


@pytest.mark.parametrize("options", WAYS, ids=str)
def test_it_begins_with_the_start_posture(options):
    path, q = smooth_path(EHMCS, 40, 1)
    guess = map_guess(request(EHMCS, path, start=q[0], **options))
    assert guess is not None
    assert np.array_equal(guess.q[0], q[0])


@needs_cc
@pytest.mark.parametrize("options", WAYS, ids=str)
def test_backends_agree(options):
    path, _ = smooth_path(EHMCS, 40, 1)
    c, vm = (map_guess(request(EHMCS, path, backend=backend, **options)) for backend in ("c", "vm"))
    assert np.abs(c.q - vm.q).max() < 1e-9


@pytest.mark.parametrize("options", WAYS, ids=str)
@pytest.mark.parametrize("name", ak.task_names())
def test_full_space_converges_from_it_on_the_bundled_tasks(name, options, monkeypatch):
    path = thin(ak.load_task(name).path)
    used = []
    module = sys.modules["armik_sym.trajectory.solve_trajectory"]
    genuine = module.solve_in_full_space

    def note(asked, known=()):
        used.extend(guess.origin for guess in known)
        return genuine(asked, known)

    monkeypatch.setattr(module, "solve_in_full_space", note)
    stages = []
    solution = ak.solve(EHMCS, path, progress=lambda r: stages.append((r.stage, r.iteration)), **options)
    assert used == ["way through the swivel map"]
    if options.get("tracking") == "soft":
        assert solution.ok
    else:
        check(solution)
    # Converged at the first try: iterations were counted from 0 once.
    assert stages.count(("soft tracking" if "tracking" in options else "exact tracking", 0)) == 1
    without = ak.solve(EHMCS, path, search="full-space", **options)
    if "tracking" not in options:
        # With free wrist joints there are many local optima, and either start may find the better one.
        assert solution.cost <= 1.1 * without.cost


def test_noise_is_tracked_softly_from_it():
    q = smooth_angles(EHMCS, 60, seed=1)
    clean = path_of(EHMCS, q)
    noisy = HandPath(
        clean.time,
        clean.position + np.random.default_rng(0).normal(0, 2e-3, clean.position.shape),
        clean.rotation,
    )
    assert ak.solve(EHMCS, noisy, tracking="soft").ok
