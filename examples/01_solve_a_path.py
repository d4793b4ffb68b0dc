"""A hand path in, the whole joint trajectory out."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import armik_sym as ak


def main(out: Path = Path("armik_out")) -> int:
    """Solve a bundled synthetic task, print the verdict and save the angles."""
    arm = ak.catalog.ehmcs()
    task = ak.load_task("drinking_lift")  # synthetic; read your own with ak.read_path("my_path.csv")

    solution = ak.solve(arm, task.path)
    print(solution)

    assert solution.ok, solution.reasons
    print("largest angles [deg]:", np.rad2deg(solution.q.max(axis=0)).round(1))
    out.mkdir(exist_ok=True)
    print("saved", solution.save(out / "drinking_lift.csv"))
    return 0


if __name__ == "__main__":
    main()
