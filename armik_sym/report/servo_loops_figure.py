"""Bode plots and step responses of the loops of all joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter
from numpy.typing import NDArray

from armik_sym.report.page import new_figure
from armik_sym.report.style import FAINT, INK, LIMIT, TEXT_SIZE, remark, style_axes
from armik_sym.report.words import joint_title

if TYPE_CHECKING:
    from armik_sym.servo.margins import LoopMargins
    from armik_sym.servo.setup import Setup

Array = NDArray[np.float64]

_PANEL = (3.6, 2.6)
_POINTS = 600
_LOWEST_HZ = 0.1
_STEP_TIME = 6.0
# Okabe and Ito, without yellow; line styles repeat what colour says.
_LOOKS = (
    ("#0072B2", "-"), ("#D55E00", "-"), ("#009E73", "-"), ("#CC79A7", "-"),
    ("#56B4E9", "-"), ("#E69F00", "--"), ("#000000", ":"),
)  # fmt: skip


def servo_loops_figure(setup: Setup, margins: Sequence[LoopMargins]) -> Figure:
    """Draw the loops: gain and phase of each loop cut at the torque, its sensitivity, its answer to a step.

    Args:
        setup: Arm, drives and controllers.
        margins: Of the loops, one per joint.

    Returns:
        A figure; frequency in [Hz], gain in [dB], phase in [deg], angle relative to the step.

    Source:
        Åström & Murray 2008, §8.4, §11.1; step responses by python-control.
    """
    from armik_sym.servo.controller import Cascade
    from armik_sym.servo.linear import in_series
    from armik_sym.servo.tuning import position_loop

    loops = [
        in_series(law.sampled(plant.step), plant.sampled())
        for law, plant in zip(setup.controllers, setup.plants, strict=True)
    ]
    options = setup.options
    lines = [
        f"Loops cut at the torque; vertical lines: crossovers. Asked for: {options.bandwidth:g} Hz, "
        f"{math.degrees(options.margin):.3g}° of the "
        f"{'position loop' if options.controller == 'cascade' else 'loop'}."
    ]
    title = f"Servo loops: arm {setup.arm.name}, drive {setup.drive.name}, controller {options.controller}"
    figure, grid = new_figure(title, lines, 2, 2, _PANEL)
    panels = [figure.add_subplot(grid[divmod(i, 2)]) for i in range(4)]
    hz = np.geomspace(_LOWEST_HZ, 0.4999 * setup.rate, _POINTS)
    for j, loop in enumerate(loops):
        _draw_bode(panels[0], panels[1], panels[2], hz, loop.response(2 * math.pi * hz), j, margins[j])
        law = setup.controllers[j]
        outer = position_loop(setup.plants[j], law) if isinstance(law, Cascade) else loop
        _draw_step(panels[3], outer, j, options.bandwidth)
    _finish(panels, setup, margins)
    return figure


def _look(j: int) -> dict[str, Any]:
    colour, style = _LOOKS[j % len(_LOOKS)]
    return {"color": colour, "linestyle": style, "linewidth": 1.3}


def _draw_bode(
    gain: Axes, phase: Axes, peak: Axes, hz: Array, L: NDArray[np.complex128], j: int, m: LoopMargins
) -> None:
    gain.plot(hz, 20 * np.log10(np.abs(L)), **_look(j))
    angle = np.rad2deg(np.unwrap(np.angle(L)))
    # Integrators alone turn the phase of a servo loop below 0 at low frequencies.
    phase.plot(hz, angle - 360 * math.ceil(angle[0] / 360), **_look(j))
    peak.plot(hz, np.abs(1 / (1 + L)), **_look(j))
    if math.isfinite(m.crossover):
        for axes in (gain, phase):
            axes.axvline(m.crossover / (2 * math.pi), color=_LOOKS[j % len(_LOOKS)][0], linewidth=0.5)


def _draw_step(axes: Axes, loop: Any, j: int, bandwidth: float) -> None:
    import control

    closed = control.feedback(loop.to_control(), 1)
    time = np.arange(0.0, _STEP_TIME / bandwidth, loop.step)
    response = control.step_response(closed, time)
    axes.plot(1000 * response.time, np.squeeze(response.outputs), **_look(j))


def _finish(panels: list[Axes], setup: Setup, margins: Sequence[LoopMargins]) -> None:
    gain, phase, peak, step = panels
    style_axes(gain, "Gain of the loop", "frequency [Hz]", "gain [dB]")
    style_axes(phase, "Phase of the loop", "frequency [Hz]", "phase [deg]")
    style_axes(peak, "Sensitivity to disturbances", "frequency [Hz]", "factor [-]")
    style_axes(step, "Answer to a small step of the wanted angle", "time [ms]", "angle / step [-]")
    for axes in (gain, phase, peak):
        axes.set_xscale("log")
        axes.set_xlim(_LOWEST_HZ, 0.5 * setup.rate)
        axes.xaxis.set_major_locator(FixedLocator([10.0**k for k in range(-1, 4)]))
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    gain.axhline(0.0, color=LIMIT, linewidth=0.8, linestyle="--")
    gain.set_ylim(-80, 80)
    phase.axhline(-180.0, color=LIMIT, linewidth=0.8, linestyle="--")
    phase.set_ylim(-360, 0)
    phase.yaxis.set_major_locator(FixedLocator([-360, -270, -180, -90, 0]))
    peak.axhline(1.0, color=FAINT, linewidth=0.8)
    step.axhline(1.0, color=FAINT, linewidth=0.8)
    least = min(range(len(margins)), key=lambda j: margins[j].phase)
    m = margins[least]
    remark(phase, f"least margin {math.degrees(m.phase):.0f}°, {1000 * m.delay:.2g} ms")
    remark(gain, f"least margin {20 * math.log10(min(each.gain for each in margins)):.0f} dB")
    remark(peak, f"at most {max(each.sensitivity for each in margins):.2f}")
    for j, name in enumerate(setup.arm.joint_names):
        step.plot([], [], label=joint_title(name), **_look(j))
    step.legend(loc="lower right", fontsize=TEXT_SIZE - 1, frameon=False, labelcolor=INK)
