"""Running IPOPT on an assembled problem: silent, interruptible, limits never relaxed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from armik_sym.trajectory.interrupt import InterruptWatch

Array = NDArray[np.float64]
IterationCallback = Callable[[int, float], None]

_FEASIBLE = 1e-10
_OPTIMAL = 1e-8
_FINEST = 1e-11


@dataclass(frozen=True, eq=False)
class Bounds:
    """Lower and upper bounds of variables and constraints.

    Attributes:
        lbx: Lower bounds of the variables, shape (n_x,).
        ubx: Upper bounds of the variables, shape (n_x,).
        lbg: Lower bounds of the constraints, shape (n_g,).
        ubg: Upper bounds of the constraints, shape (n_g,).
    """

    lbx: Array
    ubx: Array
    lbg: Array
    ubg: Array


@dataclass(frozen=True, eq=False)
class IpoptResult:
    """What IPOPT returned.

    Attributes:
        x: Variables, shape (n_x,).
        objective: Value of the objective.
        status: IPOPT's own word.
        iterations: Number of iterations.
        converged: True if IPOPT calls the point optimal (also to its looser "acceptable" level).
    """

    x: Array
    objective: float
    status: str
    iterations: int
    converged: bool


class _Watch(ca.Callback):
    """Called by IPOPT after every iteration: reports progress and lets Ctrl-C stop it cleanly."""

    def __init__(
        self, n_x: int, bounds: Bounds, report: IterationCallback | None, ctrl_c: InterruptWatch
    ) -> None:
        ca.Callback.__init__(self)
        self._ctrl_c = ctrl_c
        self._sizes = {"x": n_x, "f": 1, "g": len(bounds.lbg), "lam_x": n_x, "lam_g": len(bounds.lbg)}
        self._bounds = bounds
        self._report = report
        self.iteration = 0
        self.interruption: BaseException | None = None
        self.construct("watch", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, i: int) -> str:
        return str(ca.nlpsol_out(i))

    def get_sparsity_in(self, i: int) -> Any:
        return ca.Sparsity.dense(self._sizes.get(ca.nlpsol_out(i), 0), 1)

    def eval(self, arguments: Any) -> Any:
        try:
            if self._ctrl_c.requested:
                raise KeyboardInterrupt
            if self._report is not None:
                g = np.asarray(arguments[2]).ravel()
                outside = np.maximum(self._bounds.lbg - g, g - self._bounds.ubg)
                self._report(self.iteration, float(max(outside.max(initial=0.0), 0.0)))
            self.iteration += 1
        except BaseException as interruption:  # noqa: BLE001 - carried through C++ and raised after the solve
            self.interruption = interruption
            return [1]
        return [0]


def run_ipopt(
    problem: Any,
    bounds: Bounds,
    x0: Array,
    *,
    max_iterations: int,
    output: bool = False,
    report: IterationCallback | None = None,
    settings: Mapping[str, Any] | None = None,
) -> IpoptResult:
    """Solve a problem with IPOPT.

    Bounds are not relaxed (IPOPT's default moves them by 1e-8), constraints hold to 1e-10.

    Args:
        problem: The problem.
        bounds: Its bounds.
        x0: Starting point, shape (n_x,).
        max_iterations: Iteration limit.
        output: Let IPOPT print.
        report: Called after every iteration with its number and the largest constraint violation.
        settings: Options of IPOPT that differ from those used for the full-space problem.

    Returns:
        The result; look at `converged`.

    Raises:
        KeyboardInterrupt: If the user stopped the solve.

    Source:
        Wächter & Biegler (2006), doi:10.1007/s10107-004-0559-y.
    """
    ctrl_c = InterruptWatch()
    watch = _Watch(len(x0), bounds, report, ctrl_c)
    try:
        with ctrl_c:
            solver = ca.nlpsol(
                "trajectory",
                "ipopt",
                {"x": problem.x, "f": problem.f, "g": problem.g},
                {
                    "grad_f": problem.gradient,
                    "jac_g": problem.jacobian,
                    "hess_lag": problem.hessian,
                    "iteration_callback": watch,
                    "print_time": False,
                    "no_nlp_grad": True,
                    "calc_lam_p": False,
                    "error_on_fail": False,
                    "record_time": False,
                    "show_eval_warnings": output,
                    # Bounds are made here and sound; the check would print where joints of zero range
                    # leave fewer variables than equations, which IPOPT can handle.
                    "inputs_check": False,
                    "ipopt": {**_settings(problem.scale, max_iterations, output), **(settings or {})},
                },
            )
            found = solver(x0=x0, lbx=bounds.lbx, ubx=bounds.ubx, lbg=bounds.lbg, ubg=bounds.ubg)
    except RuntimeError:
        if watch.interruption is None:
            raise
    if watch.interruption is not None:
        raise watch.interruption
    if ctrl_c.requested:
        raise KeyboardInterrupt
    stats = solver.stats()
    return IpoptResult(
        x=np.asarray(found["x"]).ravel(),
        objective=float(found["f"]) / problem.scale,
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        converged=bool(stats["success"]),
    )


def _settings(scale: float, max_iterations: int, output: bool) -> dict[str, Any]:
    # The tolerance is meant for the user's objective; a scaled one needs a finer one.
    tolerance = max(_OPTIMAL * scale, _FINEST)
    return {
        "print_level": 5 if output else 0,
        "sb": "no" if output else "yes",
        "max_iter": int(max_iterations),
        "tol": tolerance,
        "constr_viol_tol": _FEASIBLE,
        "acceptable_tol": 100 * tolerance,
        "acceptable_constr_viol_tol": _FEASIBLE,
        "bound_relax_factor": 0.0,
        "honor_original_bounds": "yes",
        "nlp_scaling_method": "none",
        "mu_strategy": "adaptive",
    }
