"""The method of Al-Faiz: how often it succeeds, how long it takes, and Table 2 of the paper.

    python benchmarks/alfaiz.py [--poses 10000] [--scanned 300]

Success is compared with a dense scan over φ (4,000 values, all branches); times with generated forward
kinematics and Jacobian measured in the same run, whose ratio says more than microseconds do.
"""

from __future__ import annotations

import argparse
import itertools
import time

import numpy as np

from armik_sym.arm.catalog import alfaiz
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled.backend import build_or_none
from armik_sym.compiled.kinematics import compile as compile_kinematics
from armik_sym.pointwise.alfaiz import AlfaizOptions, run_alfaiz
from armik_sym.pointwise.alfaiz.c_loop import CompiledLoop
from armik_sym.pointwise.alfaiz.closed_form import postures_at
from armik_sym.pointwise.alfaiz.found import Found
from armik_sym.pointwise.alfaiz.printed_loop import PrintedLoop
from armik_sym.pointwise.damped.options import LmOptions, SugiharaOptions
from armik_sym.pointwise.damped.run import run_damped
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import (
    PointwiseLibrary,
    pointwise_functions,
    pointwise_library,
    pointwise_source,
)
from armik_sym.symbolic import Orientation
from armik_sym.symbolic.alfaiz_closed_form import search_functions

_PHI = 4_000
_PAPER_ERRORS = {
    25: (0.6694, 0.6692, 0.0005),
    26: (0.6801, 0.6801, 0.0004),
    27: (0.6937, 0.6933, 0.0004),
    28: (0.7091, 0.7091, 0.0003),
    29: (0.7274, 0.7272, 0.0003),
    30: (0.7477, 0.7474, 0.0003),
}
_TABLE_2_ROTATION = np.array([[0, 0.7071, -0.7071], [0, -0.7071, -0.7071], [-1.0, 0, 0]])


def library() -> PointwiseLibrary:
    """The loop of this method alone."""
    kinematics = pointwise_functions(alfaiz())
    functions = {"pose": kinematics["pose"], **search_functions()}
    source = pointwise_source(functions, 7, loops=("lanes_atan2.h", "alfaiz_curve.h", "alfaiz_search.h"))
    return PointwiseLibrary(build_or_none(source, "c"))


def arms() -> dict[str, Arm]:
    """Ranges of motion: the catalogue's, one as of a person, one as of a patient."""
    narrow = np.deg2rad([[-60, -60, -90, 0, -80, -40, -50], [60, 90, 30, 140, 80, 50, 60]])
    tight = np.deg2rad([[-6, -6, -9, 20, -8, -4, -5], [6, 9, 3, 30, 8, 5, 6]])
    return {"catalogue": alfaiz(), "narrow": alfaiz().with_rom(*narrow), "tight": alfaiz().with_rom(*tight)}


def poses(arm: Arm, q: np.ndarray) -> HandTargets:
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    return HandTargets(Orientation.FULL, np.hstack([position, rotation.reshape(-1, 9)]))


def scan(arm: Arm, goal: HandTargets) -> np.ndarray:
    """Largest margin of every pose over a dense scan of φ and all branches."""
    phi = np.linspace(-np.pi, np.pi, _PHI, endpoint=False)
    best = np.full(len(goal), -np.inf)
    for i, pose in enumerate(goal.pose):
        position, rotation = np.tile(pose[:3], (_PHI, 1)), np.tile(pose[3:], (_PHI, 1))
        for sides in itertools.product((1, -1), repeat=3):
            q, exists = postures_at(arm, position, rotation, phi, sides)
            q = q + 2 * np.pi * np.round((arm.rom.middle - q) / (2 * np.pi))
            best[i] = max(best[i], arm.rom.margin(q).min(axis=1)[exists].max(initial=-np.inf))
    return best


def time_per_pose(arm: Arm, goal: HandTargets, options: AlfaizOptions, compiled: PointwiseLibrary):
    """Microseconds of every pose, each called by itself; the call's own cost subtracted."""
    loop, found = CompiledLoop(compiled.library, arm, options), Found.empty(len(goal))
    times, empty = np.full(len(goal), np.inf), np.full(len(goal), np.inf)
    for i in list(range(len(goal))) * 3:  # the least of three: the machine does other things too
        began = time.perf_counter()
        loop(slice(i, i + 1), goal.pose, None, True, found)
        middle = time.perf_counter()
        loop(slice(i, i), goal.pose, None, True, found)
        end = time.perf_counter()
        times[i], empty[i] = min(times[i], middle - began), min(empty[i], end - middle)
    return 1e6 * np.maximum(times - np.median(empty), 0)


def kinematics_time(arm: Arm, q: np.ndarray) -> float:
    """Microseconds per forward kinematics and Jacobian, postures one after another in C."""
    kinematics, best = compile_kinematics(arm, "c"), np.inf
    for _ in range(9):
        began = time.perf_counter()
        kinematics.pose_and_jacobian(q)
        best = min(best, time.perf_counter() - began)
    return 1e6 * best / len(q)


def random_poses(count: int, scanned: int, compiled: PointwiseLibrary) -> None:
    print(f"{count:,} random reachable poses inside the range of motion, cold start")
    print("range      success  median µs   p99 µs  / FK+J   smallest margin   median margin (of the pose)")
    for name, arm in arms().items():
        q = arm.rom.random_postures(np.random.default_rng(0), count)
        goal = poses(arm, q)
        found = run_alfaiz(arm, goal, AlfaizOptions(prefer="margin"), start=None, library=compiled)
        times = time_per_pose(arm, goal, AlfaizOptions(prefer="margin"), compiled)
        margin = np.rad2deg(arm.rom.margin(found.q).min(axis=1))
        own = np.median(np.rad2deg(arm.rom.margin(q).min(axis=1)))
        print(
            f"{name:10} {100 * found.reached.mean():6.2f}% {np.median(times):9.2f}"
            f" {np.quantile(times, 0.99):9.2f} {np.median(times) / kinematics_time(arm, q):7.0f}"
            f" {margin.min():12.5f}° {np.median(margin):14.2f}° ({own:.2f}°)"
        )
    print(f"\n{scanned} random poses of a fully turning arm: which are inside the range of motion?")
    print(f"range      by a scan of {_PHI:,} φ and 8 branches   of these found   found besides")
    everywhere = alfaiz().with_rom([-np.pi] * 7, [np.pi] * 7)
    for name, arm in arms().items():
        # For the tight range, poses near its edge: random ones would all be outside.
        rng = np.random.default_rng(1)
        q = everywhere.rom.random_postures(rng, scanned)
        if name == "tight":
            q = arm.rom.middle + 0.6 * arm.rom.width * rng.uniform(-1, 1, (scanned, 7))
        goal = poses(arm, q)
        inside = scan(arm, goal) >= 0
        found = run_alfaiz(arm, goal, AlfaizOptions(prefer="margin"), start=None, library=compiled)
        both = (found.reached & inside).sum() / max(inside.sum(), 1)
        print(f"{name:10} {inside.sum():10} {100 * both:34.2f}% {(found.reached & ~inside).sum():12}")


def defaults(compiled: PointwiseLibrary) -> None:
    arm = alfaiz()
    goal = poses(arm, arm.rom.random_postures(np.random.default_rng(2), 5_000))
    print("\ngrid  refinements  success  median µs  mean of the smallest margin")
    for grid, refinements in ((8, 0), (16, 1), (32, 0), (32, 1), (32, 2), (32, 3), (64, 2), (256, 4)):
        options = AlfaizOptions(prefer="margin", grid=grid, refinements=refinements)
        found = run_alfaiz(arm, goal, options, start=None, library=compiled)
        margin = np.rad2deg(arm.rom.margin(found.q).min(axis=1)).mean()
        median = np.median(time_per_pose(arm, goal, options, compiled))
        print(f"{grid:4} {refinements:9} {100 * found.reached.mean():11.2f}% {median:9.2f} {margin:12.3f}°")


def smooth_path(compiled: PointwiseLibrary) -> None:
    print("\n2,000 samples of a smooth motion, from its first posture")
    print("Following is greedy: in a tight range it can run into a dead end and must jump, which 'reached'")
    print("does not show, the largest step does. 'hull' is the range the motion covers, widened by 0.02 rad")
    print("(median of 20 motions over 400 samples).")
    print("range      reached  µs per pose  largest step (of the motion)  smallest margin (of the motion)")
    for name, arm in arms().items():
        t, phase = np.linspace(0, 20, 2000)[:, None], np.random.default_rng(3).uniform(0, 6, (3, 7))
        waves = sum(np.sin(2 * np.pi * (k + 1) * 0.15 * t + phase[k]) / (k + 1) for k in range(3))
        q = arm.rom.middle + 0.25 * np.minimum(arm.rom.width, 2.0) * waves
        goal = poses(arm, q)
        best = np.inf
        for _ in range(5):
            began = time.perf_counter()
            found = run_alfaiz(arm, goal, AlfaizOptions(), start=q[0], library=compiled)
            best = min(best, time.perf_counter() - began)
        step, true = (np.rad2deg(np.abs(np.diff(x, axis=0)).max()) for x in (found.q, q))
        margins = (np.rad2deg(arm.rom.margin(x).min()) for x in (found.q, q))
        print(
            f"{name:10} {100 * found.reached.mean():6.2f}% {1e6 * best / len(q):10.2f}"
            f" {step:16.3f}° ({true:.3f}°)" + "{:18.3f}° ({:.3f}°)".format(*margins)
        )
    steps = []
    for seed in range(20):
        arm, q = hull_of_a_motion(np.random.default_rng(seed))
        began = time.perf_counter()
        found = run_alfaiz(arm, poses(arm, q), AlfaizOptions(), start=q[0], library=compiled)
        each = 1e6 * (time.perf_counter() - began) / len(q)
        largest = [np.rad2deg(np.abs(np.diff(x, axis=0)).max()) for x in (found.q, q)]
        margins = [np.rad2deg(arm.rom.margin(x).min()) for x in (found.q, q)]
        steps.append([100 * found.reached.mean(), each, *largest, *margins])
    row = "hull       {:6.2f}% {:10.2f} {:16.3f}° ({:.3f}°){:18.3f}° ({:.3f}°)"
    print(row.format(*np.median(steps, axis=0)))


def hull_of_a_motion(rng: np.random.Generator) -> tuple[Arm, np.ndarray]:
    """A smooth motion, and the arm with hardly more range than the motion needs."""
    rom, t = alfaiz().rom, np.linspace(0, 4, 400)
    waves = np.sin(np.outer(t, rng.uniform(0.2, 1.5, 7)) + rng.uniform(0, 2 * np.pi, 7))
    q = rom.middle + 0.45 * rom.width * waves
    lower, upper = np.maximum(rom.lower, q.min(0) - 0.02), np.minimum(rom.upper, q.max(0) + 0.02)
    return alfaiz().with_rom(lower, upper), q


def pose_error(arm: Arm, q: np.ndarray, pose: np.ndarray) -> float:
    """|p* - p| in [m] and the angle in [rad] together."""
    p, R = hand_pose(arm.chain, q[None], arm.lengths)
    turn = 2 * np.arcsin(min(1.0, np.linalg.norm(R[0].ravel() - pose[3:]) / np.sqrt(8)))
    return float(np.hypot(np.linalg.norm(p[0] - pose[:3]), turn))


def table_2(compiled: PointwiseLibrary) -> None:
    """Targets at y = 13 cm, z = 23 cm, x = 25 … 30 cm; joints may turn fully: the paper has no limits."""
    arm = alfaiz().with_rom([-np.pi] * 7, [np.pi] * 7)
    print(
        "\nTable 2. The paper gives no segment lengths: upper arm 0.30 m, forearm 0.24 m (catalogue, the\n"
        "averages of Nguyen 2021). The farthest target is |(30, 13, 23)| = 40.0 cm away, of 54 cm.\n"
        "Error: sqrt(|p* - p|² [m²] + angle² [rad²]). R printed with 0.7071 is no rotation by 2e-5;\n"
        "'nearest' takes the nearest rotation instead."
    )
    print("      paper: error              printed search      corrected closed form    time [µs]")
    print("x     LM     Sugihara proposed   as R / nearest      as R / nearest           printed corrected")
    U, _, V = np.linalg.svd(_TABLE_2_ROTATION)
    options = AlfaizOptions(search="printed", grid=256, refinements=6)
    for x, (lm, sugihara, proposed) in _PAPER_ERRORS.items():
        errors, times = [], []
        for R in (_TABLE_2_ROTATION, U @ V):
            pose = np.concatenate([[x / 100, 0.13, 0.23], R.ravel()])
            goal = HandTargets(Orientation.FULL, pose[None])
            loop = PrintedLoop(arm, options)
            loop.best(pose)
            began = time.perf_counter()
            q, _, _ = loop.best(pose)
            times.append(time.perf_counter() - began)
            found = run_alfaiz(arm, goal, AlfaizOptions(prefer="margin"), start=None, library=compiled)
            errors += [pose_error(arm, q, pose), pose_error(arm, found.q[0], pose)]
        corrected = np.median(time_per_pose(arm, HandTargets(Orientation.FULL, np.tile(pose, (200, 1))),
                                            AlfaizOptions(prefer="margin"), compiled))  # fmt: skip
        print(
            f"{x}  {lm:.4f}  {sugihara:.4f}  {proposed:.4f}   {errors[0]:.1e} / {errors[2]:.1e}"
            f"   {errors[1]:.1e} / {errors[3]:.1e}   {1e6 * times[-1]:10.0f} {corrected:9.1f}"
        )
    print("paper: times 0.05 s (LM), 0.1 s (Sugihara), 0.009-0.014 s (proposed)")


def table_2_damped() -> None:
    """The same targets with LM and Sugihara: residual as printed (eq. 51-53), corrected, with restarts."""
    arm = alfaiz().with_rom([-np.pi] * 7, [np.pi] * 7)
    compiled = pointwise_library(arm)
    U, _, V = np.linalg.svd(_TABLE_2_ROTATION)
    print("\nTable 2, LM and Sugihara from mid-range: paper | residual printed, corrected, restarts")
    for x, paper in _PAPER_ERRORS.items():
        pose = np.concatenate([[x / 100, 0.13, 0.23], (U @ V).ravel()])
        goal, cells = HandTargets(Orientation.FULL, pose[None]), []
        for options, theirs in ((LmOptions, paper[0]), (SugiharaOptions, paper[1])):
            errors = []
            for choice in ({"residual": "printed"}, {}, {"restarts": 20}):
                found = run_damped(arm, goal, options(**choice), start=None, seed=0, library=compiled)
                errors.append(pose_error(arm, found.q[0], pose))
            cells.append(f"{theirs:.4f} | " + ", ".join(f"{error:.1e}" for error in errors))
        print(f"{x}  LM {cells[0]}   Sugihara {cells[1]}")
    print(
        "What agrees: nothing much. With the corrected residual both methods reach every target, so errors\n"
        "of 0.67 to 0.75 are no property of them; with the residual as printed (eq. 53) they end half\n"
        "a turn off. The paper tells neither lengths, start, weights of position and rotation, nor stop:\n"
        "its numbers are probably those of an iteration cut short, or pulled sideways by eq. 53. The\n"
        "proposed method reaches the targets with the corrected equations only; 0.0003 to 0.0005 does not\n"
        "follow from the printed ones."
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=10_000)
    parser.add_argument("--scanned", type=int, default=300)
    arguments = parser.parse_args()
    compiled = library()
    random_poses(arguments.poses, arguments.scanned, compiled)
    defaults(compiled)
    smooth_path(compiled)
    table_2(compiled)
    table_2_damped()


if __name__ == "__main__":
    main()
