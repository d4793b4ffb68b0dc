"""The loops of the swivel angle in C: against NumPy, at singularities and limits, and as clean C."""

from __future__ import annotations

import ctypes
import subprocess
import warnings

import numpy as np
import pytest
from compiled_helpers import CC, STRICT, build_strictly, needs_cc
from hypothesis import given, settings
from hypothesis import strategies as st
from spherical_arms import ARMS, anywhere, apart, poses

from armik_sym.arm import Arm
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.compiled import backend as backends
from armik_sym.compiled import compiler
from armik_sym.errors import CompilerError, CompilerWarning, OptionError, ShapeError
from armik_sym.swivel import library as swivel_library_module
from armik_sym.swivel.blocking import blocking
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.c_intervals import MOST_INTERVALS
from armik_sym.swivel.closed_form import SwivelCurve, pose_curve, position_curve
from armik_sym.swivel.evaluate import evaluate
from armik_sym.swivel.expressions import swivel_functions
from armik_sym.swivel.intervals import FeasibleIntervals, feasible_intervals, intervals_of_curves
from armik_sym.swivel.library import swivel_library, swivel_source
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise

pytestmark = needs_cc

SPHERICAL = {name: recognise(arm) for name, arm in ARMS.items()}
SIZES = {name: function.numel_out(0) for name, function in swivel_functions().items()}
# Other ways through the C: no vectors at all, and vectors of another width.
NO_VECTORS = ("#if (defined(__GNUC__)", "#if 0 && (defined(__GNUC__)")


def narrowed(arm: Arm, rng: np.random.Generator) -> Arm:
    centre = rng.uniform(arm.rom.lower, arm.rom.upper)
    half = arm.rom.width * rng.uniform(0.05, 0.5)
    return arm.with_rom(np.maximum(arm.rom.lower, centre - half), np.minimum(arm.rom.upper, centre + half))


def curves_of(arm: Arm, q: np.ndarray) -> tuple[SwivelCurve, SwivelCurve]:
    spherical, pose = recognise(arm), poses(arm, q)
    return pose_curve(spherical, *pose, 1), pose_curve(spherical, *pose, -1)


def assert_same(one: FeasibleIntervals, other: FeasibleIntervals, within: float = 1e-12) -> None:
    np.testing.assert_array_equal(one.sample, other.sample)
    np.testing.assert_array_equal(one.branch, other.branch)
    np.testing.assert_array_equal(one.empty, other.empty)
    np.testing.assert_array_equal(one.branches, other.branches)
    np.testing.assert_allclose(one.start, other.start, rtol=0, atol=within)
    np.testing.assert_allclose(one.end, other.end, rtol=0, atol=within)


@pytest.mark.parametrize("flags", [("-O2",), ("-O3", "-march=native")], ids=" ".join)
@pytest.mark.parametrize("vectors", [True, False], ids=["vectors", "one by one"])
def test_the_library_is_clean_c(flags, vectors, tmp_path):
    source = swivel_source() if vectors else swivel_source().replace(*NO_VECTORS)
    assert vectors or source != swivel_source()
    file = tmp_path / "library.c"
    file.write_text(source, encoding="ascii")
    command = [CC, *STRICT, *flags, "-fPIC", "-c", str(file), "-o", str(tmp_path / "library.o")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:2000]


@pytest.mark.parametrize("name", ARMS)
def test_generated_functions_give_what_the_virtual_machine_gives(name):
    spherical, q = SPHERICAL[name], anywhere(300, 1)
    position, rotation = poses(ARMS[name], q)
    for side in (1, -1):
        one = pose_curve(spherical, position, rotation, side, backend="c")
        other = pose_curve(spherical, position, rotation, side, backend="vm")
        for key in ("elbow", "parts", "shortfall", "off_line", "reference_sine"):
            np.testing.assert_allclose(getattr(one, key), getattr(other, key), rtol=0, atol=1e-12)
    one, other = (swivel_of_postures(spherical, q, backend=b) for b in ("c", "vm"))
    np.testing.assert_allclose(one.psi, other.psi, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(one.shoulder, other.shoulder)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("rounds", range(4))
def test_intervals_are_those_of_numpy(name, rounds):
    rng = np.random.default_rng(100 + rounds)
    arm = ARMS[name] if rounds == 0 else narrowed(ARMS[name], rng)
    beyond = 0.2 * rounds
    curves = curves_of(arm, rng.uniform(arm.rom.lower - beyond, arm.rom.upper + beyond, (150, 7)))
    one = intervals_of_curves(curves, backend="c")
    assert len(one.start) > 5
    assert_same(one, intervals_of_curves(curves, backend="vm"))
    order = np.lexsort((one.start, one.branch, one.sample))
    np.testing.assert_array_equal(order, np.arange(len(order)))
    per_branch = np.bincount(one.sample * 8 + one.branch)
    assert per_branch.max() <= MOST_INTERVALS


@pytest.mark.parametrize("name", ["human", "odd_modified"])
def test_whole_call_in_c_and_in_numpy(name):
    arm, rng = ARMS[name], np.random.default_rng(7)
    position, rotation = poses(arm, arm.rom.random_postures(rng, 60))
    reference = rng.normal(size=(60, 3))
    one, other = (
        feasible_intervals(SPHERICAL[name], position, rotation, reference, backend=b) for b in ("c", "vm")
    )
    assert_same(one, other, 1e-10)


def test_many_samples_pass_in_blocks_and_single_ones_and_none_too():
    arm, rng = human(), np.random.default_rng(8)
    curves = curves_of(arm, arm.rom.random_postures(rng, 2500))
    many = intervals_of_curves(curves, backend="c")
    chosen = [0, 1023, 1024, 2499]
    few = intervals_of_curves((curves[0].rows(chosen), curves[1].rows(chosen)), backend="c")
    for i, k in enumerate(chosen):
        for branch in range(8):
            np.testing.assert_array_equal(few.of(i, branch), many.of(k, branch))
    for count in (0, 1):
        rows = range(count)
        part = (
            curves[0].rows(list(rows) if count else np.zeros(0, int)),
            curves[1].rows(list(rows) if count else np.zeros(0, int)),
        )
        assert_same(intervals_of_curves(part, backend="c"), intervals_of_curves(part, backend="vm"))


def test_whole_circles_locked_joints_and_one_joint_without_limits():
    q = np.random.default_rng(9).uniform(-1, 1, (30, 7))
    free = ehmcs().with_rom(np.full(7, -np.pi), np.full(7, np.pi))
    everywhere = intervals_of_curves(curves_of(free, q), backend="c")
    assert len(everywhere.start) == 240
    np.testing.assert_array_equal(everywhere.start, -np.pi)
    np.testing.assert_array_equal(everywhere.end, np.pi)
    for joint in (0, 1, 2, 4, 5, 6):
        lower, upper = np.full(7, -np.pi), np.full(7, np.pi)
        lower[joint], upper[joint] = -0.7, 0.9
        curves = curves_of(ehmcs().with_rom(lower, upper), q)
        assert_same(intervals_of_curves(curves, backend="c"), intervals_of_curves(curves, backend="vm"))
        lower[joint] = upper[joint] = 0.2
        locked = q.copy()
        locked[:, joint] = 0.2
        curves = curves_of(ehmcs().with_rom(lower, upper), locked)
        one, other = (intervals_of_curves(curves, backend=b) for b in ("c", "vm"))
        np.testing.assert_array_equal(one.empty, other.empty)
        assert not one.empty.all(axis=1).any()
        assert (one.end - one.start).max() < 1e-7
        assert apart(one.start, other.start).max() < 1e-7


@pytest.mark.parametrize("aside", [0.0, np.pi, 1.0])
@pytest.mark.parametrize("name", ["ehmcs", "human", "alfaiz"])
def test_straight_arm_where_outer_axes_are_parallel_for_every_angle(name, aside):
    arm, spherical = ARMS[name], SPHERICAL[name]
    lower, upper = arm.rom.middle - 0.4 * arm.rom.width, arm.rom.middle + 0.4 * arm.rom.width
    lower[[1, 3]], upper[[1, 3]] = -np.pi, np.pi
    tight = arm.with_rom(lower, upper)
    q = np.tile(arm.rom.middle, (20, 1)) + np.random.default_rng(10).uniform(-0.1, 0.1, (20, 7))
    q[:, 1], q[:, 3] = aside - spherical.shoulder.offset, 0.0
    curves = curves_of(tight, q)
    one, other = (intervals_of_curves(curves, backend=b) for b in ("c", "vm"))
    assert len(one.start)
    assert_same(one, other)


nearly = st.sampled_from([0.0, 1e-17, 1e-15, 3e-14, 1e-12, 1e-9, 1e-6, 1e-3])


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(list(ARMS)), st.tuples(nearly, nearly, nearly), st.booleans(), st.integers(0, 10**6))
def test_near_singularities_both_ways_agree_on_every_arc_that_has_a_length(name, off, half_turns, seed):
    """Where a joint only touches its limit, rounding decides whether there is an interval of length 1e-7."""
    rng = np.random.default_rng(seed)
    arm, spherical = ARMS[name], SPHERICAL[name]
    q = arm.rom.random_postures(rng, 1)
    turn = np.pi if half_turns else 0.0
    q[0, 1] = off[0] + turn - spherical.shoulder.offset
    q[0, 3] = off[1]
    q[0, 5] = off[2] + turn - spherical.wrist.offset
    curves = curves_of(arm, q)
    found = [intervals_of_curves(curves, backend=b) for b in ("c", "vm")]
    psi = rng.uniform(-np.pi, np.pi, 400)
    for branch in range(8):
        covered, near = [], np.zeros(len(psi), dtype=bool)
        for intervals in found:
            mine = intervals.of(0, branch)
            inside = np.zeros(len(psi), dtype=bool)
            for start, end in mine:
                for shift in (0.0, 2 * np.pi):
                    inside |= (psi + shift >= start) & (psi + shift <= end)
                near |= (apart(psi, start) < 1e-6) | (apart(psi, end) < 1e-6)
            covered.append(inside)
        np.testing.assert_array_equal(covered[0][~near], covered[1][~near])


def test_positions_in_c_are_those_of_numpy():
    for name in ("human", "odd_standard"):
        arm, spherical = ARMS[name], SPHERICAL[name]
        q = arm.rom.random_postures(np.random.default_rng(12), 80)
        position, _ = poses(arm, q)
        curves = tuple(position_curve(spherical, position, q[:, 4:], e) for e in (1, -1))
        one, other = (intervals_of_curves((curves[0], curves[1]), backend=b) for b in ("c", "vm"))
        assert one.branches.shape == (4, 3)
        assert_same(one, other)
        psi = np.random.default_rng(13).uniform(-np.pi, np.pi, 80)
        for side in (1, -1):
            q_c, q_vm = (curves[0].postures(psi, side, backend=b).q for b in ("c", "vm"))
            np.testing.assert_allclose(q_c, q_vm, rtol=0, atol=1e-11)
            np.testing.assert_array_equal(q_c[:, 4:], q[:, 4:])


@pytest.mark.parametrize("dof", [4, 5])
def test_arms_without_a_wrist(dof):
    arm = ehmcs(dof)
    q = arm.rom.random_postures(np.random.default_rng(14), 20)
    position, _ = poses(arm, q)
    curves = tuple(position_curve(recognise(arm), position, q[:, 4:], e) for e in (1, -1))
    one, other = (intervals_of_curves((curves[0], curves[1]), backend=b) for b in ("c", "vm"))
    assert_same(one, other)
    q_c, q_vm = (curves[0].postures(0.3, backend=b).q for b in ("c", "vm"))
    np.testing.assert_allclose(q_c, q_vm, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", ARMS)
def test_blocking_in_c_is_that_of_numpy(name):
    rng = np.random.default_rng(19)
    for _ in range(2):
        arm = narrowed(ARMS[name], rng)
        q = rng.uniform(arm.rom.lower - 0.6, arm.rom.upper + 0.6, (15, 7))
        intervals = intervals_of_curves(curves_of(arm, q))
        everyone = np.arange(15)
        for branch in (None, 0, 6):
            one, other = (blocking(intervals, everyone, branch, backend=b) for b in ("c", "vm"))
            np.testing.assert_allclose(one.missing, other.missing, rtol=0, atol=2e-10)
            np.testing.assert_array_equal(one.shortfall, other.shortfall)
            assert (one.joint == other.joint).mean() > 0.9
            if branch is not None:
                np.testing.assert_array_equal(one.branch, branch)
            assert (one.psi >= -np.pi).all()
            assert (one.psi < np.pi).all()
            q_there = postures_at(intervals.curves, everyone, one.branch, one.psi).q
            margin = arm.rom.margin(q_there)
            np.testing.assert_allclose(-margin.min(axis=1), one.missing, atol=1e-9)
            np.testing.assert_allclose(-margin[everyone, one.joint], one.missing, atol=2e-8)


def test_blocking_of_positions():
    arm = human().with_rom(human().rom.lower + 0.3, human().rom.upper - 0.3)
    spherical = recognise(arm)
    q = human().rom.random_postures(np.random.default_rng(20), 30)
    position, _ = poses(arm, q)
    curves = tuple(position_curve(spherical, position, q[:, 4:], e) for e in (1, -1))
    intervals = intervals_of_curves((curves[0], curves[1]))
    one, other = (blocking(intervals, range(30), backend=b) for b in ("c", "vm"))
    np.testing.assert_allclose(one.missing, other.missing, rtol=0, atol=2e-10)
    assert (one.joint < 4).all()


def test_poses_that_are_no_numbers_have_no_interval_and_say_so():
    position, rotation = poses(human(), human().rom.middle[None])
    for backend in ("c", "vm"):
        intervals = feasible_intervals(recognise(human()), np.full((1, 3), np.nan), rotation, backend=backend)
        assert intervals.empty.all()
        assert not len(intervals.start)
        assert np.isnan(intervals.curves[0].shortfall).all()
    far = feasible_intervals(recognise(alfaiz()), position + 5.0, rotation)
    assert far.empty.all()
    assert blocking(far).shortfall[0] > 4


def test_rows_may_lie_apart_or_be_all_the_same():
    rng = np.random.default_rng(21)
    Q, side, pole = rng.normal(size=(9, 9)), np.ones(1), np.array([1.0, 0.0])
    plain = evaluate("swivel_sides", Q, side, pole, backend="c")
    wide = np.zeros((18, 12))
    wide[::2, :9] = Q
    for rows in (wide[::2, :9], np.asfortranarray(Q), Q[::-1].copy()[::-1]):
        np.testing.assert_array_equal(evaluate("swivel_sides", rows, side, pole, backend="c"), plain)
    same = evaluate("swivel_sides", np.broadcast_to(Q[0], (4, 9)), side, pole, backend="c")
    np.testing.assert_array_equal(same, np.tile(plain[0], (4, 1)))
    for backend in ("c", "vm"):
        assert evaluate("swivel_sides", Q[:0], side, pole, backend=backend).shape == (
            0,
            SIZES["swivel_sides"],
        )
    with pytest.raises(ValueError, match="rows"):
        evaluate("swivel_sides", Q, np.ones((3, 1)), pole, backend="c")


def test_wrong_places_are_refused_before_c_sees_them():
    curves = curves_of(human(), np.tile(human().rom.middle, (3, 1)))
    intervals = intervals_of_curves(curves)
    for sample, branch, psi in (
        ([3], [0], [0.0]),
        ([-1], [0], [0.0]),
        ([0], [8], [0.0]),
        ([0], [-1], [0.0]),
        ([0.5], [0], [0.0]),
        ([0], [0, 1], [0.0]),
        (0, 0, 0.0),
    ):
        with pytest.raises(ShapeError):
            postures_at(curves, sample, branch, psi)
    with pytest.raises(ShapeError, match="wish"):
        postures_at(curves, [0, 1], 0, 0.0, np.zeros((3, 7)))
    with pytest.raises(ShapeError, match="wish"):
        curves[0].postures(0.0, wish=np.zeros((3, 6)))
    with pytest.raises(ShapeError, match="samples"):
        blocking(intervals, [3])
    with pytest.raises(OptionError, match="branch"):
        blocking(intervals, branch=8)
    with pytest.raises(OptionError, match="backend"):
        intervals_of_curves(curves, backend="fortran")
    assert postures_at(curves, np.zeros(0, int), 0, 0.0).q.shape == (0, 7)


def test_without_a_compiler_one_warning_and_the_same_answers(monkeypatch):
    curves = curves_of(human(), np.tile(human().rom.middle, (2, 1)))
    expected = intervals_of_curves(curves, backend="vm")

    def forget() -> None:
        swivel_library.cache_clear()
        backends.warn_once.cache_clear()
        compiler._find.cache_clear()

    forget()
    try:
        with monkeypatch.context() as patch:
            patch.setattr(swivel_library_module, "build_or_none", _no_compiler)
            with warnings.catch_warnings(record=True) as seen:
                warnings.simplefilter("always")
                assert_same(intervals_of_curves(curves), expected, 0.0)
                np.testing.assert_allclose(curves[0].postures(0.1).q, curves[0].postures(0.1, backend="vm").q)
                blocking(expected, [0])
            assert [w.category for w in seen] == [CompilerWarning]
            with pytest.raises(CompilerError):
                intervals_of_curves(curves, backend="c")
    finally:
        forget()


def _no_compiler(source: str, backend: backends.Backend) -> None:
    if backend == "c":
        raise CompilerError("no C compiler found")
    backends.warn_once("no C compiler found")


@pytest.mark.parametrize("flags", [("-DWIDE",), ("-mavx2",), ("-mno-avx", "-msse2")], ids=" ".join)
def test_other_widths_of_vectors_give_the_same(flags, tmp_path, monkeypatch):
    """-DWIDE stands for no vectors at all: what other compilers and processors run."""
    source = swivel_source().replace(*NO_VECTORS) if flags == ("-DWIDE",) else swivel_source()
    try:
        (tmp_path / "trial").mkdir()
        build_strictly("int nothing = 0;", tmp_path / "trial", *flags)
    except AssertionError:
        pytest.skip("this compiler does not know these vectors")
    handle = build_strictly(source, tmp_path, *flags)
    arm, rng = narrowed(human(), np.random.default_rng(22)), np.random.default_rng(23)
    curves = curves_of(arm, rng.uniform(arm.rom.lower - 0.1, arm.rom.upper + 0.1, (60, 7)))
    plain = intervals_of_curves(curves, backend="vm")
    k = 77
    places = rng.integers(0, 60, k), rng.integers(0, 8, k), rng.uniform(-3, 3, k)
    q = postures_at(curves, *places, backend="vm").q
    blocked = blocking(plain, range(60), backend="vm").missing
    other = _Loaded(handle)
    for module in ("intervals", "postures_at", "blocking"):
        monkeypatch.setattr(f"armik_sym.swivel.{module}.swivel_library", lambda _: other)
    assert len(plain.start) > 20
    assert_same(intervals_of_curves(curves), plain)
    np.testing.assert_allclose(postures_at(curves, *places).q, q, rtol=0, atol=1e-11)
    np.testing.assert_allclose(blocking(plain, range(60)).missing, blocked, rtol=0, atol=2e-10)


class _Loaded:
    def __init__(self, handle: ctypes.CDLL) -> None:
        self.handle = handle
