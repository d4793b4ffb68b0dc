"""Generated C where it works, CasADi's virtual machine where it does not."""

from __future__ import annotations

import importlib.util
import warnings

import numpy as np
import pytest
from compiled_helpers import forgotten, needs_cc, script
from sample_arms import ARMS, postures

from armik_sym.compiled import compile as compile_arm
from armik_sym.compiled.backend import build_or_none
from armik_sym.errors import CompilerError, CompilerWarning, OptionError

_ARM = ARMS["ehmcs"]
_OTHER = ARMS["human"]


@pytest.fixture(autouse=True)
def _fresh(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path / "cache"))
    with forgotten():
        yield


def _hide_compilers(monkeypatch):
    find_spec = importlib.util.find_spec
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name, *a: None if name == "ziglang" else find_spec(name, *a)
    )


def test_unknown_backend_is_named():
    with pytest.raises(OptionError, match="backend is 'gpu': valid are auto, c, vm"):
        compile_arm(_ARM, "gpu")  # type: ignore[arg-type]


@needs_cc
def test_auto_takes_the_compiler():
    assert compile_arm(_ARM).backend == "c"


def test_vm_wants_no_compiler(monkeypatch):
    monkeypatch.setenv("CC", "/no/such/compiler")
    kin = compile_arm(_ARM, "vm")
    assert kin.backend == "vm"
    assert kin.compile_time == 0
    assert build_or_none("", "vm") is None


def test_without_any_compiler_there_is_one_warning_and_the_same_answer(monkeypatch):
    q = postures(_ARM, 300)
    wanted = compile_arm(_ARM, "vm").jacobian(q)
    _hide_compilers(monkeypatch)
    with pytest.warns(CompilerWarning, match=r"no C compiler found(.|\n)*pip install ziglang") as caught:
        kin = compile_arm(_ARM)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compile_arm(_OTHER)  # a second arm, the same reason: silence
    assert kin.backend == "vm"
    np.testing.assert_array_equal(kin.jacobian(q), wanted)


def test_without_any_compiler_c_is_an_error(monkeypatch):
    _hide_compilers(monkeypatch)
    with pytest.raises(CompilerError, match=r"no C compiler found.*ziglang"):
        compile_arm(_ARM, "c")


def test_broken_cc_is_an_error_for_c_and_a_warning_for_auto(monkeypatch):
    monkeypatch.setenv("CC", "/no/such/compiler -O3")
    with pytest.raises(CompilerError, match="CC='/no/such/compiler -O3'"):
        compile_arm(_ARM, "c")
    with pytest.warns(CompilerWarning, match="CC='/no/such/compiler -O3'") as caught:
        assert compile_arm(_ARM).backend == "vm"
    assert len(caught) == 1


def test_failing_compiler_shows_its_output(monkeypatch, tmp_path):
    failing = script(tmp_path / "failing", '[ "$1" = --version ] && exit 0\necho boom\nexit 1')
    monkeypatch.setenv("CC", str(failing))
    with pytest.raises(CompilerError, match="boom"):
        compile_arm(_ARM, "c")
    with pytest.warns(CompilerWarning, match="boom") as caught:
        compile_arm(_ARM)
    assert len(caught) == 1
