"""The library Python really compiles is clean C, for every kind of arm."""

from __future__ import annotations

import shutil
import subprocess

import pytest

import armik_sym as ak
from armik_sym.pointwise.library import ALFAIZ_LOOPS, LOOPS, library_source

ARMS = {
    "4": ak.catalog.ehmcs(dof=4),
    "5": ak.catalog.ehmcs(dof=5),
    "7": ak.catalog.human(),
    "alfaiz": ak.catalog.alfaiz(),
}
CC = shutil.which("cc") or shutil.which("gcc")
STRICT = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror")


@pytest.mark.skipif(CC is None, reason="no C compiler")
@pytest.mark.parametrize("flags", [("-O2",), ("-O3", "-march=native")], ids=" ".join)
@pytest.mark.parametrize("name", ARMS)
def test_the_library_compiles_without_a_warning(name, flags, tmp_path):
    file = tmp_path / "library.c"
    file.write_text(library_source(ARMS[name]), encoding="ascii")
    command = [CC, *STRICT, *flags, "-fPIC", "-c", str(file), "-o", str(tmp_path / "library.o")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:2000]


def test_every_hand_written_loop_is_in_it():
    text = library_source(ARMS["alfaiz"])
    for entry in ("armik_isade_path", "armik_damped_path", "armik_alfaiz_path"):
        assert entry in text
    assert len(set(LOOPS + ALFAIZ_LOOPS)) == len(LOOPS + ALFAIZ_LOOPS)
    assert "armik_alfaiz_path" not in library_source(ARMS["7"])
