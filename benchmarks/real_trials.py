"""What methods predict from the hand path and the first posture, beside what 6 people did in 27 real trials.

    python benchmarks/real_trials.py                       the tables of docs/recordings.md
    python benchmarks/real_trials.py --trials              and one line per trial
    python benchmarks/real_trials.py --recordings DIR      write the trials as files for `armik compare`

Needs the trials of the UE_ADL database as csv + json (`--data DIR`), which are not part of this project.
Their markers, in a torso-fixed frame, and the orientation of the hand go through `ak.fit_arm` as they are:
nothing is filtered, filled or cut. The arm is that of the catalogue with the person's segment lengths,
standing at the mean shoulder, with the range of motion of the model, or widened by what was measured.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.comparison import Comparison, compare, constant_swivel, predict
from armik_sym.fitting import FittedArm
from armik_sym.motion.marker_csv import write_marker_csv
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.rotations import quaternions_to_rotations

FRAME = "x forward, y up, z right"
HAND_AXES = "x palmar, y proximal"
POINTS = {"shoulder": "s", "elbow": "e", "wrist": "w"}
# Points of the hand in the files for `armik compare`: they carry the recorded orientation, in [m].
HAND_LENGTH, HAND_WIDTH = 0.08, 0.06

METHODS = ("whole trajectory", "Pro-ISADE", "swivel constant", "same, from below")


@dataclass(frozen=True)
class Trial:
    """One recorded trial.

    Attributes:
        name: Name of the file.
        task: What the person did.
        side: "left" or "right".
        recording: Shoulder centre, elbow and wrist in the torso frame.
        hand: Orientation of the hand as quaternions (w, x, y, z), shape (n, 4).
    """

    name: str
    task: str
    side: str
    recording: MarkerRecording
    hand: np.ndarray

    def fit(self, rom: str | None) -> FittedArm:
        """The arm of the person, the path of the wrist and the measured angles."""
        return ak.fit_arm(
            self.recording, POINTS, self.side, FRAME, hand_rotation=self.hand, hand_axes=HAND_AXES, rom=rom
        )


def load_trial(file: Path) -> Trial:
    """Read one trial."""
    facts = json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))
    data = np.genfromtxt(file, delimiter=",", names=True)
    markers = np.stack(
        [np.stack([data[name + axis] for axis in "xyz"], axis=1) for name in POINTS.values()], axis=1
    )
    recording = MarkerRecording(
        data["t"], tuple(POINTS.values()), markers, source=file.stem, declared_rate=facts["rate_hz"]
    )
    task = file.stem.split("_ADL")[0].rsplit("_", 1)[0].replace("_", " ")
    hand = np.stack([data["qH" + part] for part in "wxyz"], axis=1)
    return Trial(file.stem, task, facts["side"], recording, hand)


def write_recording(trial: Trial, folder: Path) -> Path:
    """Write a trial as a marker file with its own list of points, as `armik compare` takes them.

    The orientation of the hand becomes two points: one along the fingers, one towards the ulnar side.
    """
    rotation = quaternions_to_rotations(trial.hand)
    fingers, rightward = -rotation[:, :, 1], rotation[:, :, 2]
    ulnar = -rightward if trial.side == "right" else rightward
    shoulder, elbow, wrist = (trial.recording.of(name) for name in POINTS.values())
    hand = wrist + HAND_LENGTH * fingers
    markers = {
        "shoulder": shoulder,
        "elbow": elbow,
        "wrist": wrist,
        "hand": hand,
        "hand_ulnar": wrist + HAND_WIDTH * ulnar,
    }
    file = folder / f"{trial.name}.csv"
    position = np.stack(list(markers.values()), axis=1)
    note = f"{trial.name} of the UE_ADL database; hand points made from the recorded orientation"
    write_marker_csv(file, MarkerRecording(trial.recording.time, tuple(markers), position, note, trial.name))
    points = "\n".join(f'{name} = "{name}"' for name in markers)
    text = f'side = "{trial.side}"\nframe = "{FRAME}"\n[points]\n{points}\n'
    file.with_suffix(".toml").write_text(text, encoding="utf-8")
    return file


def comparisons(fitted: FittedArm, tracking: str) -> dict[str, Comparison]:
    """Each method from the first measured posture only, beside the measured motion."""
    arm, path, measured = fitted.arm, fitted.path, fitted.unlimited
    first = measured.q[0]
    soft = "exact" if tracking == "exact" else "soft"
    solutions = (
        predict(arm, path, first, "trajectory", tracking=soft),
        predict(arm, path, first, "pro-isade"),
        constant_swivel(arm, path, first),
        constant_swivel(arm, path, first, zero="down"),
    )
    return {name: compare(each, measured) for name, each in zip(METHODS, solutions, strict=True)}


def numbers(comparison: Comparison) -> tuple[float, ...]:
    """RMS of joints, RMS and largest of swivel [deg] and elbow [mm], largest joint speed [deg/s]."""
    swivel, elbow = comparison.swivel_summary, comparison.elbow_summary
    if swivel is None or elbow is None:
        raise SystemExit("the arm has no swivel angle")
    return (
        np.rad2deg(comparison.all_joints.rms), np.rad2deg(swivel.rms), np.rad2deg(swivel.max),
        1000 * elbow.rms, 1000 * elbow.max, np.rad2deg(comparison.solution.max_speed.max()),
    )  # fmt: skip


def table(rows: dict[str, dict[str, list[tuple[float, ...]]]]) -> Iterator[str]:
    """One line per task and method: median and, in brackets, worst of the trials."""
    yield (
        "| task (trials) | method | joints, RMS [°] | swivel, RMS [°] | swivel, largest [°] "
        "| elbow, RMS [mm] | elbow, largest [mm] | fastest joint [°/s] |"
    )
    yield "|---|---|" + "--:|" * 6
    for task, by_method in rows.items():
        for method, values in by_method.items():
            middle, worst = np.median(values, axis=0), np.max(values, axis=0)
            cells = [
                f"{m:.{digits}f} ({w:.{digits}f})"
                for m, w, digits in zip(middle, worst, (1, 1, 0, 0, 0, 0), strict=True)
            ]
            yield f"| {task} ({len(values)}) | {method} | {' | '.join(cells)} |"


def main() -> None:
    """Run all trials and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=Path, default=Path("../shared/data/human_motion"))
    parser.add_argument("--recordings", type=Path, help="write marker files here instead")
    parser.add_argument("--tracking", choices=("soft", "exact"), default="soft")
    parser.add_argument("--trials", action="store_true", help="one line per trial, too")
    asked = parser.parse_args()
    files = sorted(asked.data.glob("*.csv"))
    if not files:
        raise SystemExit(f"no trials in {asked.data}")
    if asked.recordings is not None:
        asked.recordings.mkdir(parents=True, exist_ok=True)
        for file in files:
            print(write_recording(load_trial(file), asked.recordings))
        return
    trials = [load_trial(file) for file in files]
    for rom, words in ((None, "range of motion of the model"), ("widened", "widened by what was measured")):
        print(f"\n{words}\n")
        run(trials, rom, asked.tracking, asked.trials)


def run(trials: list[Trial], rom: str | None, tracking: str, each: bool) -> None:
    """Compare all trials and print the table."""
    rows: dict[str, dict[str, list[tuple[float, ...]]]] = defaultdict(lambda: defaultdict(list))
    misfits, outside = [], 0
    for trial in trials:
        fitted = trial.fit(rom)
        misfits.append(1000 * fitted.quality.fixed_base["elbow"].rms)
        outside += bool(fitted.outside.any())
        for method, comparison in comparisons(fitted, tracking).items():
            found = numbers(comparison)
            for group in (trial.task, "all"):
                rows[group][method].append(found)
            if each:
                words = "; ".join(comparison.solution.reasons) or "ok"
                print(f"{trial.name:26} {method:17}" + "".join(f"{v:8.1f}" for v in found) + f"  {words}")
    rows["all"] = rows.pop("all")
    print("\n".join(table(rows)))
    print(
        f"\nBest any rigid arm on a fixed shoulder can do with free joints, elbow RMS: median "
        f"{np.median(misfits):.1f} mm, worst {max(misfits):.1f} mm. Measured angles leave the range of "
        f"motion in {outside} of {len(trials)} trials."
    )


if __name__ == "__main__":
    main()
