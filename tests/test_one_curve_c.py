"""The C loops of the whole-trajectory method: strict C99, no memory touched that is not theirs."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest
from compiled_helpers import CC, needs_cc

from armik_sym.trajectory.library import library_source

FLAGS = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wshadow", "-Wdouble-promotion")

# Every array is exactly as long as it has to be, on the heap, so that one number too far is noticed.
DRIVER = """
#include <stdlib.h>
static double *made(ptrdiff_t n, double scale) {
  double *array = (double *)malloc((size_t)(n > 0 ? n : 1) * sizeof(double));
  for (ptrdiff_t i = 0; i < n; ++i) array[i] = scale * sin(1.0 + 0.7 * (double)i);
  return array;
}
int main(void) {
  for (ptrdiff_t n = 1; n < 9; ++n) {
    int *chart = (int *)malloc((size_t)n * sizeof(int));
    for (ptrdiff_t k = 0; k < n; ++k) chart[k] = (int)(k % 3);
    double *x = made(n, 1), *parameters = made(n * CURVE_PARAMETERS, 1), *speed = made(n - 1, 1);
    double *bend = made(3 * (n - 2), 1), *hold = made(n, 1), *aim = made(7 * n, 1), *q = made(7 * n, 0);
    double *slope = made(7 * n, 0), *curvature = made(7 * n, 0), *force = made(7 * n, 0);
    double *gradient = made(n, 0), *bands = made(3 * n, 0), *lower = made(n, 0), *upper = made(n, 0);
    double *room = made(48 * n, 0), value[1];
    for (ptrdiff_t k = 0; k < n; ++k) { lower[k] = x[k] - 0.2; upper[k] = x[k] + 0.3; }
    const double one = armik_curve_value(n, chart, x, parameters, speed, bend, hold, aim, q);
    const double two = armik_curve_derivatives(n, chart, x, parameters, speed, bend, hold, aim, q, slope,
                                               curvature, force, gradient, bands);
    if (!(fabs(one - two) <= 1e-12 * fabs(one))) return 1;
    for (int most = 0; most < 30; most += 7) {
      const int steps = armik_curve_descend(n, chart, x, parameters, speed, bend, hold, aim, lower, upper,
                                            most, 1e-9, value, room);
      if (steps > most || !(value[0] <= one * (1 + 1e-12))) return 2;
      for (ptrdiff_t k = 0; k < n; ++k) if (!(x[k] >= lower[k] && x[k] <= upper[k])) return 3;
    }
    double *all[] = {x, parameters, speed, bend, hold, aim, q, slope, curvature, force, gradient, bands,
                     lower, upper, room};
    for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); ++i) free(all[i]);
    free(chart);
  }
  return 0;
}
"""


def run(folder, *flags: str, timeout: float = 120) -> subprocess.CompletedProcess[str]:
    """Compile the library with the driver, and run it."""
    file, program = folder / "driver.c", folder / "driver"
    file.write_text(library_source() + DRIVER)
    built = subprocess.run(
        [str(CC), *FLAGS, "-Wno-unused-function", *flags, "-o", str(program), str(file), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr
    return subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=timeout)


@needs_cc
def test_compiles_without_a_warning_and_runs(tmp_path):
    done = run(tmp_path, "-O1")
    assert done.returncode == 0, done.stderr


@needs_cc
@pytest.mark.skipif(sys.platform != "linux", reason="sanitizers are not part of every toolchain")
def test_no_memory_is_touched_that_is_not_its_own(tmp_path):
    probe = tmp_path / "probe.c"
    probe.write_text("int main(void) { return 0; }\n")
    flags = ("-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    command = [str(CC), *flags, "-o", str(tmp_path / "probe"), str(probe)]
    if shutil.which(str(CC)) is None or subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("this compiler has no sanitizers")
    done = run(tmp_path, *flags)
    assert done.returncode == 0, done.stderr
