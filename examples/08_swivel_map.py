"""The swivel map: where the elbow can be on a hand path, which choices there are, what stops a patient."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.report import save_figure


def main(out: Path = Path("armik_out")) -> int:
    """Map a task for a healthy arm, another with two choices, and one for a patient; draw them."""
    out.mkdir(exist_ok=True)
    arm, task = ak.catalog.ehmcs(), ak.load_task("catching_ball")

    healthy = ak.swivel_map(arm, task.path)
    print(healthy)
    psi, branch = healthy.swivel_of(task.measured)
    print(
        f"measured: swivel {np.rad2deg(psi.min()):.0f}° to {np.rad2deg(psi.max()):.0f}°, branch {branch[0]}"
    )
    elbow_higher = healthy.postures(psi + np.deg2rad(20), branch)  # the same hand path, another elbow
    inside = healthy.contains(psi + np.deg2rad(20), branch).all()
    print(f"elbow 20° higher: {'inside' if inside else 'outside'} the range of motion")
    figure = healthy.plot(
        task.measured, compare={"elbow 20° higher": elbow_higher}, title=f"{task.title} (synthetic)"
    )
    print(f"figure: {save_figure(figure, out / 'swivel_map.png')}\n")

    ball = ak.load_task("playing_ball")
    best = ak.solve(arm, ball.path, n_best=2)  # genuinely different trajectories, the best first
    print(best)
    others = {f"choice {number}": other for number, other in enumerate(best.alternatives, start=2)}
    figure = ak.swivel_map(arm, ball.path).plot(best, others, title=f"{ball.title} (synthetic)")
    print(f"figure: {save_figure(figure, out / 'swivel_map_choices.png')}\n")

    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    upper[arm.joint_index("elbow_flexion")] = np.deg2rad(110)  # a stiff elbow
    drinking = ak.load_task("drinking_lift")
    patient = ak.swivel_map(arm.with_rom(lower, upper), drinking.path)
    print("the same for an elbow that bends to 110°, lifting a cup:")
    print("\n".join(patient.explain_blocked()))
    figure = patient.plot(compare={"measured": drinking.measured}, title=f"{drinking.title} (synthetic)")
    print(f"figure: {save_figure(figure, out / 'swivel_map_patient.png')}")
    return 0


if __name__ == "__main__":
    main()
