"""A motion followed by its servos on one page: how far joints and hand are off, and what the drives give."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from armik_sym.report.page import new_figure
from armik_sym.report.style import (
    FAINT,
    LIMIT,
    MEASURED,
    SOLVED,
    TEXT_SIZE,
    remark,
    style_axes,
)
from armik_sym.report.words import joint_title

if TYPE_CHECKING:
    from armik_sym.servo.check import ServoCheck

Array = NDArray[np.float64]

_COLUMNS = 3
_PANEL = (2.9, 2.3)
_WIDTH = 170
_HEADROOM = 1.2


def servo_figure(check: ServoCheck, *, title: str | None = None) -> Figure:
    """Draw a servo check: for every joint tracking error and torque against its limits, and the hand.

    Args:
        check: The check.
        title: What the motion is.

    Returns:
        A figure; errors in [deg] and [mm], torques in [Nm], time in [s].

    Source:
        None (reporting).
    """
    arm = check.setup.arm
    rows = -(-(arm.dof + 1) // _COLUMNS)
    figure, grid = new_figure(_title(check, title), _lines(check), rows, _COLUMNS, _PANEL)
    for j in range(arm.dof):
        cell = grid[divmod(j, _COLUMNS)].subgridspec(2, 1, hspace=0.35)
        upper = figure.add_subplot(cell[0])
        _draw_error(upper, check, j)
        _draw_torque(figure.add_subplot(cell[1], sharex=upper), check, j)
    row, column = divmod(arm.dof, _COLUMNS)
    _draw_hand(figure.add_subplot(grid[row, column]), check)
    return figure


def _title(check: ServoCheck, title: str | None) -> str:
    verdict = "the drives can follow" if check.ok else "the drives CANNOT follow"
    facts = f"arm {check.setup.arm.name}, drive {check.setup.drive.name}: {verdict}"
    return f"{title}: {facts}" if title else facts[:1].upper() + facts[1:]


def _lines(check: ServoCheck) -> list[str]:
    options = check.setup.options
    first = (
        f"Controller {options.controller}, {options.bandwidth:g} Hz, feed-forward {options.feedforward}, "
        f"{check.setup.rate:g} Hz. Upper panels: angle reached minus wanted. Lower: torque given (blue), "
        "wanted (orange)."
    )
    reasons = textwrap.shorten("; ".join(check.reasons), _WIDTH, placeholder=" …")
    return [textwrap.shorten(first, _WIDTH, placeholder=" …"), *([reasons] if reasons else [])]


def _draw_error(axes: Axes, check: ServoCheck, j: int) -> None:
    tracking, joint = check.tracking, check.joints[j]
    error = np.rad2deg(tracking.joint_error[:, j])
    style_axes(axes, joint_title(joint.name), "", "off [deg]")
    axes.tick_params(labelbottom=False)
    axes.plot(tracking.time, error, color=SOLVED if joint.ok else MEASURED, linewidth=1.2)
    largest = float(np.abs(error).max())
    remark(axes, f"at most {largest:.2g}°")
    allowed = float(np.rad2deg(check.tolerances.joint))
    half = _HEADROOM * max(largest, 1e-6)
    if allowed <= half:
        for sign in (-1, 1):
            axes.axhline(sign * allowed, color=LIMIT, linewidth=0.9, linestyle="--")
    axes.set_ylim(-half, half)
    axes.set_xlim(0.0, float(tracking.time[-1]))
    _few_ticks(axes)


def _draw_torque(axes: Axes, check: ServoCheck, j: int) -> None:
    tracking, joint = check.tracking, check.joints[j]
    reference = tracking.reference
    needed = check.setup.torque_needed(reference.q, reference.speed, reference.acceleration)[:, j]
    given = tracking.run.torque[:, j]
    style_axes(axes, "", "time [s]", "torque [Nm]")
    axes.plot(tracking.time, given, color=SOLVED, linewidth=1.2)
    axes.plot(tracking.time, needed, color=MEASURED, linewidth=0.9, linestyle=(0, (3, 2)))
    shown = max(float(np.abs(given).max()), min(joint.torque, joint.torque_limit))
    half = _HEADROOM * max(shown, 1e-6)
    for limit, style in ((joint.torque_limit, "--"), (joint.torque_rated, ":")):
        if limit <= half:
            for sign in (-1, 1):
                axes.axhline(sign * limit, color=LIMIT, linewidth=0.9, linestyle=style)
    axes.set_ylim(-half, half)
    remark(axes, f"limits: {joint.torque_rated:.3g} all day, {joint.torque_limit:.3g} peak")
    _few_ticks(axes)


def _draw_hand(axes: Axes, check: ServoCheck) -> None:
    tracking = check.tracking
    error = 1000 * tracking.hand_error
    style_axes(axes, "Hand", "time [s]", "off [mm]")
    axes.plot(tracking.time, error, color=SOLVED, linewidth=1.4)
    axes.fill_between(tracking.time, error, color=SOLVED, alpha=0.15, linewidth=0)
    top = _HEADROOM * max(float(error.max()), 1e-6)
    axes.set_ylim(0.0, top)
    axes.set_xlim(0.0, float(tracking.time[-1]))
    remark(axes, f"RMS {1000 * tracking.hand_rms:.2g} mm, at most {1000 * tracking.hand_peak:.2g} mm")
    allowed = 1000 * check.tolerances.hand
    if allowed <= top:
        axes.axhline(allowed, color=LIMIT, linewidth=0.9, linestyle="--")
        axes.text(
            0.99, allowed, f"allowed {allowed:.3g} mm ", ha="right", va="bottom",
            fontsize=TEXT_SIZE, color=FAINT, transform=axes.get_yaxis_transform(),
        )  # fmt: skip


def _few_ticks(axes: Axes) -> None:
    from matplotlib.ticker import MaxNLocator

    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.tick_params(axis="y", labelsize=TEXT_SIZE - 1)
