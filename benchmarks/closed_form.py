"""The closed form over the swivel angle: 100,000 random poses on all branches, exactness and time.

    python benchmarks/closed_form.py

For every arm: random postures inside the range of motion give poses; each is solved at a random swivel angle
on all eight branches and put back through the generated forward kinematics; and each posture is recovered on
its own branch at its own swivel angle. The time is that of one posture from one pose (curve and angles), as a
multiple of one generated forward kinematics + Jacobian, one posture at a time, of the same run; both in
arrays that stay in cache.
"""

from __future__ import annotations

import argparse
import ctypes
import sys
import time

import numpy as np
from trajectory import kinematics_times

import armik_sym as ak
from armik_sym.compiled.address import address
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.c_structs import CCurves
from armik_sym.swivel.closed_form import pose_curve
from armik_sym.swivel.geometry import pose_geometry
from armik_sym.swivel.library import swivel_library
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import SphericalArm, recognise

AIM_POSE = 1e-12  # [m], [rad]
AIM_POSTURE = 1e-9  # [rad]
AIM_MULTIPLE = 3.0
_IN_CACHE = 500
SIGNS = [(e, s, w) for e in (1, -1) for s in (1, -1) for w in (1, -1)]


def turned_away(R: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Angles between rotations, small ones without loss of digits, shape (n,)."""
    return 2 * np.arcsin(np.minimum(np.linalg.norm(R - other, axis=(1, 2)) / np.sqrt(8), 1.0))


def measure(arm: ak.Arm, n: int, seed: int) -> dict[str, float]:
    """Largest errors over n poses and all branches, and the time of one posture."""
    rng = np.random.default_rng(seed)
    kinematics, spherical = ak.compile(arm), recognise(arm)
    q = arm.rom.random_postures(rng, n)
    position, rotation = kinematics.position(q), kinematics.rotation(q)
    found = {"position": 0.0, "rotation": 0.0}
    curves = tuple(pose_curve(spherical, position, rotation, side) for side in (1, -1))
    sample = np.arange(n)
    for branch in range(8):
        psi = rng.uniform(-np.pi, np.pi, n)
        solved = postures_at(curves, sample, branch, psi).q
        shift = np.linalg.norm(kinematics.position(solved) - position, axis=1)
        turn = turned_away(kinematics.rotation(solved), rotation)
        found["position"] = max(found["position"], float(shift.max()))
        found["rotation"] = max(found["rotation"], float(turn.max()))
    at = swivel_of_postures(spherical, q)
    signs = np.column_stack([at.elbow, at.shoulder, at.wrist])
    branch = (signs[:, None] == np.array(SIGNS)[None]).all(axis=2).argmax(axis=1)
    again = postures_at(curves, sample, branch, at.psi, wish=q).q
    clear = np.abs(at.sines).min(axis=1) > 1e-4  # beside a pole the outer angles are one number
    found["recovered"] = float(np.abs(again - q)[clear].max())
    found["multiple"] = posture_time(spherical, position, rotation) / kinematics_times(arm)[0]
    return found


def posture_time(spherical: SphericalArm, position: np.ndarray, rotation: np.ndarray) -> float:
    """Seconds for one posture from one pose: the curve, then the angles at a swivel angle."""
    p, R, chosen = position[:_IN_CACHE], rotation[:_IN_CACHE], np.arange(_IN_CACHE)
    pose, geometry = np.hstack([p, R.reshape(-1, 9)]), pose_geometry(spherical)
    psi = np.linspace(-3.0, 3.0, _IN_CACHE)
    curves = tuple(pose_curve(spherical, p, R, side) for side in (1, -1))
    library, best = swivel_library(), [np.inf, np.inf]
    if library is None:
        raise SystemExit("this benchmark needs a C compiler")
    side, reference, out = np.ones(1), spherical.reference, np.empty((_IN_CACHE, 58))
    inputs = [(pose, 12), (geometry, 0), (side, 0), (reference, 0)]
    places = [part for array, step in inputs for part in (address(array), ctypes.c_ssize_t(step))]
    branch, q, sines = np.zeros(_IN_CACHE, dtype=np.int64), np.empty((_IN_CACHE, 7)), np.empty((_IN_CACHE, 2))
    c_curves, wish = CCurves(*curves), address(None)
    points = [address(array) for array in (chosen, branch, psi)]
    for _ in range(2_000):
        began = time.perf_counter()
        library.handle.armik_swivel_curve_rows(ctypes.c_ssize_t(_IN_CACHE), *places, address(out))
        middle = time.perf_counter()
        library.handle.armik_swivel_postures(
            *c_curves.arguments, ctypes.c_ssize_t(_IN_CACHE), *points, wish, ctypes.c_ssize_t(0),
            address(q), address(sines),
        )  # fmt: skip
        best = [min(best[0], middle - began), min(best[1], time.perf_counter() - middle)]
    return sum(best) / _IN_CACHE


def main(n: int) -> int:
    """Print the table."""
    print(f"{n} random poses, all branches\narm      position [m]  rotation [rad]  recovered [rad]  FK + J")
    good = True
    for arm in (ak.catalog.ehmcs(), ak.catalog.human(), ak.catalog.alfaiz()):
        m = measure(arm, n, seed=1)
        print(
            f"{arm.name:8s} {m['position']:12.1e}  {m['rotation']:14.1e}  {m['recovered']:15.1e}  "
            f"{m['multiple']:6.2f}"
        )
        good &= max(m["position"], m["rotation"]) <= AIM_POSE and m["recovered"] <= AIM_POSTURE
        good &= m["multiple"] <= AIM_MULTIPLE
    print("as it should be" if good else "NOT as it should be")
    return 0 if good else 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--poses", type=int, default=100_000)
    sys.exit(main(parser.parse_args().poses))
