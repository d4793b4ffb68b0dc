"""What OpenSim reads from a file, asked in a process of its own: it bundles another CasADi than ours."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

needs_opensim = pytest.mark.skipif(
    importlib.util.find_spec("opensim") is None, reason="opensim is not installed"
)


def answer_of_opensim(script: str, file: Path) -> Any:
    """What a script, given the file as its argument, prints as JSON after the word RESULT."""
    done = subprocess.run(
        [sys.executable, "-c", script, str(file)],
        capture_output=True,
        text=True,
        check=True,
        cwd=file.parent,
    )
    return json.loads(done.stdout.split("RESULT", 1)[1])
