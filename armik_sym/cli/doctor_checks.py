"""What `armik doctor` looks at. Every check answers, whatever is broken."""

from __future__ import annotations

import functools
import platform
import sys
from collections.abc import Callable
from importlib import metadata

from armik_sym._version import __version__
from armik_sym.cli.doctor_compiled import check_cache, check_compiler
from armik_sym.cli.doctor_solver import check_data, check_ipopt
from armik_sym.cli.finding import Finding

Check = Callable[[], Finding]


def all_checks() -> list[Check]:
    """All checks, in the order in which they are shown.

    Returns:
        Functions that look and answer; none of them raises.

    Source:
        None (command line).
    """
    optional = {"matplotlib": "figures", "control": "servo simulation", "pyserial": "the recording device"}
    return [
        _python,
        functools.partial(Finding, "armik_sym", "found", __version__),
        *(
            functools.partial(_package, name, "solving", essential=True)
            for name in ("casadi", "numpy", "scipy")
        ),
        check_ipopt,
        *(functools.partial(_package, name, use, essential=False) for name, use in optional.items()),
        check_compiler,
        check_cache,
        check_data,
    ]


def _python() -> Finding:
    return Finding(
        "Python", "found", f"{platform.python_version()} at {sys.executable}, {platform.platform()}"
    )


def _package(name: str, use: str, *, essential: bool) -> Finding:
    try:
        version = metadata.version(name)
    except metadata.PackageNotFoundError:
        return Finding(name, "missing", f"needed for {use}", f"pip install {name}", essential)
    return Finding(name, "found", version, essential=essential)
