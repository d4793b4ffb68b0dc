"""Small arms and motions for the tests of the servo."""

from __future__ import annotations

import math

import numpy as np

from armik_sym import HandPath
from armik_sym.arm import Arm, DHChain, DHConvention, DHLink, RangeOfMotion
from armik_sym.servo import Drive, Gear, JointDrive, JointPlant, Motor
from armik_sym.servo.body import RigidBody
from armik_sym.servo.motion import ArmMotion

PLANT = JointPlant(inertia=1.1, viscous=0.5, lag=1 / (2 * math.pi * 500), delay=0.0005, step=0.001)
MOTOR = Motor(24.0, 0.5, 0.0, 0.05, 3e-4, 0.4, 1.2, 500.0)


def two_links(convention: DHConvention = DHConvention.STANDARD) -> Arm:
    """A double pendulum in a vertical plane, hanging at q = 0 along -z of the world, which is x here."""
    rows = (DHLink("first", a=0.3), DHLink("second", a=0.25))
    limits = RangeOfMotion(np.full(2, -3.0), np.full(2, 3.0))
    return Arm("two_links", DHChain(rows, convention), limits, up=np.array([-1.0, 0.0, 0.0]))


def two_bodies() -> tuple[RigidBody, ...]:
    """Heavy bodies on both links."""
    inertia = np.diag([0.01, 0.05, 0.06])
    return (
        RigidBody("a", 1, 2.0, np.array([-0.15, 0.02, 0.0]), inertia),
        RigidBody("b", 2, 1.5, np.array([-0.1, 0.0, 0.01]), inertia),
    )


def plain_drive(
    names: tuple[str, ...], *, dry: float = 0.0, ratio: float = 50.0, motor: Motor = MOTOR
) -> Drive:
    """The same simple drive at every joint."""
    joints = tuple(JointDrive(name, motor, Gear(ratio), 500.0, viscous=0.5, dry=dry) for name in names)
    return Drive("plain", joints, rate=1000.0, delay=0.0005)


def swing(arm: Arm, size: float = 0.5, duration: float = 1.0, n: int = 101) -> ArmMotion:
    """From rest to rest, every joint by its own part of `size`, with a minimum-jerk profile."""
    time = np.linspace(0.0, duration, n)
    s = time / duration
    way = 10 * s**3 - 15 * s**4 + 6 * s**5
    return ArmMotion(arm, time, size * way[:, None] * np.linspace(1.0, 0.4, arm.dof))


def first_second(path: HandPath) -> HandPath:
    """The beginning of a path; simulating all of it tells a test nothing more."""
    n = int(np.searchsorted(path.time, path.time[0] + 1.0)) + 1
    rotation = None if path.rotation is None else path.rotation[:n]
    return HandPath(path.time[:n], path.position[:n], rotation)
