"""The solvers for a controller: they compile strictly, pass their own test, and are those of Python."""

from __future__ import annotations

import ctypes
import functools
import importlib.util
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from compiled_helpers import CC, STRICT, needs_cc
from sample_arms import ARMS, BARE, postures
from typer.testing import CliRunner

from armik_sym import emit_c
from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.cli import app
from armik_sym.compiled.c_definitions import enumeration, struct_members, without_structs
from armik_sym.errors import OptionError
from armik_sym.pointwise.damped import LmOptions, SugiharaOptions, run_damped
from armik_sym.pointwise.damped.settings import DampedSettings
from armik_sym.pointwise.differential_evolution import ProIsadeOptions, run_isade
from armik_sym.pointwise.differential_evolution.compiled_search import IsadeSettings, isade_settings
from armik_sym.pointwise.hand_targets import HandTargets
from armik_sym.pointwise.library import PointwiseLibrary
from armik_sym.symbolic import Orientation

_CXX = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
_COMPILERS = {
    "cc": [str(CC)],
    "sanitizers": [str(CC), "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
    "zig": [sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined"],
}
NUMPY = PointwiseLibrary(None)


def _run(command, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True, check=False)


def _check(folder: Path, name: str, compiler="cc", flags=STRICT) -> subprocess.CompletedProcess[str]:
    files = (f"armik_{name}.c", f"armik_{name}_solvers.c", "main.c")
    built = _run([*_COMPILERS[compiler], *flags, "-O1", *files, "-o", "check", "-lm"], folder)
    if compiler == "sanitizers" and "cannot find" in built.stderr:
        pytest.skip("no sanitizer libraries")
    assert built.returncode == 0, built.stderr
    return _run(["./check"], folder)


@needs_cc
@pytest.mark.parametrize(
    ("arm", "precision", "lengths", "compiler"),
    [
        ("custom_modified", "double", "baked", "sanitizers"),
        ("ehmcs", "double", "parameter", "zig"),
        ("ehmcs", "float", "baked", "cc"),
        ("ehmcs", "float", "parameter", "sanitizers"),
        ("alfaiz", "float", "parameter", "zig"),
        ("ehmcs", "double", "baked", "cc"),
        ("bare", "double", "parameter", "cc"),
    ],
)
def test_emitted_solvers_pass_their_own_test(tmp_path, arm, precision, lengths, compiler):
    if compiler == "zig" and importlib.util.find_spec("ziglang") is None:
        pytest.skip("no ziglang")
    folder = emit_c({**ARMS, "bare": BARE}[arm], tmp_path / "out", precision, lengths, solvers=True)
    ran = _check(folder, arm, compiler)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert ran.stdout.count(": ok") == 8
    for text in (file.read_text() for file in folder.iterdir() if file.suffix in (".c", ".h", ".txt")):
        assert "@" not in text
        assert text.isascii()


@needs_cc
@pytest.mark.parametrize(
    ("right", "wrong", "fails"),
    [
        ("e[i] = target[i] - pose[i]", "e[i] = pose[i] - target[i]", "lm"),
        ("for (int j = 0; j < DOF; ++j) q[j] = w->best[j];", "for (int j = 0; j < DOF; ++j) q[j] = 9;",
         "postures inside"),
        ("search.centre[j];\n  return error;", "0;\n  return error;", "pro_isade"),
        ("q[j] = search.centre[j]", "q[j] = upper[j] + 1", "postures inside"),
    ],
)  # fmt: skip
def test_its_test_fails_where_a_solver_is_wrong(tmp_path, right, wrong, fails):
    file = emit_c(ehmcs(), tmp_path, solvers=True) / "armik_ehmcs_solvers.c"
    assert file.read_text().count(right) == 1
    file.write_text(file.read_text().replace(right, wrong))
    ran = _check(tmp_path, "ehmcs", flags=())
    assert ran.returncode == 1
    assert re.search(f"{fails}.*FAILED", ran.stdout)


def test_without_solvers_nothing_else_is_written(tmp_path):
    for name, solvers in (("without", False), ("with", True)):
        emit_c(ehmcs(), tmp_path / name, solvers=solvers)
    without = {file.name: file.read_text() for file in (tmp_path / "without").iterdir()}
    both = {file.name: file.read_text() for file in (tmp_path / "with").iterdir()}
    assert sorted(set(both) - set(without)) == ["armik_ehmcs_solvers.c", "armik_ehmcs_solvers.h"]
    assert not any("solvers" in text for text in without.values())
    for name in ("armik_ehmcs.h", "armik_ehmcs.c", "test_vectors.h"):
        assert both[name] == without[name]
    added = [line for line in both["main.c"].splitlines() if line not in without["main.c"].splitlines()]
    assert any("check_solvers(" in line for line in added)
    assert set(without["main.c"].splitlines()) < set(both["main.c"].splitlines())


def test_solver_files_of_others_are_not_overwritten(tmp_path):
    (tmp_path / "armik_ehmcs_solvers.c").write_text("int mine;\n")
    with pytest.raises(OptionError, match=r"_solvers\.c' exists and was not emitted by armik_sym"):
        emit_c(ehmcs(), tmp_path, solvers=True)
    assert [file.name for file in tmp_path.iterdir()] == ["armik_ehmcs_solvers.c"]
    emit_c(ehmcs(), tmp_path)
    assert (tmp_path / "armik_ehmcs_solvers.c").read_text() == "int mine;\n"


def test_emit_c_command_has_the_option(tmp_path):
    arguments = ["emit-c", "--arm", "ehmcs", "--out", str(tmp_path), "--solvers"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0
    assert "armik_ehmcs_solvers.h" in re.sub(r"\s", "", result.stdout)
    assert "armik_ehmcs_solvers.h " in (tmp_path / "README.txt").read_text()


@needs_cc
@pytest.mark.skipif(_CXX is None or shutil.which("nm") is None, reason="no C++ compiler or nm")
def test_two_arms_share_a_program_in_cpp_and_export_only_their_own_names(tmp_path):
    calls = ""
    objects = []
    for name in ("ehmcs", "human"):
        folder = emit_c(ARMS[name], tmp_path / name, "float", solvers=True)
        for stem in (f"armik_{name}", f"armik_{name}_solvers"):
            assert _run([str(CC), *STRICT, "-c", f"{stem}.c"], folder).returncode == 0
            objects.append(folder / f"{stem}.o")
        symbols = [line.split() for line in _run(["nm", objects[-1]], folder).stdout.splitlines()]
        functions = "damped_step lm lm_defaults pose_residual pro_isade pro_isade_defaults sugihara"
        expected = {f"armik_{name}_{f}" for f in (*functions.split(), "sugihara_defaults")}
        assert {symbol for *_, kind, symbol in symbols if kind == "T"} == expected
        assert {kind for *_, kind, _ in symbols} <= {"T", "U", "t", "r"}
        needed = {symbol for *_, kind, symbol in symbols if kind == "U"} - {"_GLOBAL_OFFSET_TABLE_"}
        kinematics = {f"armik_{name}_position", f"armik_{name}_pose_and_jacobian"}
        libm = set("atan2f atanf cosf exp memcpy memset pow sincosf sinf sqrtf".split())
        assert needed <= kinematics | libm | {"__stack_chk_fail"}
        calls += f"""{{
  static armik_{name}_damped_workspace work;
  armik_{name}_damped_settings settings;
  float q[7], lower[7], upper[7], p[3], R[9], J[42];
  armik_{name}_limits(lower, upper);
  for (int i = 0; i < 7; ++i) q[i] = (lower[i] + upper[i]) / 2;
  armik_{name}_pose_and_jacobian(q, p, R, J);
  for (int i = 0; i < 7; ++i) q[i] += 0.1f;
  armik_{name}_lm_defaults(&settings);
  if (!(armik_{name}_lm(&settings, p, R, lower, upper, 0, q, &work) < settings.tolerance)) return 1;
}}
"""
    includes = '#include "armik_ehmcs_solvers.h"\n#include "armik_human_solvers.h"\n'
    (tmp_path / "user.cpp").write_text(f"{includes}int main() {{\n{calls}return 0; }}\n")
    strict = ["-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Iehmcs", "-Ihuman"]
    built = _run([_CXX, *strict, "user.cpp", *objects, "-o", "user", "-lm"], tmp_path)
    assert built.returncode == 0, built.stderr
    assert _run(["./user"], tmp_path).returncode == 0


@needs_cc
def test_a_population_of_another_size_is_one_macro_away_and_too_small_a_one_does_not_compile(tmp_path):
    folder = emit_c(ehmcs(), tmp_path, solvers=True)
    command = [str(CC), *STRICT, "-c", "armik_ehmcs_solvers.c"]
    assert _run([*command, "-DARMIK_ehmcs_POPULATION=31"], folder).returncode == 0
    assert "enough_individuals" in _run([*command, "-DARMIK_ehmcs_POPULATION=4"], folder).stderr


@functools.cache
def _library(folder: Path) -> ctypes.CDLL:
    emit_c(ehmcs(), folder, solvers=True)
    files = ["armik_ehmcs.c", "armik_ehmcs_solvers.c"]
    done = _run([str(CC), "-std=c99", "-O1", "-fPIC", "-shared", *files, "-o", "l.so", "-lm"], folder)
    assert done.returncode == 0, done.stderr
    return ctypes.CDLL(str(folder / "l.so"))


@pytest.fixture(scope="module")
def library(tmp_path_factory) -> ctypes.CDLL:
    return _library(tmp_path_factory.mktemp("solvers"))


def _hand(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of one posture."""
    position, rotation = hand_pose(ehmcs().chain, q[None], ehmcs().lengths)
    return np.ascontiguousarray(position[0]), np.ascontiguousarray(rotation[0])


def _targets(q: np.ndarray) -> HandTargets:
    position, rotation = hand_pose(ehmcs().chain, q, ehmcs().lengths)
    return HandTargets(Orientation.FULL, np.hstack([position, rotation.reshape(-1, 9)]))


def _address(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def _solve(library, name, settings, target, q, *numbers, lower=None, upper=None):
    """One call of a solver: the error and the posture it found."""
    arm = ehmcs()
    work, q = np.zeros(20_000), np.array(q, dtype=float)
    lower = arm.rom.lower if lower is None else lower
    upper = arm.rom.upper if upper is None else upper
    position, rotation = (np.ascontiguousarray(x, dtype=float) for x in target)
    function = getattr(library, f"armik_ehmcs_{name}")
    function.restype = ctypes.c_double
    seeds = [ctypes.c_uint64(n) for n in numbers]
    arrays = [_address(x) for x in (position, rotation, lower, upper)]
    error = function(ctypes.byref(settings), *arrays, *seeds, _address(q), _address(work))
    return error, q


def _defaults(library, name):
    settings = (IsadeSettings if name == "pro_isade" else DampedSettings)()
    ctypes.memset(ctypes.byref(settings), 0x55, ctypes.sizeof(settings))
    getattr(library, f"armik_ehmcs_{name}_defaults")(ctypes.byref(settings))
    return settings


@needs_cc
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("lm", DampedSettings.of(LmOptions(), Orientation.FULL)),
        ("sugihara", DampedSettings.of(SugiharaOptions(), Orientation.FULL)),
        ("pro_isade", isade_settings(ProIsadeOptions(), "pose")),
    ],
)
def test_defaults_are_those_of_the_python_options(library, name, expected):
    settings = _defaults(library, name)
    for field, *_ in expected._fields_:
        assert getattr(settings, field) == getattr(expected, field), field


@needs_cc
@pytest.mark.parametrize(("name", "options"), [("lm", LmOptions()), ("sugihara", SugiharaOptions())])
def test_damped_solvers_find_what_python_finds(library, name, options):
    arm = ehmcs()
    true = postures(arm, 20)
    start = np.clip(true + 0.1, arm.rom.lower, arm.rom.upper)
    settings = _defaults(library, name)
    for i in range(len(true)):
        expected = run_damped(arm, _targets(true[i : i + 1]), options, start=start[i], seed=0, library=NUMPY)
        error, q = _solve(library, name, settings, _hand(true[i]), start[i], 0)
        np.testing.assert_allclose(q, expected.q[0], atol=1e-6)
        assert error < settings.tolerance
        np.testing.assert_allclose(_hand(q)[0], _hand(true[i])[0], atol=2e-9)
        np.testing.assert_allclose(_hand(q)[1], _hand(true[i])[1], atol=2e-8)


@needs_cc
def test_pro_isade_draws_the_same_numbers_as_python(library):
    """Few generations: later, rounding separates the populations."""
    arm = ehmcs()
    true = postures(arm, 1) + 0.01 * np.arange(3)[:, None]
    options = ProIsadeOptions(iter_max=6, population=20, stop=1e-12)
    expected = run_isade(arm, _targets(true), options, start=true[0] - 0.02, seed=5, library=NUMPY)
    settings, q = isade_settings(options, "pose"), true[0] - 0.02
    for i in range(3):
        error, q = _solve(library, "pro_isade", settings, _hand(true[i]), q, 5, i)
        np.testing.assert_allclose(q, expected.q[i], atol=1e-9)
        assert error > settings.stop


@needs_cc
@pytest.mark.parametrize("name", ["lm", "sugihara", "pro_isade"])
def test_whatever_comes_in_the_posture_stays_inside(library, name):
    arm = ehmcs()
    good = _hand(arm.rom.middle)
    nan, inf = np.full(3, np.nan), np.full(3, np.inf)
    settings = _defaults(library, name)
    if name == "pro_isade":
        settings.iter_max = 20
    numbers = (1, 1) if name == "pro_isade" else (1,)
    narrow = arm.rom.middle + 0.01
    for target in (
        good,
        (nan, good[1]),
        (inf, good[1]),
        (good[0], np.full(9, np.nan)),
        (good[0] + 9, good[1]),
    ):
        for start in (arm.rom.middle, arm.rom.upper + 1, np.full(7, np.nan), np.full(7, -np.inf)):
            for lower in (arm.rom.lower, narrow):
                error, q = _solve(library, name, settings, target, start, *numbers, lower=lower)
                assert np.all((lower <= q) & (q <= arm.rom.upper))
                limit = settings.stop if name == "pro_isade" else settings.tolerance
                assert not (error < limit) or target is good


@needs_cc
@pytest.mark.parametrize("population", [-3, 0, 10**6])
def test_populations_without_room_are_cut(library, population):
    arm = ehmcs()
    settings = _defaults(library, "pro_isade")
    settings.population, settings.iter_max, settings.window = population, 40, -0.03
    target = _hand(arm.rom.middle)
    error, q = _solve(library, "pro_isade", settings, target, arm.rom.middle + 0.01, 1, 1)
    assert error < 0.02
    assert np.all(np.abs(q - arm.rom.middle - 0.01) <= 0.03 * 40)


@needs_cc
def test_a_damped_step_stays_inside_and_needs_rows(library):
    arm = ehmcs()
    random = np.random.default_rng(3)
    step, work = np.empty(7), np.zeros(20_000)
    for _ in range(50):
        J, e, q = (
            random.normal(size=(6, 7)),
            random.normal(size=6),
            random.uniform(arm.rom.lower, arm.rom.upper),
        )
        for rows, least in ((6, 1), (3, 1), (1, 1), (0, 0), (-1, 0), (7, 0)):
            step[:] = np.nan
            rounds = library.armik_ehmcs_damped_step(
                _address(J), _address(e), rows, ctypes.c_double(1e-3), _address(q), _address(arm.rom.lower),
                _address(arm.rom.upper), _address(step), _address(work),
            )  # fmt: skip
            assert least <= rounds <= 28 * least
            assert np.all(q + step >= arm.rom.lower - 1e-15)
            assert np.all(q + step <= arm.rom.upper + 1e-15)
            if least:
                J_rows, e_rows = J[:rows], e[:rows]
                assert np.sum((J_rows @ step - e_rows) ** 2) + 1e-3 * step @ step <= e_rows @ e_rows
            else:
                assert not step.any()


@needs_cc
def test_pose_residual_is_the_error_and_its_jacobian(library):
    arm = ehmcs()
    q, other = postures(arm, 2)
    position, rotation = _hand(other)
    residual, jacobian, weight = np.empty(6), np.empty((6, 7)), 0.3
    library.armik_ehmcs_pose_residual.restype = ctypes.c_double

    def at(posture: np.ndarray) -> np.ndarray:
        squared = library.armik_ehmcs_pose_residual(
            _address(position), _address(rotation), _address(posture), ctypes.c_double(weight), 6,
            _address(residual), _address(jacobian),
        )  # fmt: skip
        assert squared == pytest.approx(residual @ residual, rel=1e-12)
        return residual.copy()

    here = at(q)
    np.testing.assert_allclose(here[:3], position - _hand(q)[0], atol=1e-14)
    J = jacobian[:3].copy()
    for i in range(7):
        moved = at(q + 1e-6 * np.eye(7)[i])
        np.testing.assert_allclose(-(moved - here)[:3] / 1e-6, J[:, i], atol=1e-6)
    assert np.linalg.norm(at(other)) < 1e-14


def test_definitions_are_found_or_missed():
    source = "struct a {\n  int x; /* one */\n};\ntypedef struct {\n  real y;\n} b;\nenum { P, Q };\n"
    assert struct_members(source, "a") == "  int x; /* one */\n"
    assert struct_members(source, "b") == "  real y;\n"
    assert enumeration(source, "Q") == "enum { P, Q };"
    assert without_structs(source, ["a", "b"], "h") == "/* a: see h. */\n/* b: see h. */\nenum { P, Q };\n"
    with pytest.raises(LookupError, match="no struct c"):
        struct_members(source, "c")
    with pytest.raises(LookupError, match="no enum with R"):
        enumeration(source, "R")
