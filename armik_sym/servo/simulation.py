"""The closed loop at the rate of its controller: all joints at once, with limits, friction and delay."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from armik_sym.servo.controller import Cascade, Controller, Pid
from armik_sym.servo.drive import JointDrive
from armik_sym.servo.plant import JointPlant

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Run:
    """What a simulated loop did, at the samples of its controller.

    Attributes:
        q: Joint angles, shape (k, dof), in [rad].
        speed: In [rad/s].
        torque: Of the drive at the joint, in [Nm].
        limited: Whether the commanded torque was cut off at a limit, shape (k, dof).
    """

    q: Array
    speed: Array
    torque: Array
    limited: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Wanted:
    """What the loop is asked for, at the samples of its controller, each of shape (k, dof).

    Attributes:
        q: Joint angles, in [rad].
        speed: Added to the wanted speed of a cascade, in [rad/s]; zeros for no feed-forward.
        torque: Added to the commanded torque, in [Nm].
        torque_before: The same while the arm stood still before, shape (dof,), in [Nm].
    """

    q: Array
    speed: Array
    torque: Array
    torque_before: Array | float = 0.0


def simulate(
    plants: Sequence[JointPlant],
    controllers: Sequence[Controller],
    drives: Sequence[JointDrive],
    wanted: Wanted,
    load: Array,
    held: Array | None = None,
) -> Run:
    """Run the closed loops of all joints, beginning at rest in the first posture, the load held.

    Each sample: x⁺ = Φ x + Γ₀ u_{k-m} + Γ₁ u_{k-m-1} + Γ_d (load + friction). Dry friction is what stops the
    joint at the end of the sample, at most its largest value; a joint at rest that it holds does not move.
    Torque is cut at min(peak, stall (1 - v/v₀)), the line of the motor at its supply.

    Args:
        plants: One per joint, with one sampling time.
        controllers: One per joint, all of one kind.
        drives: One per joint, for limits and friction.
        wanted: What is asked for.
        load: Torque the load takes in each sample, shape (k, dof), in [Nm].
        held: Torque that held the first posture before, shape (dof,), in [Nm]; None: the load then.

    Returns:
        What the joints did.

    Source:
        Moreau 1988, time-stepping for dry friction; Åström & Wittenmark 1997, §2.3 (sampling).
    """
    n, dof = wanted.q.shape
    matrices, friction_way = _matrices(plants)
    lags = np.array([plant.whole_delay for plant in plants])
    friction = np.array([drive.friction for drive in drives])
    peak = np.array([drive.peak_torque for drive in drives])
    stall = np.array([drive.stall_torque for drive in drives])
    slope = np.array([d.stall_torque * d.gear.ratio / d.motor.no_load_speed for d in drives])
    before = load[0] if held is None else held
    law = _law(controllers, plants[0].step, before - wanted.torque_before, wanted.q[0], drives)
    state = np.zeros((6, dof))
    state[0], state[2], state[3], state[4] = wanted.q[0], before, before, before
    sent = deque([before] * int(lags.max() + 2), maxlen=int(lags.max() + 2))
    columns = np.arange(dof)
    out = np.empty((4, n, dof))
    per_friction = -friction_way[1]
    one_lag = bool((lags == lags[0]).all())
    for k in range(n):
        q, v = state[0].copy(), state[1].copy()
        high = np.minimum(peak, stall - slope * v)
        low = np.maximum(-peak, -stall - slope * v)
        asked = law.torque(wanted.q[k], wanted.speed[k], q) + wanted.torque[k]
        given = np.minimum(np.maximum(asked, low), high)
        law.limited(given - asked)
        out[0, k], out[1, k], out[2, k], out[3, k] = q, v, state[2], given != asked
        sent.appendleft(given)
        if one_lag:
            state[3], state[4] = sent[int(lags[0])], sent[int(lags[0]) + 1]
        else:
            past = np.array(sent)
            state[3], state[4] = past[lags, columns], past[lags + 1, columns]
        state[5] = load[k]
        free = (matrices * state).sum(axis=1)
        needed = free[1] / per_friction
        stopping = np.minimum(np.maximum(needed, -friction), friction)
        state[:3] = free + friction_way * stopping
        sticks = np.abs(needed) < friction
        # Rounding, and torque that changes within a sample, would let a joint creep.
        state[0] = np.where(sticks & (v == 0), q, state[0])
        state[1] = np.where(sticks, 0.0, state[1])
    return Run(out[0], out[1], out[2], out[3].astype(np.bool_))


def _matrices(plants: Sequence[JointPlant]) -> tuple[Array, Array]:
    """[Φ Γ₀ Γ₁ Γ_d] of every joint, shape (3, 6, dof), and Γ_d, shape (3, dof)."""
    whole = np.empty((3, 6, len(plants)))
    for j, plant in enumerate(plants):
        phi, late, early, load = plant.matrices()
        whole[:, :, j] = np.column_stack([phi, late, early, load])
    return whole, whole[:, 5].copy()


def _law(
    controllers: Sequence[Controller], step: float, held: Array, q: Array, drives: Sequence[JointDrive]
) -> _PidLaw | _CascadeLaw:
    pids = [c for c in controllers if isinstance(c, Pid)]
    if len(pids) == len(controllers):
        return _PidLaw(pids, step, held)
    top = np.array([drive.top_speed for drive in drives])
    return _CascadeLaw([c for c in controllers if isinstance(c, Cascade)], step, held, q, top)


class _PidLaw:
    """The PID of every joint; the equations are those of `Pid`."""

    def __init__(self, controllers: Sequence[Pid], step: float, held: Array) -> None:
        self.kp = np.array([c.kp for c in controllers])
        self.integral_gain = np.array([c.ki * step for c in controllers])
        filters = np.array([c.filter_time for c in controllers])
        self.keep = filters / (filters + step)
        self.rate = np.array([c.kd for c in controllers]) / (filters + step)
        self.pull = step / np.array([c.tracking_time for c in controllers])
        self.integral, self.slope, self.before = held.copy(), np.zeros_like(held), np.zeros_like(held)

    def torque(self, wanted: Array, speed: Array, q: Array) -> Array:
        del speed  # the derivative of the error holds the wanted speed
        error = wanted - q
        self.integral = self.integral + self.integral_gain * error
        self.slope = self.keep * self.slope + self.rate * (error - self.before)
        self.before = error
        return self.kp * error + self.integral + self.slope

    def limited(self, missing: Array) -> None:
        self.integral = self.integral + self.pull * missing


class _CascadeLaw:
    """The cascade of every joint; the equations are those of `Cascade`, v* within the speed of the drive."""

    def __init__(
        self, controllers: Sequence[Cascade], step: float, held: Array, q: Array, top: Array
    ) -> None:
        self.kp = np.array([c.kp for c in controllers])
        self.kv = np.array([c.kv for c in controllers])
        self.integral_gain = np.array([c.ki * step for c in controllers])
        self.pull = step / np.array([c.tracking_time for c in controllers])
        self.step, self.top = step, top
        self.integral, self.before = held.copy(), q.copy()

    def torque(self, wanted: Array, speed: Array, q: Array) -> Array:
        asked = self.kp * (wanted - q) + speed
        asked = np.minimum(np.maximum(asked, -self.top), self.top)
        error = asked - (q - self.before) / self.step
        self.before = q.copy()
        self.integral = self.integral + self.integral_gain * error
        return self.kv * error + self.integral

    def limited(self, missing: Array) -> None:
        self.integral = self.integral + self.pull * missing
