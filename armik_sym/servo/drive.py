"""A joint drive: motor, gear, friction, and how it is sampled."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from armik_sym.arm.model import Arm
from armik_sym.errors import DriveError
from armik_sym.servo.given_number import is_number

# Segments of the arm that parts of a device move with.
SEGMENTS = ("upper_arm", "forearm", "hand")


@dataclass(frozen=True)
class Motor:
    """A brushless motor as its data sheet gives it, as an equivalent direct-current motor.

    Attributes:
        voltage: Supply, in [V].
        resistance: Terminal resistance, in [ohm].
        inductance: Terminal inductance, in [H].
        torque_constant: k, in [Nm/A], which is [V s/rad].
        rotor_inertia: In [kg m²].
        rated_torque: What it can give all day, in [Nm].
        peak_torque: What it can give for a moment, in [Nm].
        top_speed: Largest speed permitted, in [rad/s].
        friction: Dry friction torque, in [Nm].

    Raises:
        DriveError: If a value is out of range.

    Source:
        maxon, "Key information on maxon DC motor and maxon EC motor" (what the lines of a data sheet mean).
    """

    voltage: float
    resistance: float
    inductance: float
    torque_constant: float
    rotor_inertia: float
    rated_torque: float
    peak_torque: float
    top_speed: float
    friction: float = 0.0

    def __post_init__(self) -> None:
        _check(self, "motor", zero_ok=("inductance", "friction"))
        if self.peak_torque < self.rated_torque:
            raise DriveError(
                f"motor: peak_torque is {self.peak_torque:g} Nm, below rated_torque {self.rated_torque:g} Nm"
            )

    @property
    def no_load_speed(self) -> float:
        """Speed at which the induced voltage is the supply: V/k, in [rad/s]."""
        return self.voltage / self.torque_constant


@dataclass(frozen=True)
class Gear:
    """A reduction gear.

    Attributes:
        ratio: Turns of the motor per turn of the joint.
        efficiency: Part of the power that arrives, 0 to 1.
        inertia: At the motor shaft, in [kg m²].
        rated_torque: At the joint, in [Nm]; infinite if the gear is no limit.
        peak_torque: At the joint for a moment, in [Nm].

    Raises:
        DriveError: If a value is out of range.

    Source:
        None (definition).
    """

    ratio: float
    efficiency: float = 1.0
    inertia: float = 0.0
    rated_torque: float = math.inf
    peak_torque: float = math.inf

    def __post_init__(self) -> None:
        _check(self, "gear", zero_ok=("inertia",), infinite_ok=("rated_torque", "peak_torque"))
        if self.efficiency > 1.0:
            raise DriveError(f"gear: efficiency is {self.efficiency:g}, expected above 0, at most 1")


@dataclass(frozen=True)
class JointDrive:
    """Motor and gear of one joint, all torques and speeds at the joint.

    J q̈ + B q̇ + τ_c sign q̇ + τ_load = τ, τ ≤ min(peak, η N k (V - k N |q̇|)/R) where it drives.

    Attributes:
        name: Joint it belongs to.
        motor: The motor.
        gear: The gear.
        current_bandwidth: Of the current loop, which is a first-order lag, in [Hz].
        viscous: B, friction that grows with speed, in [Nm s/rad].
        dry: Dry friction beside that of the motor, in [Nm].

    Raises:
        DriveError: If a value is out of range.

    Source:
        Siciliano et al., Robotics: Modelling, Planning and Control (2009), §5.2 and §8.3 (geared drives).
    """

    name: str
    motor: Motor
    gear: Gear
    current_bandwidth: float
    viscous: float = 0.0
    dry: float = 0.0

    def __post_init__(self) -> None:
        _check(self, f"drive of joint {self.name!r}", zero_ok=("viscous", "dry"))

    @property
    def inertia(self) -> float:
        """Inertia of rotor and gear at the joint: N² (J_rotor + J_gear), in [kg m²]."""
        return self.gear.ratio**2 * (self.motor.rotor_inertia + self.gear.inertia)

    @property
    def friction(self) -> float:
        """Dry friction at the joint: N η τ_motor + the rest, in [Nm]."""
        return self._at_joint(self.motor.friction) + self.dry

    @property
    def rated_torque(self) -> float:
        """What the joint can be given all day, in [Nm]: by the motor or by the gear."""
        return min(self._at_joint(self.motor.rated_torque), self.gear.rated_torque)

    @property
    def peak_torque(self) -> float:
        """What the joint can be given for a moment, in [Nm]: by the motor or by the gear."""
        return min(self._at_joint(self.motor.peak_torque), self.gear.peak_torque)

    @property
    def top_speed(self) -> float:
        """Largest speed of the joint, in [rad/s]: permitted by the motor, or where the voltage is used up."""
        return min(self.motor.top_speed, self.motor.no_load_speed) / self.gear.ratio

    @property
    def stall_torque(self) -> float:
        """Torque the supply could drive at standstill: η N k V/R, in [Nm]."""
        motor = self.motor
        return self._at_joint(motor.torque_constant * motor.voltage / motor.resistance)

    def _at_joint(self, torque: float) -> float:
        return self.gear.efficiency * self.gear.ratio * torque


@dataclass(frozen=True)
class Drive:
    """The drives of all joints, and how their controller is sampled.

    Attributes:
        name: Name.
        joints: One drive per joint, from base to hand.
        rate: Of the position controller, in [Hz].
        delay: From measuring to acting, in [s].
        moving_mass: Mass of the device that moves with upper_arm, forearm and hand, in [kg].
        description: Where the numbers come from.

    Raises:
        DriveError: If a value is out of range.

    Source:
        None (definition).
    """

    name: str
    joints: tuple[JointDrive, ...]
    rate: float = 1000.0
    delay: float = 0.0
    moving_mass: Mapping[str, float] = field(default_factory=dict)
    description: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", tuple(self.joints))
        _check(self, f"drive {self.name!r}", zero_ok=("delay",))
        if not self.joints:
            raise DriveError(f"drive {self.name!r}: has no joints")
        for joint in self.joints:
            if not isinstance(joint, JointDrive):
                raise DriveError(f"drive {self.name!r}: joints hold {joint!r}, expected JointDrives")
        for part, mass in self.moving_mass.items():
            if part not in SEGMENTS:
                raise DriveError(
                    f"drive {self.name!r}: moving_mass has unknown key {part!r}: valid are "
                    f"{', '.join(SEGMENTS)}"
                )
            if not is_number(mass) or mass < 0:
                raise DriveError(
                    f"drive {self.name!r}: moving_mass.{part} is {mass!r}, expected a number ≥ 0"
                )
        names = [joint.name for joint in self.joints]
        repeated = [name for i, name in enumerate(names) if name in names[:i]]
        if repeated:
            raise DriveError(f"drive {self.name!r}: joint {repeated[0]!r} occurs twice")

    def for_arm(self, arm: Arm) -> Drive:
        """The drives in the order of an arm's joints: by name, else by order if their numbers agree.

        Args:
            arm: The arm.

        Returns:
            A drive with one joint per joint of the arm, named as there.

        Raises:
            DriveError: If names and numbers do not fit, or a joint is prismatic.

        Source:
            None (bookkeeping).
        """
        if not arm.rotates.all():
            slider = arm.joint_names[int((~arm.rotates).argmax())]
            raise DriveError(
                f"joint {slider!r} of arm {arm.name!r} slides: drives are of turning joints only"
            )
        own = {joint.name: joint for joint in self.joints}
        if all(name in own for name in arm.joint_names):
            return dataclasses.replace(self, joints=tuple(own[name] for name in arm.joint_names))
        if len(self.joints) != arm.dof:
            missing = next(name for name in arm.joint_names if name not in own)
            raise DriveError(
                f"drive {self.name!r} has {len(self.joints)} joints and none called {missing!r}: arm "
                f"{arm.name!r} needs {', '.join(arm.joint_names)}"
            )
        pairs = zip(self.joints, arm.joint_names, strict=True)
        return dataclasses.replace(self, joints=tuple(dataclasses.replace(j, name=n) for j, n in pairs))


def _check(
    owner: object, where: str, zero_ok: tuple[str, ...] = (), infinite_ok: tuple[str, ...] = ()
) -> None:
    """Refuse numbers that are not positive (or not negative, where zero is meaningful)."""
    for each in dataclasses.fields(owner):  # type: ignore[arg-type]
        if each.type != "float":
            continue
        value = getattr(owner, each.name)
        number = is_number(value, infinite_ok=each.name in infinite_ok)
        if not number or value < 0 or (value == 0 and each.name not in zero_ok):
            least = "a number ≥ 0" if each.name in zero_ok else "a positive number"
            raise DriveError(f"{where}: {each.name} is {value!r}, expected {least}")
