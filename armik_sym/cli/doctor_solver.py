"""Checks of the solver and of the bundled data."""

from __future__ import annotations

import subprocess
import sys

from armik_sym.cli.finding import Finding, reinstall

# In a process of its own: a solver library that does not fit the machine ends the process it is in.
_TINY_SOLVE = """
import casadi as ca
x = ca.SX.sym("x", 2)
problem = {"x": x, "f": (x[0] - 1) ** 2 + x[1] ** 2, "g": x[0] + x[1]}
solver = ca.nlpsol("tiny", "ipopt", problem, {"print_time": False, "error_on_fail": False,
    "ipopt": {"linear_solver": "mumps"}})
found = solver(x0=[0, 0], lbg=1, ubg=1)
assert solver.stats()["success"] and abs(float(found["x"][0]) - 1) < 1e-6, solver.stats()["return_status"]
"""
_TIMEOUT = 120.0
_BANNER = "This is Ipopt version "


def check_ipopt() -> Finding:
    """Solve a tiny problem with IPOPT: minimise (x - 1)² + y² with x + y = 1.

    Returns:
        The finding, with version and linear solver.

    Source:
        Wächter & Biegler (2006), doi:10.1007/s10107-004-0559-y.
    """
    try:
        done = subprocess.run(
            [sys.executable, "-c", _TINY_SOLVE],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_TIMEOUT,
            check=False,
        )
    except (OSError, subprocess.SubprocessError) as error:
        return _no_ipopt(str(error))
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        return _no_ipopt(f"a tiny problem could not be solved: {last}")
    banner = [line for line in done.stdout.splitlines() if line.startswith(_BANNER)]
    said = banner[0].removeprefix(_BANNER).rstrip(".") if banner else "linear solver mumps"
    return Finding("IPOPT", "found", f"{said}; solved a tiny problem", essential=True)


def _no_ipopt(detail: str) -> Finding:
    remedy = "it comes with CasADi: pip install --force-reinstall casadi"
    return Finding("IPOPT", "broken", detail, remedy, essential=True)


def check_data() -> Finding:
    """Load every bundled task, and count the bundled arms and patients.

    Returns:
        The finding.

    Source:
        None (command line).
    """
    from armik_sym.errors import ArmikError
    from armik_sym.motion.bundled import data_folder
    from armik_sym.motion.tasks import load_task, task_names

    try:
        folder = data_folder()
        tasks = [load_task(name) for name in task_names()]
        counts = [f"{len(tasks)} tasks (synthetic)"]
        for kind in ("arms", "patients"):
            counts.append(f"{len(list((folder / kind).glob('*.toml')))} {kind}")
    except (ArmikError, OSError) as error:
        return reinstall("bundled data", str(error))
    return Finding("bundled data", "found", f"{', '.join(counts)} in {folder}", essential=True)
