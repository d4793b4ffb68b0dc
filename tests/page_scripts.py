"""Running the page's own kinematics in Node."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
from typing import Any

import numpy as np
import pytest
from sample_arms import ARMS as SAMPLES
from spherical_arms import ARMS as SPHERICAL

from armik_sym.report.wasm import PageKinematics

NODE = shutil.which("node")
HAS_ZIG = importlib.util.find_spec("ziglang") is not None or shutil.which("zig") is not None

needs_node = pytest.mark.skipif(NODE is None, reason="node not installed: the page's script cannot run")
needs_zig = pytest.mark.skipif(not HAS_ZIG, reason="ziglang not installed: nothing compiles to WebAssembly")

# Every kind of chain; a closed form for poses have those of the first list.
WITH_SWIVEL = dict(SPHERICAL)
ALL_ARMS = WITH_SWIVEL | SAMPLES

_DRIVER = """
const input = JSON.parse(require("fs").readFileSync(0, "utf8"));
armikKinematics(input.data).then((kinematics) => {
  const answer = ([name, ...args]) => {
    if (typeof kinematics[name] !== "function") return kinematics[name];
    try { return kinematics[name](...args.map((x) => (x === null ? undefined : x))); }
    catch (error) { return { error: error.message }; }
  };
  console.log(JSON.stringify(input.calls.map(answer)));
});
"""


def ask(page: PageKinematics, calls: list[tuple[Any, ...]]) -> list[Any]:
    """What the page's kinematics answers to calls (name, arguments ...), in order."""
    done = subprocess.run(
        [str(NODE), "-e", page.script + _DRIVER],
        input=json.dumps({"data": page.data, "calls": calls}, allow_nan=False),
        capture_output=True,
        text=True,
        check=False,
        timeout=900,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return json.loads(done.stdout)


def rows(page: PageKinematics, name: str, q: np.ndarray) -> list[Any]:
    """One call per posture."""
    return ask(page, [(name, row) for row in q.tolist()])


def postures(page: PageKinematics, psi: np.ndarray, q: np.ndarray, reference: Any = None) -> np.ndarray:
    """Postures at swivel angles, shape (n, dof)."""
    calls = [("posture", at, row, reference) for at, row in zip(psi.tolist(), q.tolist(), strict=True)]
    return np.array(ask(page, calls))
