"""The whole solve: exact, inside every limit, on time, quiet, and clear where it cannot be done."""

from __future__ import annotations

import numpy as np
import pytest
from compiled_helpers import entries, forgotten, needs_cc
from exact_solves import EHMCS, N, check, free_solve, reference_solve
from sample_arms import ARMS, custom
from smooth_motions import objective, path_of, smooth_angles, smooth_path, uneven_time

import armik_sym as ak
from armik_sym.arm import DHConvention
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.errors import SolverError, UnreachablePathError
from armik_sym.motion.hand_path import HandPath
from armik_sym.trajectory.options import TrajectoryOptions

WEIGHTS = (
    TrajectoryOptions.speed_weight,
    TrajectoryOptions.acceleration_weight,
    TrajectoryOptions.posture_weight,
)


BOTH = pytest.mark.parametrize("search", ["swivel", "full-space"])


def no_worse_than(solution, q):
    mine, other = (
        objective(solution.time, motion, solution.arm.rom.middle, WEIGHTS) for motion in (solution.q, q)
    )
    assert mine <= 1.001 * other


@pytest.fixture(scope="module")
def reference():
    return reference_solve()


@pytest.fixture(scope="module")
def free():
    return free_solve()


@pytest.mark.parametrize(
    ("orientation", "search"),
    [
        ("full", "swivel"),
        ("full", "full-space"),
        ("pointing", "full-space"),
        ("pointing", "auto"),
        ("none", "full-space"),
        ("none", "auto"),
    ],
)
@pytest.mark.parametrize(("name", "seed"), [("ehmcs", 1), ("human", 0), ("alfaiz", 2)])
def test_every_arm_and_orientation_is_exact_inside_limits_and_no_worse_than_the_motion(
    name, seed, orientation, search
):
    path, q = smooth_path(ARMS[name], N, seed)
    solution = check(ak.solve(ARMS[name], path, orientation=orientation, search=search))
    assert solution.orientation.value == orientation
    no_worse_than(solution, q)


@BOTH
@pytest.mark.parametrize("name", ak.task_names())
def test_bundled_tasks(name, search):
    task = ak.load_task(name)
    solution = check(ak.solve(EHMCS, task.path, search=search))
    assert np.all(solution.max_speed <= TrajectoryOptions.max_speed)
    no_worse_than(solution, task.measured.q)


@pytest.mark.parametrize("name", ["ehmcs_4dof", "ehmcs_5dof"])
def test_shorter_arms_follow_positions(name):
    path, q = smooth_path(ARMS[name], N, seed=1)
    no_worse_than(check(ak.solve(ARMS[name], path, orientation="none")), q)


def test_arm_with_sliding_joints_follows_positions():
    arm = custom(DHConvention.STANDARD)
    path, q = smooth_path(arm, N, seed=0)
    no_worse_than(check(ak.solve(arm, path, orientation="none")), q)


@pytest.mark.parametrize(
    ("orientation", "search"), [("full", "swivel"), ("full", "full-space"), ("none", "auto")]
)
def test_motion_that_touches_both_limits_of_every_joint(orientation, search):
    q = smooth_angles(EHMCS, N, seed=1)
    tight = EHMCS.with_rom(q.min(axis=0), q.max(axis=0))
    solution = check(ak.solve(tight, path_of(EHMCS, q), orientation=orientation, search=search))
    assert np.all(solution.rom_margin >= 0)
    no_worse_than(solution, q)


@pytest.mark.parametrize(
    ("joints", "orientation", "search"),
    [
        ([2], "full", "full-space"),
        ([5, 6], "full", "full-space"),
        ([2], "full", "swivel"),
        ([5, 6], "full", "swivel"),
        ([5, 6], "none", "auto"),
        ([0, 4], "none", "auto"),
    ],
)
def test_joints_locked_by_a_range_of_zero_width_stay_exactly_where_they_are(joints, orientation, search):
    lower, upper = EHMCS.rom.lower.copy(), EHMCS.rom.upper.copy()
    lower[joints] = upper[joints] = EHMCS.rom.middle[joints] + 0.1
    locked = EHMCS.with_rom(lower, upper)
    path, _ = smooth_path(locked, N, seed=4)
    solution = check(ak.solve(locked, path, orientation=orientation, search=search))
    assert np.all(solution.q[:, joints] == lower[joints])
    assert np.all(solution.rom_margin[joints] == 0)


@BOTH
def test_time_stamps_are_respected(search):
    q = smooth_angles(EHMCS, N, seed=1)
    path = path_of(EHMCS, q, uneven_time(N, 0))
    even = HandPath(np.linspace(0, 4, N), path.position, path.rotation)
    uneven, regular = (check(ak.solve(EHMCS, each, search=search)) for each in (path, even))
    no_worse_than(uneven, q)
    no_worse_than(uneven, regular.q)
    assert np.abs(uneven.q - regular.q).max() > 1e-4


def test_a_slower_clock_in_the_middle_lowers_the_speed_there_only(reference):
    path, _, fast = reference
    steps = np.diff(path.time)
    steps[10:14] *= 8
    slow = HandPath(np.concatenate([[0], np.cumsum(steps)]), path.position, path.rotation)
    solution = check(ak.solve(EHMCS, slow))
    speed, before = (np.linalg.norm(np.diff(s.q, axis=0), axis=1) / np.diff(s.time) for s in (solution, fast))
    assert speed[10:14].max() < before[10:14].max() / 4


@pytest.mark.parametrize("name", ["max_speed", "max_acceleration"])
def test_a_rate_limit_binds_and_holds_without_tolerance(free, name):
    path, unlimited = free
    limit = 0.9 * getattr(unlimited, name).max()
    solution = check(ak.solve(EHMCS, path, **{name: limit}))
    peak = getattr(solution, name).max()
    assert peak <= limit
    assert peak > 0.999 * limit
    cost, best = (objective(path.time, s.q, EHMCS.rom.middle, WEIGHTS) for s in (solution, unlimited))
    assert cost >= best * (1 - 1e-9)


def test_limits_of_single_joints(free):
    path, unlimited = free
    joint = int(np.argmax(unlimited.max_speed))
    limits = np.full(7, np.inf)
    limits[joint] = 0.8 * unlimited.max_speed[joint]
    solution = check(ak.solve(EHMCS, path, max_speed=limits))
    assert 0.999 * limits[joint] < solution.max_speed[joint] <= limits[joint]


def test_a_very_small_speed_limit_holds_as_exactly(free):
    path, unlimited = free
    slow = HandPath(path.time * 1e4, path.position)
    limit = 0.9 * unlimited.max_speed.max() / 1e4
    solution = check(ak.solve(EHMCS, slow, max_speed=limit))
    assert 0.99 * limit < solution.max_speed.max() <= limit


@BOTH
def test_a_start_on_the_path_is_kept(reference, search):
    path, q, _ = reference
    solution = check(ak.solve(EHMCS, path, start=q[0], search=search))
    assert np.abs(solution.q[0] - q[0]).max() < 1e-9


@BOTH
@pytest.mark.parametrize("far", [False, True])
def test_a_start_beside_the_path_leads_to_a_posture_on_it(reference, far, search):
    path, q, _ = reference
    start = EHMCS.rom.lower if far else q[0] + 0.02
    solution = ak.solve(EHMCS, path, start=start, max_speed=None, search=search)
    assert not solution.ok
    assert "start posture does not put the hand on the path" in solution.reasons[0]
    assert np.array_equal(solution.start, start)
    gap = np.abs(solution.q[0] - start).max()
    check(ak.solve(EHMCS, path, start=start, max_speed=None, start_tolerance=gap + 1e-9, search=search))
    assert far or gap < 0.2


def test_soft_tracking_begins_with_the_start_posture_itself(reference):
    path, q, _ = reference
    start = EHMCS.rom.clip(q[0] + 0.02)
    solution = ak.solve(EHMCS, path, start=start, tracking="soft")
    assert np.array_equal(solution.q[0], start)


@BOTH
@pytest.mark.parametrize(("rate", "n"), [(1000, 1000), (5000, 1000)])
def test_controller_rates_are_solved(rate, n, search):
    time = np.arange(n) / rate
    waves = np.sin(2 * np.pi * np.linspace(0.4, 1.0, 7) * time[:, None] + np.arange(7))
    q = EHMCS.rom.middle + 0.25 * np.minimum(EHMCS.rom.width, 2.0) * waves
    position, rotation = hand_pose(EHMCS.chain, q, EHMCS.lengths)
    check(ak.solve(EHMCS, HandPath(time, position, rotation), seed=0, search=search))


@BOTH
@pytest.mark.parametrize("gap", [1e-4, 1e-6, 1e-8])
def test_time_stamps_that_nearly_coincide_do_no_harm(gap, search):
    time = np.arange(100) / 100
    time[50] = time[49] + gap
    waves = np.sin(2 * np.pi * np.linspace(0.4, 1.0, 7) * time[:, None] + np.arange(7))
    q = EHMCS.rom.middle + 0.25 * np.minimum(EHMCS.rom.width, 2.0) * waves
    position, rotation = hand_pose(EHMCS.chain, q, EHMCS.lengths)
    check(ak.solve(EHMCS, HandPath(time, position, rotation), search=search))


@BOTH
@pytest.mark.parametrize("chosen", [[0, 12], [0, 8, 20]])
def test_shortest_paths(reference, chosen, search):
    path = reference[0]
    short = HandPath(path.time[chosen], path.position[chosen], path.rotation[chosen])
    solution = check(ak.solve(EHMCS, short, search=search))
    assert solution.q.shape == (len(chosen), 7)


@pytest.mark.parametrize(
    ("tracking", "search"),
    [("exact", "swivel"), ("exact", "full-space"), ("soft", "auto"), ("soft", "full-space")],
)
def test_same_seed_same_angles(reference, tracking, search):
    path = reference[0]
    first, second = (ak.solve(EHMCS, path, seed=5, tracking=tracking, search=search) for _ in range(2))
    assert np.array_equal(first.q, second.q)
    assert first.seed == 5


@needs_cc
@pytest.mark.parametrize(("search", "close"), [("swivel", 1e-9), ("full-space", 1e-6)])
def test_virtual_machine_and_compiled_code_agree(reference, search, close):
    path, _, _ = reference
    c, vm = (check(ak.solve(EHMCS, path, backend=backend, search=search)) for backend in ("c", "vm"))
    assert np.abs(c.q - vm.q).max() < close


@needs_cc
def test_other_lengths_and_other_path_lengths_compile_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "cache").mkdir(mode=0o700)
    arm = ARMS["ehmcs_4dof"]
    with forgotten():
        from armik_sym.compiled import stage_functions

        stage_functions._program.cache_clear()
        ak.compile(arm)
        after_kinematics = entries(tmp_path / "cache")
        path, _ = smooth_path(arm, 10, seed=1)
        first = check(ak.solve(arm, path, orientation="none"))
        kept = entries(tmp_path / "cache")
        assert len(kept) > len(after_kinematics) > 0
        # The kinematics were compiled before this call, the tracking equations in it.
        assert 0 < first.timing.compile <= first.timing.total
        other = arm.with_lengths(upper_arm=0.25, forearm=0.29)
        longer, _ = smooth_path(other, 17, seed=1)
        second = check(ak.solve(other, longer, orientation="none"))
        assert second.timing.compile == 0
        assert entries(tmp_path / "cache") == kept
        stage_functions._program.cache_clear()


@BOTH
def test_nothing_is_printed_unless_asked_for(capfd, search):
    lower, upper = EHMCS.rom.lower.copy(), EHMCS.rom.upper.copy()
    lower[5:] = upper[5:] = 0.0
    locked = EHMCS.with_rom(lower, upper)
    path, _ = smooth_path(locked, 8, seed=1)
    ak.solve(locked, path, search=search)  # fewer free variables than equations: CasADi would warn
    ak.solve(EHMCS, smooth_path(EHMCS, 8, seed=1)[0], search=search)
    with pytest.raises(UnreachablePathError):
        ak.solve(locked, smooth_path(EHMCS, 8, seed=1)[0], search=search)
    far = HandPath([0.0, 1.0], [[1.0, 0, 0], [1.1, 0, 0]])
    with pytest.raises(UnreachablePathError):
        ak.solve(EHMCS, far)
    ak.solve(EHMCS, far, tracking="soft")
    with pytest.raises(SolverError):
        ak.solve(EHMCS, smooth_path(EHMCS, 8, seed=1)[0], max_iterations=1, search="full-space")
    assert capfd.readouterr() == ("", "")
    ak.solve(EHMCS, smooth_path(EHMCS, 8, seed=1)[0], ipopt_output=True, search=search)
    assert "Number of Iterations" in capfd.readouterr().out


# --- soft tracking ---------------------------------------------------------------------------------


def test_soft_tracking_stretches_towards_what_it_cannot_reach():
    direction = np.array([0.0, 0.6, 0.8])
    shoulder = np.array([0.0, 0.0, 0.143])
    reach = np.linspace(0.5, 0.8, N)[:, None]
    path = HandPath(np.linspace(0, 4, N), shoulder + reach * direction)
    solution = ak.solve(EHMCS, path, tracking="soft")
    longest = EHMCS.lengths["upper_arm"] + EHMCS.lengths["forearm"]
    out = reach[:, 0] - longest
    assert np.all(solution.q >= EHMCS.rom.lower)
    assert np.all(solution.q <= EHMCS.rom.upper)
    far, near = out > 0.03, out < -0.05
    assert solution.position_error[near].max() < 2e-3
    np.testing.assert_allclose(solution.position_error[far], out[far], atol=5e-3)
    assert np.all(solution.position_error[out > 0] >= out[out > 0] - 1e-9)
    assert not solution.ok
    assert "position error" in solution.reasons[0]
    assert ak.solve(EHMCS, path, tracking="soft", position_tolerance=0.2).ok


def test_soft_tracking_smooths_noise():
    clean, _ = smooth_path(EHMCS, 60, seed=1)
    noise = np.random.default_rng(0).normal(0, 2e-3, clean.position.shape)
    noisy = HandPath(clean.time, clean.position + noise)
    soft = ak.solve(EHMCS, noisy, tracking="soft", position_sigma=4e-3, speed_weight=0.1)
    assert soft.ok, soft.reasons
    follows = np.linalg.norm(hand_pose(EHMCS.chain, soft.q, EHMCS.lengths)[0] - clean.position, axis=1)
    assert np.sqrt(np.mean(follows**2)) < 0.9 * np.sqrt(np.mean(np.sum(noise**2, axis=1)))
    exact = ak.solve(EHMCS, noisy)
    assert soft.max_acceleration.max() < 0.5 * exact.max_acceleration.max()


def test_soft_tracking_with_tiny_sigmas_approaches_exact(reference):
    path, _, exact = reference
    errors, distances = [], []
    for sigma in (1e-2, 1e-4):
        soft = ak.solve(EHMCS, path, tracking="soft", position_sigma=sigma, rotation_sigma=sigma)
        errors.append(soft.position_error.max())
        distances.append(np.abs(soft.q - exact.q).max())
    assert errors[1] < 1e-5
    assert errors[1] < errors[0] / 1000
    assert distances[1] < 1e-3


def test_soft_tracking_keeps_rate_limits(free):
    path, unlimited = free
    limit = 0.5 * unlimited.max_speed.max()
    solution = ak.solve(EHMCS, path, tracking="soft", max_speed=limit)
    assert solution.max_speed.max() <= limit
    assert solution.max_speed.max() > 0.99 * limit


@BOTH
def test_without_any_weight_a_feasible_motion_is_found(reference, search):
    weights = dict.fromkeys(("speed_weight", "acceleration_weight", "posture_weight"), 0.0)
    check(ak.solve(EHMCS, reference[0], max_speed=None, search=search, **weights))
