"""The C library for a controller: it compiles with every warning an error, and its own test passes."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from compiled_helpers import CC, STRICT, caller, needs_cc
from sample_arms import ARMS, BARE, postures

from armik_sym import emit_c
from armik_sym.arm import Arm
from armik_sym.arm.catalog import ehmcs
from armik_sym.compiled import compile as compile_arm
from armik_sym.compiled.emit_functions import limits_in
from armik_sym.compiled.emit_text import comment_text
from armik_sym.compiled.emit_vectors import jacobian_by_differences, sample_postures
from armik_sym.errors import OptionError

_ARMS = [arm for name, arm in ARMS.items() if name != "ehmcs_5dof"]
_CXX = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")


def _run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def _check(folder: Path, arm: Arm) -> str:
    built = _run([str(CC), *STRICT, "-O1", f"armik_{arm.name}.c", "main.c", "-o", "check", "-lm"], folder)
    assert built.returncode == 0, built.stderr
    ran = _run(["./check"], folder)
    assert ran.returncode == 0, ran.stdout
    return ran.stdout


@needs_cc
@pytest.mark.parametrize("lengths", ["baked", "parameter"])
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("arm", [*_ARMS, BARE], ids=lambda a: a.name)
def test_emitted_library_passes_its_own_test(tmp_path, arm, precision, lengths):
    assert emit_c(arm, tmp_path / "new" / "out", precision, lengths) == tmp_path / "new" / "out"
    said = _check(tmp_path / "new" / "out", arm)
    assert said.count(": ok") == 4
    assert f"armik_{arm.name}, {precision} precision, 50 postures" in said
    takes = "lengths[ARMIK_RESTRICT" in (tmp_path / "new" / "out" / f"armik_{arm.name}.h").read_text()
    assert takes == (lengths == "parameter" and bool(arm.lengths))


@needs_cc
def test_its_test_fails_where_the_code_is_wrong(tmp_path):
    for what, change in (("position", "ONE + "), ("rotation", "NAN * ")):
        folder = emit_c(ehmcs(), tmp_path / what)
        file = folder / "armik_ehmcs.c"
        file.write_text(file.read_text().replace(f"{what}[1] = ", f"{what}[1] = {change}"))
        assert _run([str(CC), "armik_ehmcs.c", "main.c", "-o", "check", "-lm"], folder).returncode == 0
        ran = _run(["./check"], folder)
        assert ran.returncode == 1
        assert re.search(f"{what}.*FAILED", ran.stdout)


@needs_cc
def test_numbers_equal_those_in_python(tmp_path):
    arm = ehmcs()
    folder = emit_c(arm, tmp_path, lengths="parameter")
    _run([str(CC), "-std=c99", "-O2", "-fPIC", "-shared", "armik_ehmcs.c", "-o", "lib.so", "-lm"], folder)
    import ctypes

    handle = ctypes.CDLL(str(folder / "lib.so"))
    kin = compile_arm(arm, "vm")
    for q in postures(arm, 20):
        np.testing.assert_allclose(
            caller(handle, "armik_ehmcs_jacobian", 42)(q, arm.length_values).reshape(6, 7),
            kin.jacobian(q),
            atol=1e-14,
        )
    upper = caller(handle, "armik_ehmcs_limits", 7)(lower := np.empty(7))
    np.testing.assert_array_equal(lower, arm.rom.lower)
    np.testing.assert_array_equal(upper, arm.rom.upper)
    np.testing.assert_array_equal(caller(handle, "armik_ehmcs_default_lengths", 2)(), arm.length_values)


@needs_cc
@pytest.mark.skipif(_CXX is None or shutil.which("nm") is None, reason="no C++ compiler or nm")
@pytest.mark.parametrize("lengths", ["baked", "parameter"])
def test_header_serves_cpp_and_the_object_holds_no_data(tmp_path, lengths):
    folder = emit_c(ehmcs(), tmp_path, "float", lengths)
    arguments = "q, l, p" if lengths == "parameter" else "q, p"
    (folder / "user.cpp").write_text(
        '#include "armik_ehmcs.h"\n#include "armik_ehmcs.h"\n'
        "int main() { armik_real q[ARMIK_ehmcs_DOF] = {}, l[2] = {1, 1}, p[3]; (void)l;\n"
        f"  armik_ehmcs_position({arguments}); return p[0] == p[0] && "
        "armik_ehmcs_joint_elbow_flexion == 3 ? 0 : 1; }\n"
    )
    assert _run([str(CC), *STRICT, "-c", "armik_ehmcs.c"], folder).returncode == 0
    strict = ["-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror"]
    built = _run([str(_CXX), *strict, "user.cpp", "armik_ehmcs.o", "-o", "user", "-lm"], folder)
    assert built.returncode == 0, built.stderr
    assert _run(["./user"], folder).returncode == 0
    symbols = [line.split() for line in _run(["nm", "armik_ehmcs.o"], folder).stdout.splitlines()]
    assert {kind for *_, kind, _ in symbols} <= {"T", "U"}
    allowed = {"sinf", "cosf", "sincosf", "_GLOBAL_OFFSET_TABLE_"}
    assert {name for *_, kind, name in symbols if kind == "U"} <= allowed


@needs_cc
def test_two_arms_of_one_precision_share_a_file_and_of_two_do_not(tmp_path):
    for arm, precision in (("ehmcs", "double"), ("human", "double"), ("alfaiz", "float")):
        emit_c(ARMS[arm], tmp_path / arm, precision)
    include = [f"-I{tmp_path / arm}" for arm in ("ehmcs", "human", "alfaiz")]
    (tmp_path / "same.c").write_text('#include "armik_ehmcs.h"\n#include "armik_human.h"\n')
    (tmp_path / "mixed.c").write_text('#include "armik_ehmcs.h"\n#include "armik_alfaiz.h"\n')
    assert _run([str(CC), *STRICT, *include, "-c", "same.c"], tmp_path).returncode == 0
    mixed = _run([str(CC), *STRICT, *include, "-c", "mixed.c"], tmp_path)
    assert "emit both with the same one" in mixed.stderr


@needs_cc
@pytest.mark.skipif(shutil.which("cmake") is None, reason="no cmake")
def test_cmake_builds_and_tests(tmp_path):
    folder = emit_c(ehmcs(), tmp_path)
    assert _run(["cmake", "-S", ".", "-B", "build", f"-DCMAKE_C_COMPILER={CC}"], folder).returncode == 0
    assert _run(["cmake", "--build", "build"], folder).returncode == 0
    tested = _run(["ctest", "--test-dir", "build"], folder)
    assert tested.returncode == 0, tested.stdout


def test_header_tells_units_order_and_limits(tmp_path):
    emit_c(ARMS["custom_standard"], tmp_path, "float", "parameter")
    header = (tmp_path / "armik_custom_standard.h").read_text()
    assert "q[0]  lift   [m]  -0.2 to 0.2\n" in header
    assert "q[1]  turn   [rad]  -3 to 3  (-171.887 to 171.887 deg)\n" in header
    assert "lengths[0]  upper  (0.31)" in header
    assert "typedef float armik_real;" in header
    assert "const armik_real q[ARMIK_RESTRICT 5]" in header
    assert "@" not in header
    assert header.isascii()
    baked = emit_c(ehmcs(), tmp_path / "baked") / "armik_ehmcs.h"
    assert "upper_arm = 0.2869" in baked.read_text()
    assert all("@" not in f.read_text() for f in (tmp_path / "baked").iterdir())


def test_emitting_twice_gives_the_same_text_and_leaves_nothing_else(tmp_path):
    emit_c(ehmcs(), tmp_path)
    first = {f.name: f.read_bytes() for f in tmp_path.iterdir()}
    emit_c(ehmcs(), tmp_path)
    assert {f.name: f.read_bytes() for f in tmp_path.iterdir()} == first
    assert sorted(first) == [
        "CMakeLists.txt", "README.txt", "armik_ehmcs.c", "armik_ehmcs.h", "main.c", "test_vectors.h",
    ]  # fmt: skip


def test_files_of_others_are_not_overwritten(tmp_path):
    (tmp_path / "main.c").write_text("int main(void) { return 0; }\n")
    with pytest.raises(OptionError, match=r"main\.c' exists and was not emitted by armik_sym"):
        emit_c(ehmcs(), tmp_path)
    assert [f.name for f in tmp_path.iterdir()] == ["main.c"]


def test_folders_that_cannot_be_written_are_named(tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    for bad in (file, file / "below", "/dev/null/x", "/proc/nothing"):
        with pytest.raises(OptionError, match=re.escape(f"cannot write C code to {str(bad)!r}")):
            emit_c(ehmcs(), bad)


def test_unknown_words_write_nothing(tmp_path):
    with pytest.raises(OptionError, match="precision is 'half'"):
        emit_c(ehmcs(), tmp_path / "out", "half")  # type: ignore[arg-type]
    with pytest.raises(OptionError, match="lengths is 'fixed'"):
        emit_c(ehmcs(), tmp_path / "out", lengths="fixed")  # type: ignore[arg-type]
    assert not (tmp_path / "out").exists()


def test_no_limit_grows_by_rounding_to_float():
    for arm in ARMS.values():
        lower, upper = limits_in(arm, "float")
        assert np.all(lower >= arm.rom.lower)
        assert np.all(upper <= arm.rom.upper)
        np.testing.assert_allclose(lower, arm.rom.lower, rtol=2e-7)
        np.testing.assert_array_equal(lower, lower.astype(np.float32))


@pytest.mark.parametrize("precision", ["double", "float"])
def test_test_postures_are_inside_and_reach_every_limit(precision):
    for arm in ARMS.values():
        q = sample_postures(arm, precision)
        lower, upper = limits_in(arm, precision)
        assert len(q) == 50
        assert np.all((lower <= q) & (q <= upper))
        np.testing.assert_array_equal(q[:2], [lower, upper])
        if precision == "float":
            np.testing.assert_array_equal(q, q.astype(np.float32))


def test_differences_are_good_to_thirteen_digits():
    arm = ehmcs()
    q = postures(arm, 20)
    np.testing.assert_allclose(
        jacobian_by_differences(arm, q), compile_arm(arm, "vm").jacobian(q), atol=2e-13
    )


def test_comment_text_cannot_leave_its_comment():
    assert comment_text("a */ b /* c ??/\n#x \\ ü @Q@") == "a * / b / * c ? ?/ #x _ _ _Q_"
    for text in ("**//", "/*/", "????", "*/*/", "*" * 5 + "/"):
        safe = comment_text(text)
        assert "*/" not in safe
        assert "/*" not in safe
        assert "??" not in safe
