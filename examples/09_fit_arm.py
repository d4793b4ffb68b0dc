"""An arm fitted to recorded points: lengths, hand path, joint angles, and how far they can be trusted.

Without an argument the markers of a made-up movement are fitted, with noise and a gap in them. With a folder
of trials of the UE_ADL database (csv + json, no part of this project) there is a table of all of them.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import armik_sym as ak
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.motion.marker_recording import MarkerRecording


def made_up_markers() -> MarkerRecording:
    """Two seconds of a left arm at 100 Hz, with noise of 0.5 mm; the hand is not seen for 50 ms."""
    arm = ak.catalog.human(upper_arm=0.30, forearm=0.25, hand=0.09)
    t = np.arange(200) / 100
    rest = np.deg2rad([20.0, 15.0, 5.0, 50.0, -10.0, 0.0, 5.0])
    swing = np.deg2rad([30.0, 10.0, 10.0, 40.0, 20.0, 15.0, 10.0])
    q = rest + swing * (0.5 - 0.5 * np.cos(np.pi * t))[:, None]
    frames = joint_frames(arm.chain, q, arm.lengths)
    elbow, hand, R = frames[:, 3, :3, 3], frames[:, -1, :3, 3], frames[:, -1, :3, :3]
    wrist = hand - 0.09 * R[:, :, 0]
    side = 0.035 * R[:, :, 1]
    position = np.stack([np.zeros_like(hand), elbow, wrist, hand - side, hand + side], axis=1)
    position = position + 0.0005 * np.random.default_rng(0).normal(size=position.shape)
    position[120:125, 4] = np.nan
    return MarkerRecording(t, ("SHO", "ELB", "WRI", "MCP2", "MCP5"), position, source="made-up markers")


@dataclass(frozen=True)
class Trial:
    """One recorded trial.

    Attributes:
        recording: Shoulder, elbow and wrist in axes of the torso: x forward, y up, z right.
        hand: Orientation of the hand in these axes, quaternions (w, x, y, z), shape (n, 4).
        facts: The json file: side, lengths, quality of the data.
        columns: All columns of the csv file by name.
    """

    recording: MarkerRecording
    hand: np.ndarray
    facts: dict[str, Any]
    columns: np.ndarray


def load_trial(file: Path) -> Trial:
    """Read one trial; the json file states the units: metres and degrees."""
    facts = json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))
    columns = np.genfromtxt(file, delimiter=",", names=True)
    points = ("s", "e", "w")
    position = np.stack(
        [np.stack([columns[point + axis] for axis in "xyz"], axis=1) for point in points], axis=1
    )
    recording = MarkerRecording(
        columns["t"], points, position, source=file.name, declared_rate=facts["rate_hz"]
    )
    return Trial(recording, np.stack([columns["qH" + part] for part in "wxyz"], axis=1), facts, columns)


def fit_trial(trial: Trial, **options: Any) -> ak.FittedArm:
    """Fit the arm of one trial."""
    given = {"side": trial.facts["side"], "frame": "x forward, y up, z right", **options}
    return ak.fit_arm(
        trial.recording,
        {"shoulder": "s", "elbow": "e", "wrist": "w"},
        hand_rotation=trial.hand,
        hand_axes="x palmar, y proximal",
        **given,
    )


def table(folder: Path) -> None:
    """Fit all trials of a folder and print a line for each."""
    files = sorted(folder.glob("*.csv"))
    print("trial                        upper arm, forearm [mm]   outside   expected error of the angles [°]")
    for file in files:
        fit = fit_trial(load_trial(file))
        arm, fore = (1000 * fit.lengths[name].mean for name in ("upper_arm", "forearm"))
        errors = " ".join(f"{angle:5.1f}" for angle in np.rad2deg(fit.quality.angles.total))
        print(f"{file.stem:28s} {arm:10.1f} {fore:10.1f} {100 * fit.outside.mean():12.0f} %   {errors}")
    if not files:
        print(f"no trials in {folder}")


def made_up() -> None:
    """Fit made-up markers, solve the hand path, and compare."""
    points = {
        "shoulder": "SHO",
        "elbow": "ELB",
        "wrist": "WRI",
        "hand_radial": "MCP2",
        "hand_ulnar": "MCP5",
    }
    fit = ak.fit_arm(made_up_markers(), points, side="left", frame="x up, y right, z forward")
    print(fit)
    solution = ak.solve(fit.arm, fit.path, start=fit.measured.q[0])
    apart = np.rad2deg(np.abs(solution.q - fit.measured.q).mean(axis=0))
    print("\nsolved from the first posture on, against measured (mean difference):")
    for name, angle in zip(fit.arm.joint_names, apart, strict=True):
        print(f"  {name:28s} {angle:6.2f}°")


if __name__ == "__main__":
    if len(sys.argv) > 1 and Path(sys.argv[1]).is_dir():
        table(Path(sys.argv[1]))
    else:
        made_up()
