"""A fitted arm in a few lines of text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from armik_sym.fitting.quality import FitQuality, Misfit

if TYPE_CHECKING:
    from armik_sym.fitting.fitted_arm import FittedArm

# From this share of samples outside the range of motion on, side or axes are more likely wrong than the arm.
_SUSPICIOUS = 0.5
_PER_LINE = 4
# An angle that may be anything has an RMS error of 360°/√12; beyond this one no more can be said.
_ANY = 60.0


def summary(fit: FittedArm) -> str:
    """A short, honest summary for people: degrees and millimetres.

    Args:
        fit: The fitted arm.

    Returns:
        Text of about fifteen lines.

    Source:
        None (reporting).
    """
    return "\n".join([*_head(fit), *_recording(fit.quality), *_rigid(fit.quality), *_angles(fit)])


def _head(fit: FittedArm) -> list[str]:
    quality = fit.quality
    shown = "mirrored to the left arm of the model" if fit.mirrored else "as recorded"
    lines = [
        f"{fit.side} arm ({shown}), {fit.n} of {fit.n + quality.left_out} samples over "
        f"{fit.path.duration:.3g} s, {fit.base} base"
    ]
    for name, s in fit.lengths.items():
        lines.append(
            f"  {name.replace('_', ' '):<15s} {1000 * s.mean:.1f} mm, sd {1000 * s.sd:.1f}, from "
            f"{1000 * s.smallest:.1f} to {1000 * s.largest:.1f}"
            + (f" ({s.outlying} outlying samples not in the mean)" if s.outlying else "")
        )
    moved = ", ".join(f"{1000 * sd:.1f}" for sd in fit.shoulder_sd)
    lines.append(f"  shoulder moved  sd {moved} mm along the axes of the recording")
    return lines


def _recording(quality: FitQuality) -> list[str]:
    noise = ", ".join(f"{point} {1000 * sigma:.2f}" for point, sigma in quality.noise.items())
    turned = "" if np.isnan(quality.turned_noise) else f"; hand {np.rad2deg(quality.turned_noise):.2f}°"
    worst = max(quality.gaps, key=lambda gaps: gaps.longest)
    gaps = f"the longest {worst.longest:.3g} s ({worst.name})" if worst.missing else "none"
    left = f"; {quality.left_out} samples left out" if quality.left_out else ""
    return [
        f"  noise           {noise} mm per coordinate (fourth differences){turned}",
        f"  gaps            {gaps}{left}",
        f"  processing      {quality.processing or 'nothing filled, nothing filtered'}",
    ]


def _rigid(quality: FitQuality) -> list[str]:
    return [
        "  a fixed-length arm with free joints explains the points at best to (rms, largest):",
        f"    fixed base    {_misfits(quality.fixed_base)}",
        f"    moving base   {_misfits(quality.moving_base)}",
    ]


def _misfits(of: Mapping[str, Misfit]) -> str:
    return ", ".join(f"{name} {1000 * m.rms:.1f}, {1000 * m.largest:.1f} mm" for name, m in of.items())


def _angles(fit: FittedArm) -> list[str]:
    degrees = np.rad2deg(fit.quality.angles.total)
    expected = [
        f"{name.replace('_', ' ')} {f'> {_ANY:g}°' if angle > _ANY else f'{angle:.2f}°'}"
        for name, angle in zip(fit.arm.joint_names, degrees, strict=True)
    ]
    lines = ["  expected error of the angles (noise and misfit; skin that slides along is not in it):"]
    lines += [f"    {', '.join(expected[i : i + _PER_LINE])}" for i in range(0, len(expected), _PER_LINE)]
    if fit.outside.any():
        margin = fit.arm.rom.margin(fit.unlimited.q)
        j = int(np.argmin(margin.min(axis=0)))
        lines.append(
            f"  range of motion {int(fit.outside.sum())} samples outside, by up to "
            f"{np.rad2deg(-margin[:, j].min()):.3g}° ({fit.arm.joint_names[j]}); measured angles stop there"
        )
    if fit.outside.mean() > _SUSPICIOUS:
        lines.append("  check           side, frame and points: most samples are outside the range of motion")
    if fit.out_of_reach.any():
        lines.append(f"  out of reach    {int(fit.out_of_reach.sum())} samples: there the arm is straight")
    if fit.straight.any():
        lines.append(
            f"  straight        {int(fit.straight.sum())} samples: the elbow does not tell the swivel"
        )
    return lines
