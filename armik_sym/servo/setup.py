"""Everything a closed loop is made of: bodies, plants and tuned controllers of all joints."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import DriveError, OptionError, TuningError, UnknownNameError
from armik_sym.servo.arm_load import bodies_of
from armik_sym.servo.body import RigidBody, Subject
from armik_sym.servo.controller import Cascade, Controller, Pid
from armik_sym.servo.drive import Drive
from armik_sym.servo.drive_file import load_drive
from armik_sym.servo.dynamics import gravity_of, inverse_dynamics, joint_inertia
from armik_sym.servo.given_number import is_number
from armik_sym.servo.plant import JointPlant
from armik_sym.servo.tuning import tune_cascade, tune_pid

Array = NDArray[np.float64]

FEEDFORWARDS = ("none", "speed", "acceleration")
CONTROLLERS = ("cascade", "pid")
# Phase margins [deg] that leave a sensitivity peak below 1.5 with the drives of the package.
_USUAL_MARGIN_DEG = {"cascade": 65.0, "pid": 50.0}
_MOST_POSTURES = 200
_AT_REST = 1e-9  # [rad/s]


@dataclass(frozen=True)
class ServoOptions:
    """How the joints are controlled.

    Attributes:
        controller: "cascade" (position over speed, P-PI) or "pid".
        bandwidth: Crossover frequency of the loop, in [Hz].
        phase_margin: Of the position loop (cascade) or the loop (pid), in [rad]; None for 65° and 50°.
        feedforward: "none", "speed" (wanted speed and its viscous friction) or "acceleration" (that, and the
            torque of the inertia).
        gravity: Whether the controller also adds the torque that holds the arm in the wanted posture.
        rate: Of the controller, in [Hz]; None for that of the drive.

    Raises:
        OptionError: If a value is out of range.
        UnknownNameError: If a word is unknown.

    Source:
        Siciliano et al. 2009, §8.3-8.4 (decentralised control with feed-forward).
    """

    controller: str = "cascade"
    bandwidth: float = 8.0
    phase_margin: float | None = None
    feedforward: str = "acceleration"
    gravity: bool = False
    rate: float | None = None

    def __post_init__(self) -> None:
        if self.controller not in CONTROLLERS:
            raise UnknownNameError("controller", self.controller, CONTROLLERS)
        if self.feedforward not in FEEDFORWARDS:
            raise UnknownNameError("feedforward", self.feedforward, FEEDFORWARDS)
        for key in ("bandwidth", "rate"):
            value = getattr(self, key)
            given = value is not None or key == "bandwidth"
            if given and not (is_number(value) and value > 0):
                raise OptionError(f"{key} is {value!r} Hz, expected a positive number")
        if self.phase_margin is not None and not is_number(self.phase_margin):
            raise OptionError(f"phase_margin is {self.phase_margin!r} rad, expected a number")
        if not isinstance(self.gravity, bool):
            raise OptionError(f"gravity is {self.gravity!r}, expected True or False")

    @property
    def margin(self) -> float:
        """The phase margin asked for, in [rad]."""
        usual = math.radians(_USUAL_MARGIN_DEG[self.controller])
        return usual if self.phase_margin is None else self.phase_margin


@dataclass(frozen=True, eq=False)
class Setup:
    """An arm in its drives, with tuned controllers.

    Attributes:
        arm: The arm.
        drive: The drives, in the order of its joints.
        bodies: What moves.
        gravity: In the base frame, shape (3,), in [m/s²].
        inertia: Of the bodies about each joint, mean over the postures, shape (dof,), in [kg m²].
        plants: One per joint.
        controllers: One per joint.
        options: How it was asked for.
    """

    arm: Arm
    drive: Drive
    bodies: tuple[RigidBody, ...]
    gravity: Array
    inertia: Array
    plants: tuple[JointPlant, ...]
    controllers: tuple[Controller, ...]
    options: ServoOptions

    @property
    def rate(self) -> float:
        """Of the controller, in [Hz]."""
        return 1.0 / self.plants[0].step

    def torque_needed(self, q: Array, speed: Array, acceleration: Array) -> Array:
        """Torque of the drives at the joints for a motion: J_rotor q̈ + B q̇ + τ_c sign q̇ + τ_bodies.

        Args:
            q: Joint angles, shape (k, dof), in [rad].
            speed: In [rad/s].
            acceleration: In [rad/s²].

        Returns:
            Shape (k, dof), in [Nm].

        Source:
            Siciliano et al. 2009, §7.2.1.
        """
        joints = self.drive.joints
        rotor = np.array([j.inertia for j in joints])
        viscous = np.array([j.viscous for j in joints])
        own = rotor * acceleration + viscous * speed + self.dry_friction(speed)
        return np.asarray(own + self.body_torque(q, speed, acceleration))

    def dry_friction(self, speed: Array) -> Array:
        """Torque of dry friction against a motion: τ_c sign q̇, none at rest.

        Args:
            speed: Shape (k, dof), in [rad/s].

        Returns:
            Shape (k, dof), in [Nm].

        Source:
            Siciliano et al. 2009, §7.2.1.
        """
        dry = np.array([j.friction for j in self.drive.joints])
        # A spline through a pause trembles by rounding; that is no motion.
        return np.asarray(dry * np.where(np.abs(speed) > _AT_REST, np.sign(speed), 0.0))

    def body_torque(self, q: Array, speed: Array, acceleration: Array) -> Array:
        """Torque the arm and what moves with it take, shape (k, dof), in [Nm].

        Args:
            q: Joint angles, shape (k, dof), in [rad].
            speed: In [rad/s].
            acceleration: In [rad/s²].

        Returns:
            Shape (k, dof).

        Source:
            Siciliano et al. 2009, §7.5.
        """
        return inverse_dynamics(self.arm, self.bodies, q, speed, acceleration, self.gravity)


def make_setup(
    arm: Arm,
    postures: Array,
    *,
    drive: Drive | str | os.PathLike[str] | None = None,
    options: ServoOptions | None = None,
    subject: Subject | None = None,
    bodies: Sequence[RigidBody] | None = None,
    controllers: Sequence[Controller] | None = None,
) -> Setup:
    """Put an arm into its drives and tune their controllers for the postures it will take.

    Args:
        arm: The arm.
        postures: Joint angles it will take, shape (n, dof), in [rad].
        drive: The drives, a name or file of them, or None for those of the package.
        options: How the joints are controlled.
        subject: The person; None for the mean male subject of the table.
        bodies: What moves, instead of person and device.
        controllers: Controllers to use instead of tuned ones, one per joint, all of one kind.

    Returns:
        The setup.

    Raises:
        DriveError: If drive, arm and bodies do not fit.
        TuningError: If a joint cannot be tuned as asked; names it.

    Source:
        None (this package).
    """
    chosen = ServoOptions() if options is None else options
    if not isinstance(drive, Drive | str | os.PathLike | None):
        raise DriveError(f"drive is {drive!r}, expected a Drive, a name, a file, or None")
    own = drive if isinstance(drive, Drive) else load_drive(*(() if drive is None else (drive,)))
    fitted = own.for_arm(arm)
    moving = bodies_of(arm, subject, fitted.moving_mass) if bodies is None else _fitting(arm, bodies)
    every = max(len(postures) // _MOST_POSTURES, 1)
    inertia = joint_inertia(arm, moving, postures[::every]).mean(axis=0)
    step = 1.0 / (fitted.rate if chosen.rate is None else chosen.rate)
    plants = tuple(
        JointPlant(
            joint.inertia + float(load), joint.viscous, 1.0 / (2 * math.pi * joint.current_bandwidth),
            fitted.delay, step,
        )
        for joint, load in zip(fitted.joints, inertia, strict=True)
    )  # fmt: skip
    given = _tuned(arm, plants, chosen) if controllers is None else _checked(arm, controllers)
    kind = "pid" if isinstance(given[0], Pid) else "cascade"
    return Setup(
        arm, fitted, moving, gravity_of(arm), inertia, plants, given, replace(chosen, controller=kind)
    )


def _tuned(arm: Arm, plants: Sequence[JointPlant], options: ServoOptions) -> tuple[Controller, ...]:
    tune = tune_pid if options.controller == "pid" else tune_cascade
    found: list[Controller] = []
    for name, plant in zip(arm.joint_names, plants, strict=True):
        try:
            found.append(tune(plant, 2 * math.pi * options.bandwidth, options.margin))
        except TuningError as error:
            raise TuningError(f"joint {name!r}: {error}") from None
    return tuple(found)


def _fitting(arm: Arm, bodies: Sequence[RigidBody]) -> tuple[RigidBody, ...]:
    last = len(arm.chain.links) + 1
    for body in bodies:
        if not 0 <= body.frame <= last:
            raise DriveError(
                f"body {body.name!r}: moves with frame {body.frame}, arm {arm.name!r} has frames 0 to {last}"
            )
    return tuple(bodies)


def _checked(arm: Arm, controllers: Sequence[Controller]) -> tuple[Controller, ...]:
    if not isinstance(controllers, Sequence):
        raise DriveError(f"controller is {controllers!r}, expected a name, or one Cascade or Pid per joint")
    given = tuple(controllers)
    kinds = {type(controller) for controller in given}
    if len(given) != arm.dof or len(kinds) != 1 or not kinds <= {Pid, Cascade}:
        names = ", ".join(sorted(kind.__name__ for kind in kinds)) or "none"
        raise DriveError(
            f"controllers are {len(given)} of kind {names}, expected {arm.dof}, all Pid or all Cascade"
        )
    return given
