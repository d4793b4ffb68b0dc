"""Levenberg-Marquardt and Sugihara's method: outcomes, limits, C against NumPy, odd input."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from damped_helpers import NUMPY, compiled, distance, middle, reachable, targets_of
from sample_arms import BARE, custom
from scipy.spatial.transform import Rotation

from armik_sym.arm import Arm, DHConvention
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.compiled.kinematics import compile
from armik_sym.errors import OptionError, ShapeError
from armik_sym.pointwise.damped import LmOptions, SugiharaOptions, run_damped
from armik_sym.pointwise.hand_targets import HandTargets, PointwiseOutcome
from armik_sym.progress import Progress
from armik_sym.symbolic import Orientation

EHMCS, HUMAN, ALFAIZ = ehmcs(), human(), alfaiz()
ARMS = [EHMCS, HUMAN, ALFAIZ, ehmcs(4), custom(DHConvention.STANDARD), BARE]
METHODS = [LmOptions, SugiharaOptions]

any_method = pytest.mark.parametrize("method", METHODS, ids=["lm", "sugihara"])
any_arm = pytest.mark.parametrize("arm", ARMS, ids=lambda arm: f"{arm.name}{arm.dof}")
in_both = pytest.mark.parametrize("in_c", [True, False], ids=["c", "numpy"])


def run(
    arm: Arm,
    targets: HandTargets,
    options: LmOptions | SugiharaOptions,
    start: np.ndarray | None = None,
    in_c: bool = True,
    seed: int = 0,
    **keywords: object,
) -> PointwiseOutcome:
    library = compiled(arm) if in_c else NUMPY
    return run_damped(arm, targets, options, start=start, seed=seed, library=library, **keywords)


def assert_inside(arm: Arm, q: np.ndarray) -> None:
    assert np.isfinite(q).all()
    assert (q >= arm.rom.lower).all()
    assert (q <= arm.rom.upper).all()


def assert_same(a: PointwiseOutcome, b: PointwiseOutcome) -> None:
    np.testing.assert_array_equal(a.q, b.q)
    np.testing.assert_array_equal(a.reached, b.reached)
    np.testing.assert_array_equal(a.iterations, b.iterations)
    assert a.evaluations == b.evaluations


@any_method
@any_arm
def test_reached_poses_are_reached_and_restarts_reach_nearly_all(method: type, arm: Arm) -> None:
    targets = reachable(arm, 300)
    outcome = run(arm, targets, method(restarts=30), middle(arm, 300))
    assert_inside(arm, outcome.q)
    assert outcome.reached.mean() > 0.98
    assert (distance(arm, outcome.q, targets)[outcome.reached] < 1e-8).all()


@any_method
@pytest.mark.parametrize("arm", [EHMCS, HUMAN, ALFAIZ], ids=lambda arm: arm.name)
def test_one_cold_start_reaches_most_poses_in_few_steps(method: type, arm: Arm) -> None:
    targets = reachable(arm, 1000)
    outcome = run(arm, targets, method(), middle(arm, 1000))
    assert outcome.reached.mean() > 0.74
    assert outcome.iterations[outcome.reached].mean() < 13
    np.testing.assert_array_equal(outcome.reached, distance(arm, outcome.q, targets) < 1e-8)


@any_method
@in_both
def test_position_alone(method: type, in_c: bool) -> None:
    targets = reachable(EHMCS, 60, orientation=Orientation.NONE)
    outcome = run(EHMCS, targets, method(), middle(EHMCS, 60), in_c)
    assert outcome.reached.mean() > 0.85
    assert (distance(EHMCS, outcome.q, targets)[outcome.reached] < 1.1e-9).all()


@any_method
@any_arm
def test_c_and_numpy_take_the_same_steps(method: type, arm: Arm) -> None:
    targets, n = reachable(arm, 25, seed=3), 25
    starts = arm.rom.random_postures(np.random.default_rng(4), n)
    starts[:10] = np.where(np.arange(arm.dof) % 2, arm.rom.lower, arm.rom.upper)
    for options in (method(max_iterations=k) for k in (1, 2, 3)):
        a, b = (run(arm, targets, options, starts, in_c) for in_c in (True, False))
        np.testing.assert_allclose(a.q, b.q, atol=1e-10)
        np.testing.assert_array_equal(a.iterations, b.iterations)
        assert a.evaluations == b.evaluations
    a, b = (run(arm, targets, method(restarts=2), starts, in_c) for in_c in (True, False))
    assert abs(int(a.reached.sum()) - int(b.reached.sum())) <= 1
    together = a.reached & b.reached & (a.iterations == b.iterations)
    assert together.sum() >= 0.7 * a.reached.sum()
    np.testing.assert_allclose(a.q[together], b.q[together], atol=1e-6)


@any_method
def test_c_and_numpy_agree_with_printed_residual_and_constant_damping(method: type) -> None:
    more = {"constant_damping": 0.01} if method is LmOptions else {"damping": 1e-3}
    options = method(residual="printed", max_iterations=3, rotation_weight=0.5, **more)
    targets = reachable(HUMAN, 20)
    a, b = (run(HUMAN, targets, options, middle(HUMAN, 20), in_c) for in_c in (True, False))
    np.testing.assert_allclose(a.q, b.q, atol=1e-10)


@in_both
def test_first_lm_step_is_eq_63_with_mu_plus_c(in_c: bool) -> None:
    arm = HUMAN.with_rom(np.full(7, -12.0), np.full(7, 12.0))
    q0 = HUMAN.rom.middle
    target = targets_of(arm, q0[None] + 0.02)
    options = LmOptions(max_iterations=1, damping=0.07, constant_damping=0.2, rotation_weight=1.0)
    outcome = run(arm, target, options, q0, in_c)
    p, R, J = compile(arm, "vm").pose_and_jacobian(q0)
    E = target.pose[0, 3:].reshape(3, 3) @ R.T
    angle = np.arccos((np.trace(E) - 1) / 2)
    l_corrected = np.array([E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])
    e = np.concatenate([target.pose[0, :3] - p, l_corrected * angle / (2 * np.sin(angle))])
    U, values, Vt = np.linalg.svd(J)
    S = np.zeros(J.shape)
    np.fill_diagonal(S, values)
    step = Vt.T @ np.linalg.inv(S.T @ S + 0.27 * np.eye(7)) @ S.T @ U.T @ e
    np.testing.assert_allclose(outcome.q[0] - q0, step, atol=1e-10)


def test_sugihara_takes_steps_that_do_not_help_but_keeps_the_best() -> None:
    targets = reachable(EHMCS, 1000, seed=6)
    kept, sizes = [], []
    for k in range(1, 9):
        outcome = run(EHMCS, targets, SugiharaOptions(max_iterations=k), middle(EHMCS, 1000))
        kept.append(outcome.q)
        sizes.append(distance_in_metres(EHMCS, outcome.q, targets))
    assert (np.diff(sizes, axis=0) <= 1e-12).all()
    stayed = (np.diff(kept, axis=0) == 0).all(axis=2) & (np.array(sizes[1:]) > 1e-3)
    # After a step that was no gain it goes on from there, not from the best posture again.
    helped_later = stayed[:-1] & ~stayed[1:]
    assert helped_later.any()
    step, sample = np.argwhere(helped_later)[0]
    for k in (step + 1, step + 2, step + 3):
        alone = HandTargets(Orientation.FULL, targets.pose[sample : sample + 1])
        again = run(EHMCS, alone, SugiharaOptions(max_iterations=int(k)), None, in_c=False)
        np.testing.assert_allclose(again.q[0], kept[k - 1][sample], atol=1e-9)


def distance_in_metres(arm: Arm, q: np.ndarray, targets: HandTargets) -> np.ndarray:
    p, R, _ = compile(arm, "vm").pose_and_jacobian(q)
    E = targets.pose[:, 3:].reshape(-1, 3, 3) @ R.swapaxes(1, 2)
    angle = Rotation.from_matrix(E).magnitude()
    return np.hypot(np.linalg.norm(targets.pose[:, :3] - p, axis=1), 0.3 * angle)


def test_printed_residual_misses_the_poses_and_turns_the_hand_away() -> None:
    targets, starts = reachable(EHMCS, 300), middle(EHMCS, 300)
    printed, corrected = (
        run(EHMCS, targets, LmOptions(residual=r), starts) for r in ("printed", "corrected")
    )
    assert corrected.reached.mean() > 0.74
    assert (distance(EHMCS, printed.q, targets) > 1e-4).all()
    # It vanishes at half a turn, too, and so claims success there.
    assert printed.reached.mean() > 0.1
    # One step from 0.1 rad away about (1, 0, 1), nearly undamped: as printed it leads away and is undone.
    arm = ALFAIZ.with_rom(np.full(7, -12.0), np.full(7, 12.0))
    q0 = np.array([0.3, 0.5, -0.4, 1, 0.2, 0.4, -0.6])
    target = targets_of(arm, q0[None])
    turn = Rotation.from_rotvec(0.1 * np.sqrt(0.5) * np.array([1, 0, 1])).as_matrix()
    target.pose[0, 3:] = (turn @ target.pose[0, 3:].reshape(3, 3)).ravel()
    one_step = {
        r: run_damped(
            arm,
            target,
            LmOptions(max_iterations=1, residual=r, damping=1e-6),
            start=q0,
            seed=0,
            library=compiled(ALFAIZ),
        ).q
        for r in ("printed", "corrected")
    }
    np.testing.assert_array_equal(one_step["printed"][0], q0)
    assert distance_in_metres(arm, one_step["corrected"], target)[0] < 0.1 * 0.03


@any_method
@in_both
def test_limits_are_never_left(method: type, in_c: bool) -> None:
    rng = np.random.default_rng(7)
    targets = reachable(EHMCS, 12, seed=8)
    for width in (1e-9, 0.05, 1.0):
        centre = EHMCS.rom.random_postures(rng, 1)[0]
        arm = EHMCS.with_rom(centre - width * rng.uniform(0, 1, 7), centre + width * rng.uniform(0, 1, 7))
        corners = np.where(rng.uniform(size=(12, 7)) < 0.5, arm.rom.lower, arm.rom.upper)
        for options in (method(), method(restarts=2), method(residual="printed", max_iterations=20)):
            outcome = run_damped(
                arm, targets, options, start=corners, seed=1, library=compiled(EHMCS) if in_c else NUMPY
            )
            assert_inside(arm, outcome.q)


@in_both
def test_a_joint_without_motion_and_starts_outside(in_c: bool) -> None:
    lower, upper = HUMAN.rom.lower.copy(), HUMAN.rom.upper.copy()
    lower[2] = upper[2] = 0.1
    arm = HUMAN.with_rom(lower, upper)
    targets = targets_of(arm, arm.rom.random_postures(np.random.default_rng(0), 20))
    starts = np.random.default_rng(1).normal(scale=10, size=(20, 7))
    starts[0], starts[1, 3], starts[2, 4] = np.nan, np.inf, -np.inf
    library = compiled(HUMAN) if in_c else NUMPY
    outcome = run_damped(arm, targets, LmOptions(restarts=10), start=starts, seed=0, library=library)
    assert_inside(arm, outcome.q)
    assert (outcome.q[:, 2] == 0.1).all()
    assert outcome.reached.mean() > 0.8


@any_method
@in_both
def test_what_cannot_be_reached_is_not_reached(method: type, in_c: bool) -> None:
    targets = reachable(HUMAN, 4)
    targets.pose[:, :3] += [2.0, 0, 0]
    outcome = run(HUMAN, targets, method(restarts=1), middle(HUMAN, 4), in_c)
    assert not outcome.reached.any()
    assert_inside(HUMAN, outcome.q)
    assert (outcome.iterations <= 200).all()
    p, _, _ = compile(HUMAN, "vm").pose_and_jacobian(np.vstack([outcome.q, middle(HUMAN, 4)]))
    left = np.linalg.norm(np.tile(targets.pose[:, :3], (2, 1)) - p, axis=1)
    assert (left[:4] < left[4:]).all()


@any_method
@in_both
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e200, 1e308])
def test_targets_that_are_no_numbers(method: type, in_c: bool, value: float) -> None:
    for column in (0, 2, 3, 7, 11):
        targets = reachable(EHMCS, 3)
        targets.pose[1, column] = value
        outcome = run(EHMCS, targets, method(restarts=5), None, in_c)
        assert not outcome.reached[1]
        assert_inside(EHMCS, outcome.q)
        np.testing.assert_array_equal(outcome.q[1], outcome.q[0])
        assert outcome.iterations[1] == 0


@any_method
def test_results_do_not_depend_on_threads_or_blocks(method: type) -> None:
    targets, starts = reachable(EHMCS, 150), middle(EHMCS, 150)
    options = method(restarts=3)
    once = run(EHMCS, targets, options, starts, seed=5)
    for workers, block in ((1, 1), (1, 7), (2, 7), (2, 64), (3, 1000)):
        again = run(EHMCS, targets, options, starts, seed=5, workers=workers, block=block)
        assert_same(once, again)
    other = run(EHMCS, targets, options, starts, seed=6)
    assert not np.array_equal(once.q, other.q)
    path = run(EHMCS, targets, options, seed=5)
    for block in (1, 13):
        assert_same(path, run(EHMCS, targets, options, seed=5, workers=2, block=block))


@any_method
@in_both
def test_a_path_is_followed_from_posture_to_posture(method: type, in_c: bool) -> None:
    t = np.linspace(0, 1, 40)[:, None]
    a, b = EHMCS.rom.middle, EHMCS.rom.middle + 0.3 * EHMCS.rom.width * np.cos(np.arange(7))
    q = a + (b - a) * t**2 * (3 - 2 * t)
    targets = targets_of(EHMCS, q)
    path = run(EHMCS, targets, method(), q[0], in_c)
    assert path.reached.all()
    assert np.abs(np.diff(path.q, axis=0)).max() < 0.1
    assert path.iterations.mean() < 7
    # Every sample again, alone, from the posture before: the same.
    alone = run(EHMCS, targets, method(), np.vstack([q[:1], path.q[:-1]]), in_c)
    assert_same(path, alone)
    np.testing.assert_array_equal(
        run(EHMCS, targets, method(), None, in_c).q, run(EHMCS, targets, method(), a, in_c).q
    )


@in_both
def test_the_same_seed_gives_the_same_restarts_as_in_c_and_numpy(in_c: bool) -> None:
    targets = reachable(HUMAN, 30, seed=11)
    options = SugiharaOptions(restarts=40, max_iterations=4, tolerance=1e-3)
    outcome = run(HUMAN, targets, options, middle(HUMAN, 30), in_c, seed=2**64 - 1)
    other = run(HUMAN, targets, options, middle(HUMAN, 30), not in_c, seed=-1)
    assert outcome.iterations.max() > 4
    np.testing.assert_allclose(outcome.q, other.q, atol=1e-8)


def test_progress_is_told_and_can_stop() -> None:
    targets = reachable(EHMCS, 200)
    for start, workers in ((None, 1), (middle(EHMCS, 200), 1), (middle(EHMCS, 200), 2)):
        told: list[Progress] = []
        run(EHMCS, targets, LmOptions(), start, workers=workers, progress=told.append)
        assert [p.iteration for p in told] == [64, 128, 192, 200] or workers == 2
        assert told[-1].iteration == 200

        def stop(_: object) -> None:
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            run(EHMCS, targets, LmOptions(), start, workers=workers, progress=stop)


def test_no_samples_and_wrong_shapes() -> None:
    nothing = HandTargets(Orientation.FULL, np.empty((0, 12)))
    for in_c in (True, False):
        assert run(EHMCS, nothing, LmOptions(), in_c=in_c).q.shape == (0, 7)
    for start in (np.zeros(6), np.zeros((2, 7)), np.zeros(())):
        with pytest.raises(ShapeError, match="start has shape"):
            run(EHMCS, reachable(EHMCS, 3), LmOptions(), start)


BAD: list[tuple[type, dict[str, object], str]] = [
    (method, bad, text)
    for method in METHODS
    for bad, text in (
        ({"tolerance": 0}, "tolerance is 0"),
        ({"tolerance": np.nan}, "tolerance is nan"),
        ({"damping": -1.0}, "damping is -1.0"),
        ({"rotation_weight": np.inf}, "rotation_weight is inf"),
        ({"max_iterations": 0}, "max_iterations is 0, expected a whole number ≥ 1"),
        ({"max_iterations": 10**7}, "at most 1,000,000"),
        ({"max_iterations": 2.5}, "max_iterations is 2.5"),
        ({"restarts": -1}, "restarts is -1"),
        ({"residual": "wrong"}, "valid are corrected, printed"),
        ({"position_tolerance": 0}, "position_tolerance is 0"),
        ({"orientation": "pointing"}, "valid are full, none"),
    )
] + [
    (LmOptions, {"increase": 1.0}, "increase is 1.0, expected a finite number > 1"),
    (LmOptions, {"increase": np.inf}, "increase is inf"),
    (LmOptions, {"decrease": 1.0}, "decrease is 1.0, expected a number between 0 and 1"),
    (LmOptions, {"decrease": "x"}, "decrease is 'x'"),
    (LmOptions, {"constant_damping": -1e-9}, "constant_damping is -1e-09"),
]


@pytest.mark.parametrize(("method", "bad", "text"), BAD)
def test_options_that_make_no_sense(method: Callable[..., object], bad: dict[str, object], text: str) -> None:
    with pytest.raises(OptionError) as caught:
        method(**bad)
    assert text in str(caught.value)
