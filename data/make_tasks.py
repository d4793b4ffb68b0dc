"""Makes the five bundled tasks: synthetic stand-ins for the recordings of Nguyen 2021.

The paper shows its recordings only as figures (8 to 13). These motions have the features its text
describes, and nothing else from it:

- drinking, both stages: q3 and q5 nearly constant; the second ends with the wrist below the mouth;
- brushing: q3 and q5 nearly constant, q2 sinusoidal at the end;
- playing and catching ball: all five joints move, farther and faster.

From profile to file: minimum-jerk pieces between knots, plus a slow sway of ±0.25°; read by the sensors;
smoothed by a zero-phase Butterworth low-pass (order 2 run both ways, 6 Hz); written in degrees with four
decimals. The hand path is computed from the angles *as written*.

The paper names the sensors (potentiometer CPP-35B, encoder E6B2-CWZ6C) but prints neither their resolution
nor which joint has which. Assumed here: encoders on q1 and q2 (heavy, so near the body), 1000 pulses per
turn counted fourfold, 0.09°; potentiometers on q3, q4, q5, 340° over a 12-bit converter, 0.083°, with noise
of 0.05° rms. q6 and q7 are not measured and stay 0. Sampled at 50 to 200 Hz, so that no joint turns by more
than the search window of Table 5, π/100, between two samples.

The same on every machine: noise comes from raw PCG64 integers, numbers are rounded well above the last bit
of a libm, and no value may lie so near a rounding edge that the last bit could decide.

With the package installed, or from the folder of the repository without:

    python data/make_tasks.py [--check] [--folder FOLDER]
    python -m data.make_tasks [--check] [--folder FOLDER]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.motion.rotations import rotations_to_quaternions

Array = NDArray[np.float64]
Knots = Sequence[tuple[float, float]]

COUNT_DEG = (360 / 4000, 360 / 4000, 340 / 4096, 340 / 4096, 340 / 4096)
NOISE_DEG = (0.0, 0.0, 0.05, 0.05, 0.05)
SWAY_DEG, SWAY_HZ = 0.25, 0.3
CUTOFF_HZ = 6.0
LAST_BITS = 1e-13


@dataclass(frozen=True)
class Recipe:
    """One task: knots (time [s], angle [deg]) of q1…q5, and an oscillation of q2 from a time on."""

    title: str
    seed: int
    rate_hz: int
    duration: float
    knots: tuple[Knots, Knots, Knots, Knots, Knots]
    q2_swing: tuple[float, float, float] | None = None  # from [s], amplitude [deg], frequency [Hz]


TASKS: Mapping[str, Recipe] = {
    "drinking_reach": Recipe(
        "Drinking, reaching for the cup", 1, 50, 2.8,
        ([(0.3, 8), (2.2, 15)], [(0.3, 5), (2.4, 46)], [(0.0, 30)], [(0.4, 82), (2.4, 44)], [(0.0, 5)]),
    ),
    "drinking_lift": Recipe(
        "Drinking, lifting the cup to the mouth", 2, 50, 3.4,
        ([(0.5, 15), (2.8, 27)], [(0.3, 46), (2.9, 61)], [(0.0, 30)], [(0.3, 44), (3.0, 125)], [(0.0, 5)]),
    ),
    "brushing": Recipe(
        "Brushing teeth", 3, 100, 6.0,
        ([(0.4, 6), (2.4, 33)], [(0.2, -6), (2.4, 58)], [(0.0, 38)], [(0.3, 34), (2.5, 127)], [(0.0, 28)]),
        q2_swing=(2.4, 7.0, 1.5),
    ),
    "playing_ball": Recipe(
        "Playing ball", 4, 200, 2.6,
        ([(0.2, 12), (1.05, 80), (1.2, 80), (2.3, 35)],
         [(0.2, 25), (1.0, -8), (1.1, -8), (1.75, 62), (2.4, 40)],
         [(0.2, 20), (1.1, -12), (1.2, -12), (1.75, 45), (2.3, 54)],
         [(0.25, 95), (0.95, 112), (1.2, 112), (1.72, 28), (2.3, 48)],
         [(0.3, 0), (1.0, -25), (1.2, -25), (1.8, 48), (2.4, 30)]),
    ),
    "catching_ball": Recipe(
        "Catching a ball", 5, 200, 2.0,
        ([(0.1, 8), (0.85, 34), (1.0, 34), (1.6, 20)],
         [(0.1, 8), (0.9, 74), (1.0, 74), (1.7, 42)],
         [(0.15, 18), (0.9, -12), (1.0, -12), (1.6, 28)],
         [(0.1, 72), (0.8, 26), (0.98, 26), (1.55, 98)],
         [(0.1, 20), (0.85, -55), (1.05, -55), (1.7, -20)]),
    ),
}  # fmt: skip


def minimum_jerk(time: Sequence[float], knots: Knots) -> Array:
    """Angle(t) through the knots, at rest in each: Δ·(10s³ - 15s⁴ + 6s⁵) (Flash & Hogan 1985)."""
    angle = np.full(len(time), float(knots[0][1]))
    for (t0, a), (t1, b) in pairwise(knots):
        s = np.clip((np.array(time) - t0) / (t1 - t0), 0.0, 1.0)
        angle += (b - a) * s * s * s * (10 + s * (6 * s - 15))
    return angle


def uniform(bits: np.random.PCG64, n: int) -> Array:
    """Numbers in [0, 1) from raw integers, whose stream NumPy promises never to change."""
    return np.array([bits.random_raw() >> 11 for _ in range(n)], dtype=np.float64) * 2.0**-53


def noise(bits: np.random.PCG64, n: int) -> Array:
    """Nearly normal numbers of unit variance: the sum of twelve uniform ones, less six."""
    return np.asarray(uniform(bits, 12 * n).reshape(n, 12).sum(axis=1) - 6.0, dtype=np.float64)


def rounded(values: Array, step: float, uncertainty: float) -> Array:
    """Whole numbers of steps; refuses values so near an edge that a libm could decide the outcome."""
    counts = values / step
    edge = np.abs(counts - np.floor(counts) - 0.5).min() * step
    if edge <= uncertainty:
        raise ValueError(f"a value lies {edge:.1g} from a rounding edge of step {step:g}: take another seed")
    return np.asarray(np.rint(counts) + 0.0, dtype=np.float64)


def measured_degrees(recipe: Recipe) -> tuple[Array, list[list[str]]]:
    """Angles of the seven joints as they are written: shape (n, 7) in [deg], and their texts."""
    n = round(recipe.duration * recipe.rate_hz) + 1
    time = [i / recipe.rate_hz for i in range(n)]
    bits = np.random.PCG64(recipe.seed)
    low_pass = butter(2, CUTOFF_HZ, fs=recipe.rate_hz, output="sos")
    q_deg = np.zeros((n, 7))
    for j, knots in enumerate(recipe.knots):
        phase = 2 * math.pi * float(uniform(bits, 1)[0])
        sway = [SWAY_DEG * math.sin(2 * math.pi * SWAY_HZ * t + phase) for t in time]
        angle = minimum_jerk(time, knots) + sway + NOISE_DEG[j] * noise(bits, n)
        if j == 1 and recipe.q2_swing is not None:
            begin, amplitude, hertz = recipe.q2_swing
            grow = minimum_jerk(time, [(begin, 0.0), (begin + 0.4, amplitude)])
            angle += grow * [math.sin(2 * math.pi * hertz * (t - begin)) for t in time]
        counts = rounded(angle, COUNT_DEG[j], LAST_BITS)
        smooth = sosfiltfilt(low_pass, counts * COUNT_DEG[j])
        q_deg[:, j] = rounded(smooth, 1e-4, 100 * LAST_BITS) / 1e4
    texts = [[f"{t:.3f}", *(f"{x:.4f}" for x in row)] for t, row in zip(time, q_deg.tolist(), strict=True)]
    return q_deg, texts


def hand_texts(q_deg: Array, times: list[str]) -> list[list[str]]:
    """Position [mm] with eight decimals and quaternion with ten, of the angles as written."""
    arm = ehmcs()
    position, rotation = hand_pose(arm.chain, np.deg2rad(q_deg), arm.lengths)
    mm = rounded(1e3 * position, 1e-8, 3 * LAST_BITS) / 1e8
    quaternion = rounded(rotations_to_quaternions(rotation), 1e-10, 1e-15) / 1e10
    return [
        [t, *(f"{x:.8f}" for x in p), *(f"{x:.10f}" for x in q)]
        for t, p, q in zip(times, mm.tolist(), quaternion.tolist(), strict=True)
    ]


def table(recipe: Recipe, what: str, header: Sequence[str], rows: list[list[str]]) -> str:
    """The text of one file."""
    lines = [
        f"# {recipe.title}: {what}",
        "# note: Synthetic data: made to resemble Nguyen 2021, not recorded from a person",
        "# SYNTHETIC: made by data/make_tasks.py, not measured; the recordings of Nguyen 2021 were never "
        "published.",
        f"# Arm ehmcs, {recipe.rate_hz} Hz; minimum-jerk profiles read by assumed sensors: encoders on q1, "
        "q2 (4000 counts/turn),",
        "# potentiometers on q3, q4, q5 (340 deg over 12 bits, noise 0.05 deg rms); q6, q7 not measured; "
        "then a zero-phase",
        "# Butterworth low-pass (order 2 run both ways, 6 Hz).",
        ",".join(header),
        *(",".join(row) for row in rows),
    ]
    return "\n".join(lines) + "\n"


def make_files() -> dict[str, str]:
    """All ten files: text by file name."""
    files = {}
    angle_header = ["time [s]", *(f"{name} [deg]" for name in ehmcs().joint_names)]
    path_header = ["time [s]", "x [mm]", "y [mm]", "z [mm]", "qw [-]", "qx [-]", "qy [-]", "qz [-]"]
    for name, recipe in TASKS.items():
        q_deg, texts = measured_degrees(recipe)
        hand = hand_texts(q_deg, [row[0] for row in texts])
        files[f"{name}_angles.csv"] = table(recipe, "joint angles", angle_header, texts)
        files[f"{name}_path.csv"] = table(recipe, "path of the hand (wrist)", path_header, hand)
    return files


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the files, or compare them with those on disk; returns the exit code."""
    parser = argparse.ArgumentParser(description="Make the five bundled tasks (synthetic).")
    parser.add_argument("--check", action="store_true", help="compare with the files on disk, write nothing")
    parser.add_argument("--folder", type=Path, default=Path(__file__).resolve().parent / "tasks")
    options = parser.parse_args(arguments)
    different = []
    for name, text in make_files().items():
        target = options.folder / name
        if not options.check:
            target.write_text(text, encoding="utf-8", newline="\n")
        elif not target.is_file() or target.read_text(encoding="utf-8") != text:
            different.append(name)
    if different:
        sys.stderr.write(f"not as made by make_tasks.py: {', '.join(different)}\n")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
