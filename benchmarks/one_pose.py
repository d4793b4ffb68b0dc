"""One pose from a cold start: success, time, iterations and limits of the one-pose solvers.

Run: OPENBLAS_NUM_THREADS=1 python benchmarks/one_pose.py [--poses 10000] [--tune]

Targets are the poses of random postures inside the range of motion, so every one can be reached. All start
from the middle of the range; with restarts, the further starts are random. A pose counts as found if the
returned posture lies inside the limits and misses it by less than 1e-6 m and 1e-5 rad, computed from the DH
table by code that no solver uses. C solvers are timed pose by pose inside C, the others around one Python
call per pose. `--tune` shows what the defaults of LM and Sugihara were chosen from.
"""

from __future__ import annotations

import argparse
import ctypes
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from kinematics import pinocchio_model
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from armik_sym.arm import Arm
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled import compile
from armik_sym.compiled.backend import build_or_none
from armik_sym.pointwise.damped import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.pose_residual import pose_residual
from armik_sym.pointwise.damped.settings import DampedSettings
from armik_sym.pointwise.library import pointwise_functions, pointwise_source
from armik_sym.symbolic import Orientation

LOOPS = (
    "random_stream.h",
    "real_math.h",
    "small_cholesky.h",
    "pose_residual.h",
    "bounded_step.h",
    "damped_pose.h",
    "damped_path.h",
)
RESTARTS = 20
SLOW = 500  # poses given to solvers that take milliseconds
POSITION_TOLERANCE, ROTATION_TOLERANCE = 1e-6, 1e-5

# One loop per C solver that times every pose; {call} solves pose i.
TIMER_HEAD = """\
#include <time.h>
static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
"""
TIMER = """
EXPORT void time_{name}(const {settings} *settings, ptrdiff_t n, const real *targets, const real *lengths,
                        const real *lower, const real *upper, const real *start, real *q, real *error,
                        int64_t *iterations, int64_t *evaluations, double *seconds) {{
  for (ptrdiff_t i = 0; i < n; ++i) {{
    const double began = now();
    {call};
    seconds[i] = now() - began;
  }}
}}
"""
DAMPED = TIMER.format(
    name="damped",
    settings="damped_settings",
    call="armik_damped_path(settings, 1, (uint64_t)i, 0, targets + 12 * i, lengths, lower, upper, start, 1,"
    " q + i * DOF, error + i, iterations + i, evaluations + i)",
)


@dataclass(frozen=True)
class Answer:
    """What a solver returned: postures (n, dof), iterations (n,) and seconds (n,)."""

    q: np.ndarray
    iterations: np.ndarray
    seconds: np.ndarray


# A row of the table: what solves targets (n, 12), and how many of them it can be given.
Solver = Callable[[np.ndarray], Answer]
Row = tuple[str, Solver, int]


def address(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def timed_library(arm: Arm) -> ctypes.CDLL:
    source = pointwise_source(pointwise_functions(arm), arm.dof, LOOPS)
    library = build_or_none("#define _POSIX_C_SOURCE 199309L\n" + source + TIMER_HEAD + DAMPED, "c")
    if library is None:
        raise SystemExit("this benchmark needs a C compiler")
    return library.handle


def damped(arm: Arm, handle: ctypes.CDLL, options: LmOptions | SugiharaOptions) -> Solver:
    settings = DampedSettings.of(options, Orientation.FULL)
    fixed = (arm.length_values, arm.rom.lower, arm.rom.upper, arm.rom.middle)

    def solve(targets: np.ndarray) -> Answer:
        n = len(targets)
        q, error, seconds = np.empty((n, arm.dof)), np.empty(n), np.empty(n)
        counts = np.empty((2, n), dtype=np.int64)
        out = (q, error, counts[0], counts[1], seconds)
        handle.time_damped(
            ctypes.byref(settings), ctypes.c_ssize_t(n), *(address(a) for a in (targets, *fixed, *out))
        )
        return Answer(q, counts[0], seconds)

    return solve


def pose_by_pose(arm: Arm, one: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, int]]) -> Solver:
    """A Python solver (target, start) → (q, iterations), timed around each call, with restarts if any."""

    def solve(targets: np.ndarray) -> Answer:
        n = len(targets)
        q, iterations, seconds = np.empty((n, arm.dof)), np.empty(n, dtype=np.int64), np.empty(n)
        for i, target in enumerate(targets):
            began = time.perf_counter()
            q[i], iterations[i] = one(target, arm.rom.middle)
            seconds[i] = time.perf_counter() - began
        return Answer(q, iterations, seconds)

    return solve


def pinocchio_rows(arm: Arm) -> Iterator[Row]:
    """Pinocchio's inverse-kinematics example: damped steps of log6, clipped to the limits."""
    try:
        import pinocchio as pin
    except ImportError:
        return
    model, frame = pinocchio_model(arm, pin)
    data, eye = model.createData(), np.eye(6)
    rng = np.random.default_rng(1)

    def attempt(wanted: object, q: np.ndarray) -> tuple[np.ndarray, int, bool]:
        for k in range(100):
            pin.forwardKinematics(model, data, q)
            difference = pin.updateFramePlacement(model, data, frame).actInv(wanted)
            error = pin.log(difference).vector
            if error @ error < 1e-18:
                return q, k, True
            J = -pin.Jlog6(difference.inverse()) @ pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL)
            step = -J.T @ np.linalg.solve(J @ J.T + 1e-6 * eye, error)
            q = np.clip(q + step, arm.rom.lower, arm.rom.upper)
        return q, 100, False

    def solver(restarts: int) -> Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, int]]:
        def one(target: np.ndarray, q0: np.ndarray) -> tuple[np.ndarray, int]:
            wanted = pin.SE3(target[3:].reshape(3, 3), target[:3])
            q, total, found = attempt(wanted, q0)
            for _ in range(0 if found else restarts):
                q, k, found = attempt(wanted, arm.rom.random_postures(rng, 1)[0])
                total += k
                if found:
                    break
            return q, total

        return one

    yield "pinocchio damped, from Python", pose_by_pose(arm, solver(0)), SLOW
    yield f"  {RESTARTS} restarts", pose_by_pose(arm, solver(RESTARTS)), SLOW


def scipy_rows(arm: Arm) -> Iterator[Row]:
    """Bounded least squares of scipy on the same residual and its Jacobian."""
    kin = compile(arm)
    inside = 1e-9 * arm.rom.width  # scipy wants a start strictly inside

    def one(target: np.ndarray, q0: np.ndarray) -> tuple[np.ndarray, int]:
        def residual(q: np.ndarray) -> np.ndarray:
            return pose_residual(target, *kin.pose_and_jacobian(q), 6, 0.3, False)[0]

        def slope(q: np.ndarray) -> np.ndarray:
            return -pose_residual(target, *kin.pose_and_jacobian(q), 6, 0.3, False)[1]

        start = np.clip(q0, arm.rom.lower + inside, arm.rom.upper - inside)
        limits = (arm.rom.lower, arm.rom.upper)
        found = least_squares(residual, start, slope, limits, xtol=1e-12, ftol=1e-12, gtol=1e-12)
        return found.x, found.nfev

    yield "scipy least_squares, bounded", pose_by_pose(arm, one), SLOW // 5


def rows(arm: Arm) -> Iterator[Row]:
    """All solvers, in the order of the table. More solvers: yield more rows."""
    handle, every = timed_library(arm), 10**9
    for title, options in (("LM, Al-Faiz eq. 62", LmOptions), ("Sugihara", SugiharaOptions)):
        yield title, damped(arm, handle, options()), every
        yield f"  {RESTARTS} restarts", damped(arm, handle, options(restarts=RESTARTS)), every
        yield "  residual as printed", damped(arm, handle, options(residual="printed")), every
    yield "  w = 1e-4 m²", damped(arm, handle, SugiharaOptions(damping=1e-4)), every
    yield from pinocchio_rows(arm)
    yield from scipy_rows(arm)


def tuning_rows(arm: Arm) -> Iterator[Row]:
    """Values from which the defaults were chosen."""
    handle, every = timed_library(arm), 10**9
    for damping in (1e-3, 1e-2, 0.1, 1.0):
        for increase, decrease in ((10, 0.1), (4, 0.3), (2, 0.3)):
            options = LmOptions(damping=damping, increase=increase, decrease=decrease)
            yield f"LM μ = {damping:g} ×{increase} ×{decrease}", damped(arm, handle, options), every
    for c in (1e-6, 1e-4, 1e-2):
        yield f"LM c = {c:g}", damped(arm, handle, LmOptions(constant_damping=c)), every
    for w in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10):
        yield f"Sugihara w = {w:g}", damped(arm, handle, SugiharaOptions(damping=w)), every
    for weight in (0.1, 0.2, 0.3, 0.5, 1.0):
        options = SugiharaOptions(rotation_weight=weight)
        yield f"Sugihara L = {weight:g}", damped(arm, handle, options), every


def targets_of(arm: Arm, n: int) -> np.ndarray:
    q = arm.rom.random_postures(np.random.default_rng(0), n)
    p, R = hand_pose(arm.chain, q, arm.lengths)
    return np.hstack([p, R.reshape(n, 9)])


def found_by(arm: Arm, q: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Whether each posture is inside the limits and reaches its pose, shape (n,)."""
    p, R = hand_pose(arm.chain, q, arm.lengths)
    shift = np.linalg.norm(targets[:, :3] - p, axis=1)
    turn = Rotation.from_matrix(targets[:, 3:].reshape(-1, 3, 3) @ R.swapaxes(1, 2)).magnitude()
    inside = ((q >= arm.rom.lower) & (q <= arm.rom.upper)).all(axis=1)
    return inside & (shift < POSITION_TOLERANCE) & (turn < ROTATION_TOLERANCE)


def show(arm: Arm, table: Iterator[Row], targets: np.ndarray) -> None:
    print(f"\n{arm.name}, {len(targets):,} poses")
    print(
        f"{'':32}{'poses':>8}{'found %':>9}{'median µs':>11}{'p99 µs':>9}{'iterations':>12}{'margin °':>11}"
    )
    for title, solve, most in table:
        part = targets[:most].copy()
        solve(part[:20])
        answer = solve(part)
        found = found_by(arm, answer.q, part)
        margin = np.rad2deg(arm.rom.margin(answer.q).min())
        median, p99 = 1e6 * np.percentile(answer.seconds, [50, 99])
        print(
            f"{title:32}{len(part):8}{100 * found.mean():9.2f}{median:11.1f}{p99:9.1f}"
            f"{answer.iterations.mean():12.1f}{margin:11.4f}"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=10_000)
    parser.add_argument("--tune", action="store_true", help="show what the defaults were chosen from")
    wanted = parser.parse_args()
    for arm in (ehmcs(), human(), alfaiz()):
        table = tuning_rows(arm) if wanted.tune else rows(arm)
        show(arm, table, targets_of(arm, wanted.poses))


if __name__ == "__main__":
    main()
