"""Gains from a wanted bandwidth and phase margin."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from armik_sym.errors import TuningError
from armik_sym.servo.controller import Cascade, Pid
from armik_sym.servo.linear import Sampled, closed_poles, in_series
from armik_sym.servo.plant import JointPlant

_FILTER = 10.0
_INTEGRAL = 10.0
_SPEED_INTEGRAL = 5.0
_SLOWEST, _FASTEST = 0.2, 30.0


def tune_pid(plant: JointPlant, bandwidth: float, phase_margin: float) -> Pid:
    """PID whose loop crosses gain 1 at a wanted frequency with a wanted phase margin.

    With z = e^{jω_cT}, C(z) G(z) = -e^{jφ} is solved for kp and kd, which enter C linearly; ki = kp ω_c/10
    and filter time 1/(10 ω_c) are fixed. G is the exact sampled plant with its delay: no approximation.

    Args:
        plant: The joint.
        bandwidth: Crossover frequency ω_c, in [rad/s].
        phase_margin: φ, in [rad].

    Returns:
        The controller.

    Raises:
        TuningError: If no such PID exists or its closed loop is not stable.

    Source:
        Åström & Hägglund 2006, §6 (loop shaping at the crossover); this package (in the z plane).
    """
    _check(plant, bandwidth, phase_margin)
    step, filter_time = plant.step, 1.0 / (_FILTER * bandwidth)
    z = np.exp(1j * bandwidth * step)
    target = -np.exp(1j * phase_margin) / plant.sampled().response(np.array([bandwidth]))[0]
    steady = 1.0 + bandwidth / _INTEGRAL * step * z / (z - 1.0)
    slope = (1.0 - 1.0 / z) / (filter_time + step - filter_time / z)
    equations = np.array([[steady.real, slope.real], [steady.imag, slope.imag]])
    kp, kd = np.linalg.solve(equations, [target.real, target.imag])
    reached = math.degrees(phase_margin)
    if kp <= 0 or kd < 0:
        raise TuningError(
            f"no PID has a phase margin of {reached:.3g}° at {_hz(bandwidth)}: it would need kp = {kp:.3g}, "
            f"kd = {kd:.3g}; ask for a {'smaller' if kp <= 0 else 'larger'} phase margin or a lower bandwidth"
        )
    ki = kp * bandwidth / _INTEGRAL
    pid = Pid(float(kp), float(ki), float(kd), filter_time, math.sqrt(max(kd, 1e-12) / ki))
    _check_stable(in_series(pid.sampled(step), plant.sampled()), "PID", bandwidth, phase_margin)
    return pid


def tune_cascade(plant: JointPlant, bandwidth: float, phase_margin: float) -> Cascade:
    """Position over speed whose position loop has a wanted crossover frequency and phase margin.

    For a crossover ω_v of the speed loop its gain follows from |L_v| = 1 with ki = kv ω_v/5, and kp from
    |L_p(ω_c)| = 1. The phase margin of the position loop then grows with ω_v; bisection finds the ω_v that
    gives the one asked for.

    Args:
        plant: The joint.
        bandwidth: Crossover frequency ω_c of the position loop, in [rad/s].
        phase_margin: Of the position loop, in [rad].

    Returns:
        The controller.

    Raises:
        TuningError: If no speed loop is fast enough, or the asked margin is below what even a slow one has.

    Source:
        Siciliano et al. 2009, §8.3.2 (structure); this package (tuning in the z plane).
    """
    _check(plant, bandwidth, phase_margin)

    G = plant.sampled()

    def missing(speed_bandwidth: float) -> float:
        return _cascade(G, bandwidth, speed_bandwidth)[1] - phase_margin

    low, top = _SLOWEST * bandwidth, min(_FASTEST * bandwidth, 0.9 * math.pi / plant.step)
    least, most = missing(low), missing(top)
    if not least <= 0 <= most:
        reached, advice = (most, "a lower bandwidth") if most < 0 else (least, "a larger phase margin")
        raise TuningError(
            f"no P-PI cascade has a phase margin of {math.degrees(phase_margin):.3g}° at {_hz(bandwidth)}: "
            f"with speed loops of {_hz(low)} to {_hz(top)} it is {'at most' if most < 0 else 'at least'} "
            f"{math.degrees(reached + phase_margin):.3g}°; ask for {advice}"
        )
    speed_bandwidth = float(brentq(missing, low, top, xtol=1e-12, rtol=1e-14))
    controller = _cascade(G, bandwidth, speed_bandwidth)[0]
    _check_stable(in_series(controller.sampled(plant.step), G), "P-PI cascade", bandwidth, phase_margin)
    return controller


def position_loop(plant: JointPlant, controller: Cascade) -> Sampled:
    """The position loop of a cascade, cut at the wanted speed: kp · (speed loop closed) from error to angle.

    Args:
        plant: The joint.
        controller: The cascade.

    Returns:
        The open position loop.

    Source:
        None (block diagram algebra).
    """
    step = plant.step
    G = plant.sampled()
    n = len(G.A)
    # States: plant, integral of the speed loop, angle before. Input: error of the position.
    A, b = np.zeros((n + 2, n + 2)), np.zeros(n + 2)
    gain = controller.kv + controller.ki * step
    speed = np.concatenate([G.c / step, [0.0, -1.0 / step]])
    torque = -gain * speed
    torque[n] += 1.0
    A[:n, :n] = G.A
    A[:n] += np.outer(G.b, torque)
    A[n] = -controller.ki * step * speed
    A[n, n] += 1.0
    A[n + 1, :n] = G.c
    b[:n] = G.b * gain * controller.kp
    b[n] = controller.ki * step * controller.kp
    return Sampled(A, b, np.concatenate([G.c, [0.0, 0.0]]), 0.0, step)


def _cascade(G: Sampled, bandwidth: float, speed_bandwidth: float) -> tuple[Cascade, float]:
    """The cascade with a given speed loop, and the phase margin of its position loop."""
    step = G.step
    tracking = _SPEED_INTEGRAL / speed_bandwidth

    def unit(omega: float) -> complex:
        """The speed loop for kv = 1."""
        z = np.exp(1j * omega * step)
        integral = 1.0 + speed_bandwidth / _SPEED_INTEGRAL * step * z / (z - 1.0)
        return complex(integral * G.response(np.array([omega]))[0])

    def difference(omega: float) -> complex:
        return complex((1.0 - np.exp(-1j * omega * step)) / step)

    kv = 1.0 / abs(unit(speed_bandwidth) * difference(speed_bandwidth))
    closed = kv * unit(bandwidth) / (1.0 + kv * unit(bandwidth) * difference(bandwidth))
    # Between -180° and 180°: a loop that is late by more has no margin, not a large one.
    margin = float(np.angle(-closed))
    return Cascade(1.0 / abs(closed), kv, kv * speed_bandwidth / _SPEED_INTEGRAL, tracking), margin


def _check(plant: JointPlant, bandwidth: float, phase_margin: float) -> None:
    top = math.pi / plant.step
    if not (math.isfinite(bandwidth) and 0 < bandwidth < top):
        raise TuningError(
            f"bandwidth is {bandwidth!r} rad/s, expected above 0, below half the sampling rate {top:.4g}"
        )
    if not 0 < phase_margin < math.pi / 2:
        raise TuningError(f"phase margin is {phase_margin!r} rad, expected between 0 and π/2")
    late = math.degrees(bandwidth * (plant.delay + plant.lag + 0.5 * plant.step))
    # An integrator and 90° of delay leave no margin; phases of later loops, counted within a turn, would look
    # good again.
    if late >= 90:
        raise TuningError(
            f"delay, current loop and sampling alone are late by {late:.3g}° at {_hz(bandwidth)}: ask for a "
            "lower bandwidth"
        )


def _stable(loop: Sampled) -> bool:
    return bool(np.all(np.abs(closed_poles(loop)) < 1.0))


def _check_stable(loop: Sampled, kind: str, bandwidth: float, phase_margin: float) -> None:
    if not _stable(loop):
        raise TuningError(
            f"the {kind} with {math.degrees(phase_margin):.3g}° at {_hz(bandwidth)} is not stable at other "
            "frequencies: ask for a lower bandwidth, or sample faster"
        )


def _hz(omega: float) -> str:
    return f"{omega / (2 * math.pi):.3g} Hz"
