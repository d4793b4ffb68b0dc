"""The C of ISADE: without warnings, inside its workspace, without undefined behaviour."""

from __future__ import annotations

import subprocess

import pytest
from compiled_helpers import CC, needs_cc
from isade_helpers import (
    ARM,
    c_source,
)

MAIN = """
#include <stdio.h>
#include <stdlib.h>
int main(void) {
  static const int cases[3][3] = {{5, 0, 0}, {13, 1, 2}, {40, 2, 3}}; /* population, measure, repair */
  real targets[36], lengths[N_LENGTHS + 1];
  for (int j = 0; j < N_LENGTHS; ++j) lengths[j] = 0.3;
  for (int c = 0; c < 3; ++c) {
    const struct isade_settings settings = {cases[c][0], 25, cases[c][1], cases[c][2], c % 2, 4, 0.2, 0.8, 1,
                                            -1, 0.1, 0.01, 1, 0.3, 1e-8, 0.5, 0.03};
    /* The exact workspace: one number more would be found. */
    real *reals = malloc((size_t)armik_isade_reals(settings.population) * sizeof *reals);
    uint64_t *words = malloc((size_t)armik_isade_words(settings.population) * sizeof *words);
    real lower[DOF], upper[DOF], previous[DOF], q[3 * DOF], error[3];
    int generations[3], evaluations[3];
    for (int j = 0; j < DOF; ++j) lower[j] = -(upper[j] = 0.5), previous[j] = 0.1;
    for (int k = 0; k < 3; ++k) {
      armik_pose(previous, lengths, targets + 12 * k);
      targets[12 * k] += 0.001 * k;
    }
    for (int k = 0; k < 2; ++k) /* in two blocks */
      armik_isade_path(&settings, 42, k, k + 1, targets + 12 * k, lengths, lower, upper, previous,
                       reals, words, q + k * DOF, error + k, generations + k, evaluations + k);
    free(reals);
    free(words);
    for (int k = 0; k < 3 * DOF; ++k)
      if (!(q[k] >= -0.5 && q[k] <= 0.5)) return 3;
    if (!(error[0] < 1e-8) || generations[2] < 1 || evaluations[2] < settings.population) return 4;
  }
  return 0;
}
"""
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")


@needs_cc
@pytest.mark.parametrize(
    "flags", [("-O2",), ("-O3", "-march=native"), SANITIZED, (*SANITIZED, "-O1", "-march=native")]
)
def test_c_is_clean_under_warnings_and_sanitizers(tmp_path, flags):
    file, program = tmp_path / "main.c", tmp_path / "main"
    file.write_text(c_source(ARM) + MAIN)
    warnings = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-Wshadow")
    done = subprocess.run(
        [str(CC), *warnings, *flags, "-o", str(program), str(file), "-lm"],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode and "source" not in done.stderr and "main.c:" not in done.stderr:
        pytest.skip(f"compiler lacks {flags}: {done.stderr[:200]}")
    assert done.returncode == 0, done.stderr
    ran = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
