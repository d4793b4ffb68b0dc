"""What one forward kinematics costs: generated C, its Python calls, CasADi's virtual machine, Pinocchio.

Run: python benchmarks/kinematics.py [--quick]

All candidates take turns in every round; the table gives the median round. "C loop" is the generated
batch function called from a loop in C, without Python; "plain C loop" the same generated code one
posture at a time with libm's sine and cosine, as `emit_c` writes it. Both get the same postures and
write to arrays of the same size as the Python calls, once to memory in use ("warm") and once, as a
Python call that returns a new array must, to memory fresh from the system ("fresh").
"""

from __future__ import annotations

import argparse
import ctypes
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import casadi as ca
import numpy as np

from armik_sym import emit_c
from armik_sym.arm import Arm, DHConvention
from armik_sym.arm.catalog import alfaiz, ehmcs, human
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled import Kinematics, compile
from armik_sym.compiled.compiler import Compiler, find_compiler

LARGE = 100_000
QUANTITIES = {"position": 3, "jacobian": 42, "pose_and_jacobian": 54}

TIMER = """\
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#define EXPORT __attribute__((visibility("default")))
static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
typedef void batch(ptrdiff_t, const double *, const double *, double *);
EXPORT double time_batch(batch *f, ptrdiff_t n, const double *q, const double *l, double *out) {
  const double start = now();
  f(n, q, l, out);
  return now() - start;
}
@PLAIN@
"""
PLAIN = """\
EXPORT double time_plain_{name}(ptrdiff_t n, const double *q, double *out) {{
  const double start = now();
  for (ptrdiff_t i = 0; i < n; ++i) {call};
  return now() - start;
}}
"""
PLAIN_CALLS = {
    "position": "armik_{arm}_position(q + 7 * i, out + 3 * i)",
    "jacobian": "armik_{arm}_jacobian(q + 7 * i, out + 42 * i)",
    "pose_and_jacobian": (
        "armik_{arm}_pose_and_jacobian(q + 7 * i, out + 54 * i, out + 54 * i + 3, out + 54 * i + 12)"
    ),
}

Timings = dict[str, dict[str, float]]


def address(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def seconds(call: Callable[[], object], calls: int = 1) -> float:
    start = time.perf_counter()
    for _ in range(calls):
        call()
    return (time.perf_counter() - start) / calls


def c_timers(arm: Arm, compiler: Compiler, folder: Path) -> ctypes.CDLL:
    """A library that times the emitted functions and any batch function inside C."""
    emitted = emit_c(arm, folder)
    plain = "\n".join(
        PLAIN.format(name=name, call=call.format(arm=arm.name)) for name, call in PLAIN_CALLS.items()
    )
    head = f'#define _POSIX_C_SOURCE 199309L\n#include "armik_{arm.name}.c"\n'
    source = emitted / "timer.c"
    source.write_text(head + TIMER.replace("@PLAIN@", plain))
    compiler.compile_shared(source, emitted / "timer.so")
    library = ctypes.CDLL(str(emitted / "timer.so"))
    for name in ("time_batch", *(f"time_plain_{q}" for q in QUANTITIES)):
        getattr(library, name).restype = ctypes.c_double
    return library


def candidates(arm: Arm, q: np.ndarray, folder: Path) -> dict[str, Callable[[], float]]:
    """Everything that is timed, as functions that return seconds per posture."""
    compiler = find_compiler()
    if compiler is None:
        raise SystemExit("this benchmark needs a C compiler")
    kin, vm = compile(arm, "c"), compile(arm, "vm")
    timers = c_timers(arm, compiler, folder)
    lengths, n, hundred, one = arm.length_values, len(q), q[:100].copy(), q[0].copy()
    found: dict[str, Callable[[], float]] = {}
    for name, size in QUANTITIES.items():
        found |= in_c(name, size, kin, timers, q, lengths)
        f, v = getattr(kin, name), getattr(vm, name)
        out = np.zeros((n, size)).reshape(getattr(kin, name)(q).shape) if size != 54 else np.zeros((n, 54))
        found |= {
            f"{name}|python n=1": lambda f=f: seconds(lambda: f(one), 500),
            f"{name}|python n=100": lambda f=f: seconds(lambda: f(hundred), 50) / 100,
            f"{name}|python n={LARGE}": lambda f=f: seconds(lambda: f(q)) / n,
            f"{name}|python n={LARGE}, out=": lambda f=f, out=out: seconds(lambda: f(q, out=out)) / n,
            f"{name}|vm n=1": lambda v=v: seconds(lambda: v(one), 200),
            f"{name}|vm n=10000": lambda v=v: seconds(lambda: v(q[:10_000])) / 10_000,
        }
        function = vm._functions[name]._single
        found[f"{name}|casadi call n=1"] = lambda g=function: seconds(lambda: g(one, lengths), 50)
    return found


def in_c(
    name: str, size: int, kin: Kinematics, timers: ctypes.CDLL, q: np.ndarray, lengths: np.ndarray
) -> dict[str, Callable[[], float]]:
    n = len(q)
    warm, small = np.zeros((n, size)), np.zeros((100, size))
    loop, plain = kin._functions[name]._loop, getattr(timers, f"time_plain_{name}")

    def batch(out: np.ndarray | None, n: int = n) -> float:
        out = np.empty((n, size)) if out is None else out
        return timers.time_batch(loop, ctypes.c_ssize_t(n), address(q), address(lengths), address(out)) / n

    def alone(out: np.ndarray | None, n: int = n) -> float:
        out = np.empty((n, size)) if out is None else out
        return plain(ctypes.c_ssize_t(n), address(q), address(out)) / n

    def fresh() -> float:
        # Allocation and release belong to the price: a new array per call does the same.
        def call() -> None:
            out = np.empty((n, size))
            timers.time_batch(loop, ctypes.c_ssize_t(n), address(q), address(lengths), address(out))

        return seconds(call) / n

    return {
        f"{name}|plain C loop, n=100 hot": lambda: min(alone(small, 100) for _ in range(20)),
        f"{name}|plain C loop, warm": lambda: alone(warm),
        f"{name}|C loop, n=100 hot": lambda: min(batch(small, 100) for _ in range(20)),
        f"{name}|C loop, warm": lambda: batch(warm),
        f"{name}|C loop, fresh": fresh,
    }


def pinocchio_candidates(arm: Arm, q: np.ndarray) -> dict[str, Callable[[], float]]:
    """The same chain as a Pinocchio model, checked for equality before anything is timed."""
    try:
        import pinocchio as pin
    except ImportError:
        return {}
    model, frame = pinocchio_model(arm, pin)
    data = model.createData()
    wanted_p, wanted_R = hand_pose(arm.chain, q[:100], arm.lengths)
    for x, p, R in zip(q[:100], wanted_p, wanted_R, strict=True):
        pin.forwardKinematics(model, data, x)
        T = pin.updateFramePlacement(model, data, frame)
        error = max(np.abs(T.translation - p).max(), np.abs(T.rotation - R).max())
        if not error < 1e-9:
            raise SystemExit(f"Pinocchio's model of {arm.name} differs by {error}")

    def position() -> None:
        pin.forwardKinematics(model, data, q[0])
        pin.updateFramePlacement(model, data, frame)

    def jacobian() -> None:
        position()
        pin.computeFrameJacobian(model, data, q[0], frame, pin.LOCAL_WORLD_ALIGNED)

    return {
        "position|pinocchio from Python n=1": lambda: seconds(position, 500),
        "pose_and_jacobian|pinocchio from Python n=1": lambda: seconds(jacobian, 500),
    }


def pinocchio_model(arm: Arm, pin: object) -> tuple[object, int]:
    """Revolute joints with the fixed parts of every DH row as placements (DH: Rz(θ) is the joint)."""
    value = {**arm.lengths}
    model = pin.Model()
    placement, parent = pin.SE3(arm.chain.base), 0

    def shift(x: float | str) -> float:
        return value[x] if isinstance(x, str) else x

    for link in arm.chain.links:
        x_part = pin.SE3(pin.rpy.rpyToMatrix(link.alpha, 0, 0), np.array([shift(link.a), 0, 0]))
        z_part = pin.SE3(pin.rpy.rpyToMatrix(0, 0, link.theta), np.array([0, 0, shift(link.d)]))
        if arm.chain.convention is DHConvention.MODIFIED:
            placement = placement * x_part
        axis = np.array([0.0, 0.0, float(link.sign)])
        parent = model.addJoint(parent, pin.JointModelRevoluteUnaligned(axis), placement, link.name)
        placement = z_part if arm.chain.convention is DHConvention.MODIFIED else z_part * x_part
    hand = pin.Frame("hand", parent, placement * pin.SE3(arm.chain.tool), pin.FrameType.OP_FRAME)
    return model, model.addFrame(hand)


def measure(arm: Arm, rounds: int) -> Timings:
    q = np.random.default_rng(0).uniform(arm.rom.lower, arm.rom.upper, (LARGE, arm.dof))
    with tempfile.TemporaryDirectory() as folder:
        everything = candidates(arm, q, Path(folder)) | pinocchio_candidates(arm, q)
        samples: dict[str, list[float]] = {key: [] for key in everything}
        for _ in range(rounds + 1):
            for key, run in everything.items():
                samples[key].append(run())
    table: Timings = {}
    for key, values in samples.items():
        quantity, who = key.split("|")
        table.setdefault(who, {})[quantity] = 1e9 * statistics.median(values[1:])
    return table


def show(arm: Arm, table: Timings) -> None:
    print(f"\n{arm.name}: nanoseconds per posture (median)")
    print(f"{'':34}" + "".join(f"{quantity:>20}" for quantity in QUANTITIES))
    for who, row in table.items():
        cells = [f"{row[quantity]:20.1f}" if quantity in row else f"{'-':>20}" for quantity in QUANTITIES]
        print(f"{who:34}" + "".join(cells))
    big, ratios = f"python n={LARGE}", {}
    ratios["python out= / C loop warm"] = (f"{big}, out=", "C loop, warm")
    ratios["python new array / C loop fresh"] = (big, "C loop, fresh")
    ratios["python new array / C loop warm"] = (big, "C loop, warm")
    ratios["python new array / plain C loop warm"] = (big, "plain C loop, warm")
    print("ratios (aim: at most 1.2 with the same kind of memory on both sides)")
    for title, (above, below) in ratios.items():
        print(f"{title:38}" + "".join(f"{table[above][k] / table[below][k]:16.2f}    " for k in QUANTITIES))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="3 rounds instead of 15")
    rounds = 3 if parser.parse_args().quick else 15
    compiler = find_compiler()
    print(
        f"compiler: {compiler.version if compiler else None}; casadi {ca.__version__}; numpy {np.__version__}"
    )
    print(subprocess.run(["uname", "-srm"], capture_output=True, text=True, check=False).stdout.strip())
    print("Pinocchio and CasADi n=1 include the overhead of a Python call, as does python n=1.")
    for arm in (ehmcs(), human(), alfaiz()):
        show(arm, measure(arm, rounds))


if __name__ == "__main__":
    main()
