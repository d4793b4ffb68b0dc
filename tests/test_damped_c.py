"""The C of the damped methods on its own: strict compilers, float, sanitizers, a controller's use."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from compiled_helpers import CC, STRICT, needs_cc
from damped_helpers import EXPORTS, LOOPS, compiled, reachable, source_of

from armik_sym.arm import Arm
from armik_sym.arm.catalog import ehmcs, human
from armik_sym.compiled.hand_written import loop_text
from armik_sym.pointwise.damped import LmOptions, SugiharaOptions, run_damped
from armik_sym.pointwise.damped.settings import DampedSettings

pytestmark = needs_cc

EHMCS = ehmcs()

PRELUDE = """\
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#define real {real}
#define ONE {one}
#define REAL_IS_FLOAT {is_float}
#define EXPORT static
"""

MAIN = """
static const real targets[][12] = {{ {targets} }};
static const real lower[DOF] = {{ {lower} }}, upper[DOF] = {{ {upper} }}, lengths[] = {{ {lengths} }};

int main(void) {{
  damped_settings settings;
  const ptrdiff_t n = (ptrdiff_t)(sizeof targets / sizeof *targets);
  real q[sizeof targets / sizeof *targets * DOF], error[sizeof targets / sizeof *targets];
  int64_t iterations[sizeof targets / sizeof *targets], evaluations[sizeof targets / sizeof *targets];
  real start[DOF];
  memset(&settings, 0, sizeof settings);
  for (int j = 0; j < DOF; ++j) start[j] = (lower[j] + upper[j]) / 2;
  settings.tolerance = (real){tolerance};
  settings.rotation_weight = (real)0.3;
  settings.increase = 10;
  settings.decrease = (real)0.1;
  settings.smallest = (real)1e-9;
  settings.largest = (real)1e9;
  settings.progress = (real)0.01;
  settings.max_iterations = 100;
  settings.max_stalled = 7;
  settings.restarts = 3;
  for (int kind = 0; kind < 8; ++kind) {{
    settings.method = kind & 1 ? DAMPED_SUGIHARA : DAMPED_LM;
    settings.damping = kind & 1 ? (real){w} : (real)0.1;
    settings.printed = kind >> 1 & 1;
    settings.rows = kind & 4 ? 3 : 6;
    armik_damped_path(&settings, n, 0, 1, targets[0], lengths, lower, upper, start, 1, q, error, iterations,
                      evaluations);
    int reached = 0;
    for (ptrdiff_t i = 0; i < n; ++i) {{
      reached += error[i] < settings.tolerance;
      for (int j = 0; j < DOF; ++j)
        if (!(q[i * DOF + j] >= lower[j] && q[i * DOF + j] <= upper[j])) return 1;
    }}
    printf("%d ", reached);
  }}
  real J[6 * DOF], e[6], d[DOF];
  for (int i = 0; i < 6; ++i) e[i] = (real)i;
  for (int i = 0; i < 6 * DOF; ++i) J[i] = (real)(i % 5) - 2;
  if (damped_step_once(J, e, 6, (real)0.1, start, lower, upper, d) < 1) return 2;
  rotation_residual(targets[0] + 3, 0, d);
  return 0;
}}
"""


def numbers(values: np.ndarray, precision: str) -> str:
    """Entries of an array in C."""
    suffix = "f" if precision == "float" else ""
    words = {"nan": "NAN", "inf": "INFINITY", "-inf": "-INFINITY"}
    return ", ".join(words.get(repr(float(x)), f"{float(x)!r}{suffix}") for x in np.ravel(values))


def program(arm: Arm, precision: str) -> str:
    """A C program that follows a few targets, some of them impossible."""
    targets = np.vstack([reachable(arm, 20).pose, reachable(arm, 4, seed=1).pose])
    targets[20, :3] += 3.0
    targets[21, 5] = np.nan
    targets[22, 1] = np.inf
    targets[23, 4:9] = 1e30
    rows = ", ".join(f"{{ {numbers(row, precision)} }}" for row in targets)
    prelude = PRELUDE.format(
        real=precision, one="1.0f" if precision == "float" else "1.0", is_float=int(precision == "float")
    )
    tolerance, w = ("1e-4", "1e-6") if precision == "float" else ("1e-9", "1e-8")
    limits = {"lower": numbers(arm.rom.lower, precision), "upper": numbers(arm.rom.upper, precision)}
    lengths = numbers(np.append(arm.length_values, 0.0), precision)
    main = MAIN.format(targets=rows, lengths=lengths, tolerance=tolerance, w=w, **limits)
    return source_of(arm, prelude, precision) + EXPORTS + main


def build_and_run(source: str, folder: Path, compiler: str, *flags: str) -> list[int]:
    """Compile a program with every warning an error and run it; the numbers it prints."""
    file, program_file = folder / "program.c", folder / "program"
    file.write_text(source, encoding="ascii")
    command = [compiler, *STRICT, "-g", *flags, "-o", str(program_file), str(file), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if any("sanitize" in flag for flag in flags) and done.returncode and "cannot find" in done.stderr:
        pytest.skip("no sanitizers here")
    assert done.returncode == 0, done.stderr
    ran = subprocess.run([str(program_file)], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return [int(word) for word in ran.stdout.split()]


@pytest.mark.parametrize("compiler", [c for c in ("gcc", "clang") if shutil.which(c)])
@pytest.mark.parametrize("precision", ["double", "float"])
def test_strict_c99(compiler: str, precision: str, tmp_path: Path) -> None:
    lm, sugihara, *_, lm_position, sugihara_position, _, _ = build_and_run(
        program(EHMCS, precision), tmp_path, compiler, "-O2"
    )
    assert min(lm, sugihara) >= 17
    assert min(lm_position, sugihara_position) >= 18
    if precision == "double":
        for options, count in ((LmOptions(restarts=3), lm), (SugiharaOptions(restarts=3), sugihara)):
            found = run_damped(
                EHMCS, reachable(EHMCS, 20), options, start=None, seed=1, library=compiled(EHMCS)
            )
            assert abs(int(found.reached.sum()) - count) <= 1


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("arm", [human(), ehmcs(4)], ids=["7", "4"])
def test_sanitizers_find_nothing(arm: Arm, precision: str, tmp_path: Path) -> None:
    flags = ("-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer")
    build_and_run(program(arm, precision), tmp_path, str(CC), *flags)


def test_sources_are_ascii_without_heap_or_globals() -> None:
    for name in LOOPS:
        text = loop_text(name)
        assert text.isascii()
        assert max(len(line) for line in text.splitlines()) <= 110
        for word in ("malloc", "calloc", "free(", "goto"):
            assert word not in text


def test_settings_have_the_layout_of_c(tmp_path: Path) -> None:
    names = [name for name, _ in DampedSettings._fields_]
    offsets = " ".join("%d" for _ in names)
    values = ", ".join(f"(int)offsetof(damped_settings, {name})" for name in names)
    main = (
        f'\nint main(void) {{ printf("%d {offsets}", (int)sizeof(damped_settings), {values}); return 0; }}\n'
    )
    prelude = PRELUDE.format(real="double", one="1.0", is_float=0).replace(
        "#define EXPORT static", "#define EXPORT"
    )
    file = tmp_path / "layout.c"
    file.write_text(source_of(human(), prelude) + main)
    subprocess.run([str(CC), "-std=c99", "-o", str(tmp_path / "layout"), str(file), "-lm"], check=True)
    out = subprocess.run([str(tmp_path / "layout")], capture_output=True, text=True, check=True).stdout
    size, *found = (int(word) for word in out.split())
    assert found == [getattr(DampedSettings, name).offset for name in names]
    assert size == ctypes.sizeof(DampedSettings)
