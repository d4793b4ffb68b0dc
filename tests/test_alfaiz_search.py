"""The search of Al-Faiz: inside the range of motion whenever possible, in C and in NumPy."""

from __future__ import annotations

import itertools
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from alfaiz_poses import (
    WITHOUT_COMPILER,
    compiled,
    everywhere_arm,
    narrow_arm,
    poses,
    source,
    targets,
    tight_arm,
)
from compiled_helpers import CC, STRICT, build_strictly, caller, needs_cc

from armik_sym.arm.catalog import alfaiz, ehmcs
from armik_sym.compiled.c_source import c_function
from armik_sym.compiled.hand_written import loop_text
from armik_sym.errors import OptionError, ShapeError
from armik_sym.pointwise.alfaiz import AlfaizOptions, run_alfaiz
from armik_sym.pointwise.alfaiz.closed_form import postures_at
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import pointwise_functions
from armik_sym.symbolic import Orientation
from armik_sym.symbolic.alfaiz_closed_form import search_functions

ARMS = {"default": alfaiz, "narrow": narrow_arm, "tight": tight_arm, "everywhere": everywhere_arm}
HULLS = range(10)
MARGIN = AlfaizOptions(prefer="margin")


def run(arm, goal, options=MARGIN, start=None, library=None, **keywords):
    return run_alfaiz(arm, goal, options, start=start, library=library or compiled(), **keywords)


def error(arm, q, goal):
    return np.abs(poses(arm, q) - goal.pose).max(axis=1)


def smooth_motion(arm, n=1500, seed=0):
    """Joint angles of a slow, smooth motion inside the range of motion."""
    rng = np.random.default_rng(seed)
    t, phase = np.linspace(0, 4, n)[:, None], rng.uniform(0, 6, (3, 7))
    waves = sum(np.sin(2 * np.pi * (k + 1) * 0.15 * t + phase[k]) / (k + 1) for k in range(3))
    return arm.rom.middle + 0.25 * np.minimum(arm.rom.width, 2.0) * waves


@pytest.mark.parametrize("name", ARMS)
def test_reachable_poses_are_reached_inside_the_range_of_motion(name):
    arm = ARMS[name]()
    goal = targets(arm, arm.rom.random_postures(np.random.default_rng(0), 2000))
    found = run(arm, goal)
    assert found.reached.all()
    assert error(arm, found.q, goal).max() < 1e-9
    assert (found.q >= arm.rom.lower).all()
    assert (found.q <= arm.rom.upper).all()


def feasible_by_dense_scan(arm, goal, count=400):
    """Best margin of every pose over a dense scan of φ and all branches."""
    phi = np.linspace(-np.pi, np.pi, count, endpoint=False)
    best = np.full(len(goal), -np.inf)
    for i, pose in enumerate(goal.pose):
        position, rotation = np.tile(pose[:3], (count, 1)), np.tile(pose[3:], (count, 1))
        for sides in itertools.product((1, -1), repeat=3):
            q, exists = postures_at(arm, position, rotation, phi, sides)
            q = q + 2 * np.pi * np.round((arm.rom.middle - q) / (2 * np.pi))
            margin = arm.rom.margin(q).min(axis=1)
            best[i] = max(best[i], margin[exists].max(initial=-np.inf))
    return best


@pytest.mark.parametrize("name", ["default", "narrow"])
def test_no_dense_scan_over_phi_finds_more(name):
    """Random poses of the arm, whether or not they can be reached inside the range of motion."""
    arm = ARMS[name]()
    goal = targets(arm, everywhere_arm().rom.random_postures(np.random.default_rng(1), 80))
    found, best = run(arm, goal), feasible_by_dense_scan(arm, goal)
    assert 2 < (best > 0).sum() < 75
    assert found.reached[best > 0].all()
    margin = arm.rom.margin(found.q).min(axis=1)
    assert np.mean(margin[found.reached] >= best[found.reached] - 0.01) > 0.9


@pytest.mark.parametrize("joint", [0, 1, 2, 4, 5, 6])
def test_single_postures_at_a_locked_joint_are_found(joint):
    rng = np.random.default_rng(joint)
    for q in rng.uniform(-1.3, 1.3, (20, 7)):
        q[3] = abs(q[3]) + 0.1
        lower, upper = q - rng.uniform(0, 1, 7), q + rng.uniform(0, 1, 7)
        lower[joint] = upper[joint] = q[joint]
        arm = alfaiz().with_rom(lower, upper)
        goal = targets(arm, q[None])
        for start in (None, q):
            found = run(arm, goal, AlfaizOptions(), start)
            assert found.reached.all()
            assert found.q[0, joint] == q[joint]


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("prefer", ["margin", "nearest"])
def test_c_and_numpy_decide_alike(name, prefer):
    arm, options = ARMS[name](), AlfaizOptions(prefer=prefer)
    rng = np.random.default_rng(2)
    goal = targets(arm, arm.rom.random_postures(rng, 12))
    goal.pose[3] = np.nan
    goal.pose[4, :3] *= 10
    goal.pose[5, :3] = 0
    goal.pose[6:9] = poses(arm, everywhere_arm().rom.random_postures(rng, 3))
    starts = (None, arm.rom.random_postures(rng, 12)) if prefer == "nearest" else (None,)
    for start in starts:
        one = run(arm, goal, options, start)
        other = run(arm, goal, options, start, WITHOUT_COMPILER)
        np.testing.assert_allclose(other.q, one.q, rtol=0, atol=1e-9)
        np.testing.assert_array_equal(other.reached, one.reached)
        np.testing.assert_array_equal(other.iterations, one.iterations)


@pytest.mark.parametrize("name", ["default", "narrow", "tight"])
@pytest.mark.parametrize("seed", range(3))
def test_a_smooth_motion_is_followed_smoothly(name, seed):
    arm = ARMS[name]()
    q = smooth_motion(arm, seed=seed)
    assert arm.rom.margin(q).min() > 0
    goal = targets(arm, q)
    found = run(arm, goal, AlfaizOptions(), q[0])
    assert found.reached.all()
    assert error(arm, found.q, goal).max() < 1e-9
    assert arm.rom.margin(found.q).min() >= 0
    step, true = np.abs(np.diff(found.q, axis=0)).max(), np.abs(np.diff(q, axis=0)).max()
    assert step < 5 * true
    assert np.abs(found.q[0] - q[0]).max() < 1e-9


def hull_of_a_motion(seed):
    """A smooth motion, and the arm with hardly more range than the motion needs."""
    rng, rom, t = np.random.default_rng(seed), alfaiz().rom, np.linspace(0, 4, 400)
    waves = np.sin(np.outer(t, rng.uniform(0.2, 1.5, 7)) + rng.uniform(0, 2 * np.pi, 7))
    q = rom.middle + 0.45 * rom.width * waves
    lower, upper = np.maximum(rom.lower, q.min(0) - 0.02), np.minimum(rom.upper, q.max(0) + 0.02)
    return alfaiz().with_rom(lower, upper), q


def nearest_by_dense_scan(arm, pose, before, count=3000):
    """Distance of the nearest posture inside the range of motion over a dense scan of φ and all branches."""
    phi, nearest = np.linspace(-np.pi, np.pi, count, endpoint=False), np.inf
    position, rotation = np.tile(pose[:3], (count, 1)), np.tile(pose[3:], (count, 1))
    for sides in itertools.product((1, -1), repeat=3):
        q, exists = postures_at(arm, position, rotation, phi, sides)
        for wish in (before, arm.rom.middle):
            turned = q + 2 * np.pi * np.round((wish - q) / (2 * np.pi))
            good = exists & (arm.rom.margin(turned).min(axis=1) >= 0)
            nearest = min(nearest, np.linalg.norm(turned[good] - before, axis=1).min(initial=np.inf))
    return nearest


@pytest.mark.parametrize("seed", HULLS)
def test_no_dense_scan_over_phi_finds_a_nearer_posture(seed):
    """The largest steps along a motion in a range that hardly leaves room for it."""
    arm, q = hull_of_a_motion(seed)
    goal = targets(arm, q)
    found = run(arm, goal, AlfaizOptions(), q[0])
    assert found.reached.all()
    steps = np.linalg.norm(np.diff(found.q, axis=0), axis=1)
    for i in np.argsort(-steps)[:4]:
        assert steps[i] <= nearest_by_dense_scan(arm, goal.pose[i + 1], found.q[i]) + 0.01


def test_each_pose_by_itself_is_no_smooth_path():
    arm = narrow_arm()
    q = smooth_motion(arm)
    found = run(arm, targets(arm, q))
    assert found.reached.all()
    assert arm.rom.margin(found.q).min() > arm.rom.margin(run(arm, targets(arm, q), AlfaizOptions()).q).min()


def test_independent_samples_stay_near_their_own_start():
    arm = everywhere_arm()
    q = 0.9 * arm.rom.random_postures(np.random.default_rng(3), 500)
    found = run(arm, targets(arm, q), AlfaizOptions(), q + 1e-3)
    assert found.reached.all()
    assert np.median(np.abs(found.q - q).max(axis=1)) < 3e-3


def test_blocks_change_nothing():
    arm, q = narrow_arm(), smooth_motion(narrow_arm(), 200)
    goal = targets(arm, q)
    for start in (None, q[0], q):
        whole = run(arm, goal, AlfaizOptions(), start)
        parts = run(arm, goal, AlfaizOptions(), start, block=7)
        np.testing.assert_array_equal(whole.q, parts.q)


def test_progress_counts_samples():
    arm, told = alfaiz(), []
    goal = targets(arm, smooth_motion(arm, 20))
    run(arm, goal, block=8, progress=lambda report: told.append(report.iteration))
    assert told == [8, 16, 20]


@pytest.mark.parametrize("library", [compiled, lambda: WITHOUT_COMPILER])
@pytest.mark.parametrize("start", [None, np.full(7, 0.1)])
def test_targets_nobody_can_reach_are_reported(library, start):
    arm = narrow_arm()
    goal = targets(arm, arm.rom.random_postures(np.random.default_rng(4), 9))
    goal.pose[1] = np.nan
    goal.pose[2, 4] = np.inf
    goal.pose[3, :3] = (0.5, 0.5, 0.5)
    goal.pose[4] = 0
    goal.pose[5] = 1e300
    goal.pose[6, :3] = 1e-200
    found = run(arm, goal, AlfaizOptions(), start, library())
    np.testing.assert_array_equal(found.reached, [True, *6 * [False], True, True])
    assert np.isfinite(found.q).all()
    assert (found.q >= arm.rom.lower).all()
    assert (found.q <= arm.rom.upper).all()


def test_outside_the_range_of_motion_the_least_violation_is_returned():
    arm = tight_arm()
    q = np.deg2rad([[0.0, 0, 0, 31, 0, 0, 0]])
    found = run(arm, targets(arm, q))
    assert not found.reached[0]
    assert found.q[0, 3] == arm.rom.upper[3]
    np.testing.assert_array_less(error(arm, found.q, targets(arm, q)), 0.05)


@pytest.mark.parametrize("library", [compiled, lambda: WITHOUT_COMPILER])
def test_the_other_turn_of_a_joint_is_used(library):
    """A range beyond half a turn: 200° is the same as -160°, which lies outside."""
    arm = alfaiz().with_rom(
        np.deg2rad([90, -90, -90, 0, -90, -90, -90]), np.deg2rad([270, 90, 90, 145, 90, 90, 90])
    )
    q = np.deg2rad([[200.0, 10, -20, 60, 30, 20, -40]])
    found = run(arm, targets(arm, q), AlfaizOptions(), q[0] + 0.01, library())
    assert found.reached[0]
    assert np.abs(found.q - q).max() < 0.02


def test_printed_equations_miss_poses_the_corrected_ones_reach():
    arm = alfaiz()
    goal = targets(arm, arm.rom.random_postures(np.random.default_rng(5), 100))
    found = run(arm, goal, AlfaizOptions(search="printed"))
    assert 0.1 < found.reached.mean() < 0.8
    assert np.isfinite(found.q).all()
    assert (found.q >= arm.rom.lower).all()
    assert (found.q <= arm.rom.upper).all()
    assert error(arm, found.q, goal)[found.reached].max() < 1e-8
    assert error(arm, found.q, goal)[~found.reached].max() > 0.1


def test_what_does_not_fit_is_refused():
    arm = alfaiz()
    goal = targets(arm, np.zeros((2, 7)))
    with pytest.raises(OptionError, match=r"'ehmcs' has others.*lm"):
        run(ehmcs(), goal)
    with pytest.raises(OptionError, match="needs the rotation"):
        run(arm, HandTargets(Orientation.NONE, goal.pose))
    with pytest.raises(ShapeError, match=r"\(3, 7\), expected \(7,\), or \(2, 7\)"):
        run(arm, goal, start=np.zeros((3, 7)))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("search", "exact"),
        ("prefer", "best"),
        ("grid", 3),
        ("grid", 257),
        ("grid", 8.0),
        ("refinements", -1),
        ("near", 0.0),
        ("near", np.nan),
        ("tolerance", -1.0),
        ("position_tolerance", "1"),
    ],
)
def test_options_are_checked(name, value):
    with pytest.raises(OptionError, match=f"{name} is {value!r}"):
        AlfaizOptions(**{name: value})


@needs_cc
@pytest.mark.parametrize("lanes", ["-DLANES=1", "-mavx"])
def test_the_source_is_strict_c99(tmp_path: Path, lanes: str):
    text = source()
    if lanes == "-DLANES=1":
        text, lanes = re.sub(r"#define LANES \d", "#define LANES 1", text), "-O1"
    build_strictly(text, tmp_path, "-Wno-unused-function", lanes)


@needs_cc
def test_the_source_compiles_for_float_without_lanes(tmp_path: Path):
    pose = pointwise_functions(alfaiz())["pose"]
    functions = {"pose": pose, **search_functions()}
    text = "#include <math.h>\n#include <stddef.h>\ntypedef float real;\n#define ONE 1.0f\n#define EXPORT\n"
    text += "#define REAL_IS_FLOAT 1\n" + "".join(
        "static " + c_function(f, f"armik_{name}", "float") for name, f in functions.items()
    )
    signature = (
        "void armik_alfaiz_path(const alfaiz_settings *, ptrdiff_t, const real *, const real *, "
        "const real *, const real *, const real *, int, real *, unsigned char *, int64_t *);\n"
    )
    body = loop_text("alfaiz_curve.h") + loop_text("alfaiz_search.h")
    body = body.replace("EXPORT void", signature + "EXPORT void")
    build_strictly(text + body, tmp_path)


_MAIN = """
#include <stdio.h>
#include <stdlib.h>
int main(void) {
  static double targets[12 * 64], q[7 * 64], starts[7 * 64];
  unsigned char reached[64];
  int64_t evaluations[64];
  const double lengths[2] = {0.30, 0.24}, lower[7] = {-1, -1, -1.5, -0.3, -1.4, -0.7, -0.9};
  const double upper[7] = {1, 1.5, 0.5, 2.4, 1.4, 0.9, 1};
  int found = 0;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 7; ++j)
      starts[7 * i + j] = lower[j] + (upper[j] - lower[j]) * ((double)rand() / RAND_MAX);
  for (int i = 0; i < 64; ++i) armik_pose(starts + 7 * i, lengths, targets + 12 * i);
  for (int j = 0; j < 3; ++j) targets[12 * 9 + j] = j ? 0 : 1e9;
  for (int j = 0; j < 12; ++j) targets[12 * 10 + j] = 0.0 / (double)(j - j);
  for (int grid = 4; grid <= 256; grid += 84)
    for (int nearest = 0; nearest < 2; ++nearest)
      for (int chain = 0; chain < 3; ++chain) {
        const alfaiz_settings settings = {grid, 3, nearest, 0.3, 1e-9};
        const double *start = chain > 1 ? NULL : starts;
        armik_alfaiz_path(&settings, 64, targets, lengths, lower, upper, start, chain > 0, q, reached,
                          evaluations);
        for (int i = 0; i < 64; ++i) found += reached[i];
      }
  printf("%d\\n", found);
  return 0;
}
"""


@needs_cc
def test_sanitizers_find_nothing(tmp_path: Path):
    flags = ["-g", "-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    probe = tmp_path / "probe.c"
    probe.write_text("int main(void) { return 0; }\n")
    command = [str(CC), *flags, "-o", str(tmp_path / "program")]
    if subprocess.run([*command, str(probe)], capture_output=True, check=False).returncode != 0:
        pytest.skip("no sanitizers")
    file = tmp_path / "main.c"
    file.write_text(source() + _MAIN)
    done = subprocess.run(
        [*command, *STRICT[:5], "-Wno-unused-function", str(file), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    ran = subprocess.run([str(tmp_path / "program")], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert int(ran.stdout) == 62 * 4 * 2 * 3


_ARC_TANGENTS = """
void arc_tangents(const double *y, const double *x, double *angle);
void arc_tangents(const double *y, const double *x, double *angle) {
  for (int start = 0; start < %d; start += LANES) {
    lanes a = lanes_of(0.0), b = lanes_of(0.0);
    for (int i = 0; i < LANES; ++i) {
      a[i] = y[start + i];
      b[i] = x[start + i];
    }
    const lanes c = lanes_atan2(a, b);
    for (int i = 0; i < LANES; ++i) angle[start + i] = c[i];
  }
}
"""


@needs_cc
@pytest.mark.parametrize("flag", ["-O1", "-mavx"])
def test_the_arc_tangent_in_lanes_is_that_of_libm(tmp_path: Path, flag: str):
    rng = np.random.default_rng(6)
    special = [0.0, 1.0, -1.0, 0.66, -0.66, 1e-300, -1e-9, np.nan]
    corners = np.array(list(itertools.product(special, special)))
    points = rng.normal(size=(20_000, 2)) * 10.0 ** rng.uniform(-12, 12, (20_000, 2))
    y, x = np.vstack([corners, points]).T
    text = "#include <math.h>\n" + loop_text("lanes.h") + loop_text("lanes_atan2.h") + _ARC_TANGENTS % len(y)
    call = caller(build_strictly(text, tmp_path, "-Wno-unused-function", flag), "arc_tangents", len(y))
    np.testing.assert_allclose(call(y, x), np.arctan2(y, x), rtol=4e-16, atol=0)
