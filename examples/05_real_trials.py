"""Real arms: the wrist path and hand orientation of recorded trials, solved from cold.

Needs the recordings of the UE_ADL database as csv + json (folder given as the first argument). The
recordings are not part of this project. A fixed-length arm on a fixed shoulder cannot follow them
exactly: in the data the shoulder moves and the forearm changes its length by millimetres, and limits
of the model may be narrower than what a person did. So tracking is soft.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.comparison.elbow import elbow_position

# Torso axes of the recordings (x forward, y up, z right) to the base of the arm (x up, y right, z forward).
BASE_FROM_TORSO = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
# The catalogue's human arm is a left arm; a right arm is solved as its mirror image.
MIRROR = np.diag([1.0, -1.0, 1.0])


@dataclass(frozen=True)
class Trial:
    """One recorded trial in the arm's base frame.

    Attributes:
        name: Name of the file.
        task: What the person did.
        arm: Human arm with this person's segment lengths, ending at the wrist.
        path: Wrist path from the shoulder centre, with the orientation of the hand.
        elbow: Measured elbow from the shoulder centre, shape (n, 3), in [m].
    """

    name: str
    task: str
    arm: ak.Arm
    path: ak.HandPath
    elbow: np.ndarray


def load_trial(file: Path) -> Trial:
    """Read one trial; both sides end up in the frame of a left arm."""
    facts = json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))
    data = np.genfromtxt(file, delimiter=",", names=True)
    right = facts["side"] == "right"
    to_base = (MIRROR if right else np.eye(3)) @ BASE_FROM_TORSO

    def points(name: str) -> np.ndarray:
        return np.stack([data[name + axis] for axis in "xyz"], axis=1)

    shoulder = points("s")
    quaternion = np.stack([data["qH" + part] for part in "wxyz"], axis=1)
    hand = ak.HandPath.from_quaternions(data["t"], points("w"), quaternion).rotation
    # Recorded hand axes: x towards the palm, y towards the elbow, z to the right in anatomical position.
    palm, elbow_ward, rightward = (hand[:, :, i] @ to_base.T for i in range(3))
    fingers, back_of_hand = -elbow_ward, -palm
    ulnar = -rightward if right else rightward
    path = ak.HandPath(
        data["t"],
        (points("w") - shoulder) @ to_base.T,
        np.stack([fingers, ulnar, back_of_hand], axis=2),
    )
    arm = ak.catalog.human(facts["quality"]["upper_arm_m"], facts["quality"]["forearm_m"], hand=0.0)
    task = file.stem.split("_ADL")[0].rsplit("_", 1)[0]
    return Trial(file.stem, task, arm, path, (points("e") - shoulder) @ to_base.T)


def main(folder: Path) -> int:
    """Solve all trials and print a table per task."""
    rows = defaultdict(list)
    for file in sorted(folder.glob("*.csv")):
        trial = load_trial(file)
        solution = ak.solve(trial.arm, trial.path, tracking="soft")
        off = np.linalg.norm(elbow_position(solution.arm, solution.q) - trial.elbow, axis=1)
        rows[trial.task].append(
            [
                1000 * solution.position_error.max(),
                np.rad2deg(solution.rotation_error.max()),
                np.rad2deg(solution.rom_margin.min()),
                np.rad2deg(solution.max_step.max()),
                1000 * np.sqrt(np.mean(off**2)),
            ]
        )
        print(f"{trial.name:28s} {'ok' if solution.ok else 'NOT ok: ' + '; '.join(solution.reasons)}")
    if not rows:
        print(f"no trials in {folder}")
        return 1
    print("\nworst of each task  position [mm]  rotation [°]  margin [°]  step [°]  elbow rms [mm]  trials")
    for task, values in rows.items():
        position, rotation, margin, step, elbow = np.array(values).T
        print(
            f"{task:18s} {position.max():14.2f} {rotation.max():13.2f} {margin.min():11.2g} "
            f"{step.max():9.2f} {np.median(elbow):11.0f} (med) {len(values):6d}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "../shared/data/human_motion")))
