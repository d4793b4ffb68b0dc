"""A motion tracked by its servos, with everything the arm does to them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.servo.reference import Reference
from armik_sym.servo.setup import Setup
from armik_sym.servo.simulation import Run, Wanted, simulate

Array = NDArray[np.float64]

_PASSES = 8
SETTLED = 5e-6


@dataclass(frozen=True, eq=False)
class Tracking:
    """What the joints did when they were asked for a motion, at the samples of the controller.

    Attributes:
        setup: Arm, drives and controllers.
        reference: What was asked for.
        run: What happened.
        passes: How often the load was computed again.
        change: By how much the last pass changed a joint angle, in [rad].
    """

    setup: Setup
    reference: Reference
    run: Run
    passes: int
    change: float

    @property
    def time(self) -> Array:
        """From the beginning of the motion, shape (k,), in [s]."""
        return self.reference.time

    @property
    def joint_error(self) -> Array:
        """Angle reached minus angle wanted, shape (k, dof), in [rad]."""
        return self.run.q - self.reference.q

    @cached_property
    def hand_error(self) -> Array:
        """Distance from the hand to where it should be, shape (k,), in [m]: forward kinematics of both."""
        arm = self.setup.arm
        reached = hand_pose(arm.chain, self.run.q, arm.lengths)[0]
        wanted = hand_pose(arm.chain, self.reference.q, arm.lengths)[0]
        return np.asarray(np.linalg.norm(reached - wanted, axis=1))

    @property
    def hand_rms(self) -> float:
        """Root mean square of the distance of the hand, in [m]."""
        return float(np.sqrt(np.mean(self.hand_error**2)))

    @property
    def hand_peak(self) -> float:
        """Largest distance of the hand, in [m]."""
        return float(self.hand_error.max())

    @property
    def settled(self) -> bool:
        """Whether load and motion agree."""
        return self.change <= SETTLED


def track(setup: Setup, reference: Reference, passes: int = _PASSES, change: float = SETTLED) -> Tracking:
    """Simulate the closed loops under the load of the moving arm.

    J̄ q̈ + B q̇ + friction = τ - d, d = M(q) q̈ + c(q, q̇) + g(q) - J̄_arm q̈, J̄ the mean inertia. The load d
    of all samples is computed from the motion of the pass before, until the motion repeats itself: waveform
    relaxation. Every pass is one loop over the samples with all joints at once; at the end it is the coupled
    arm, the load held during a sample.

    Args:
        setup: Arm, drives and controllers.
        reference: What is asked for; the arm begins at rest in its first posture.
        passes: How often the load is computed again at most.
        change: Small enough a change of joint angles from pass to pass to stop, in [rad].

    Returns:
        What the joints did.

    Source:
        Lelarasmee, Ruehli & Sangiovanni-Vincentelli 1982 (waveform relaxation); this package.
    """
    wanted = _wanted(setup, reference)
    still = np.zeros_like(reference.q)
    load = setup.body_torque(reference.q, still, still)
    # It stood still before: the integral action holds the first posture.
    first = load[0]
    run = simulate(setup.plants, setup.controllers, setup.drive.joints, wanted, load)
    done, changed = 1, np.inf
    while done < passes and changed > change:
        load = _load(setup, run, reference.step)
        again = simulate(setup.plants, setup.controllers, setup.drive.joints, wanted, load, first)
        changed = float(np.abs(again.q - run.q).max())
        run, done = again, done + 1
    return Tracking(setup, reference, run, done, changed)


def _load(setup: Setup, run: Run, step: float) -> Array:
    """What the arm takes beyond its mean inertia, in the middle of every sample."""
    following = np.concatenate([run.speed[1:], run.speed[-1:]])
    after = np.concatenate([run.q[1:], run.q[-1:]])
    acceleration = (following - run.speed) / step
    torque = setup.body_torque(0.5 * (run.q + after), 0.5 * (run.speed + following), acceleration)
    return torque - setup.inertia * acceleration


def _wanted(setup: Setup, reference: Reference) -> Wanted:
    """The wanted angles, and what is fed forward."""
    way = setup.options.feedforward
    none = np.zeros_like(reference.q)
    held = setup.body_torque(reference.q, none, none) if setup.options.gravity else none
    torque = held.copy()
    if way != "none":
        torque += np.array([plant.viscous for plant in setup.plants]) * reference.speed
    if way == "acceleration":
        torque += np.array([plant.inertia for plant in setup.plants]) * reference.acceleration
    return Wanted(reference.q, none if way == "none" else reference.speed, torque, held[0])
