"""A calibration in dialogue with the person who wears the device."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from armik_sym.device.calibration.converter import sample_arrays
from armik_sym.device.calibration.held import complaint
from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.posture_log import PostureLog
from armik_sym.device.calibration.setup import JointSetup
from armik_sym.device.calibration.steps import Step
from armik_sym.device.calibration.tap import Tap
from armik_sym.device.channels import DeviceInfo
from armik_sym.errors import CalibrationError

ATTEMPTS = 4
"""How often a posture may be tried."""


class Dialogue(Protocol):
    """How to talk to the person."""

    def say(self, text: str) -> None:
        """Tell something.

        Args:
            text: The text.

        Source:
            None (dialogue).
        """

    def angle_deg(self, joint: str, proposed_deg: float) -> float:
        """Ask for the angle at which a joint is held, when it is still.

        Args:
            joint: The joint.
            proposed_deg: What it should be, in [deg].

        Returns:
            What it is, in [deg].

        Source:
            None (dialogue).
        """

    def ready(self) -> None:
        """Wait until the posture is held."""


def take_postures(
    tap: Tap,
    info: DeviceInfo,
    setups: Sequence[JointSetup],
    steps: Sequence[Step],
    dialogue: Dialogue,
    seconds: float = 1.0,
    log: PostureLog | None = None,
) -> list[Posture]:
    """Take posture after posture; one that was not held as meant is taken again.

    Args:
        tap: The device.
        info: What it says about itself.
        setups: The joints.
        steps: The postures.
        dialogue: How to talk to the person.
        seconds: How long each is recorded, in [s].
        log: Where they are written down as they are taken; those that it has already are not taken again.

    Returns:
        The postures.

    Raises:
        CalibrationError: If a posture could not be taken in four attempts.
        DeviceError: If the device falls silent.

    Source:
        None (this package).
    """
    taken: dict[str, Posture] = {} if log is None else dict(log.postures)
    for number, step in enumerate(steps, start=1):
        if step.name in taken:
            continue
        dialogue.say(f"\nPosture {number} of {len(steps)}: {step.name}\n{step.text}")
        start, said = taken.get(step.start or ""), None
        for _ in range(ATTEMPTS):
            posture, said = _attempt(tap, info, setups, step, start, dialogue, seconds)
            if posture is not None:
                taken[step.name] = posture
                if log is not None:
                    log.add(posture)
                break
            dialogue.say(f"Not taken: {said}\nOnce more.")
        else:
            raise CalibrationError(f"posture {step.name!r} given up after {ATTEMPTS} attempts: {said}")
    return list(taken.values())


def _attempt(
    tap: Tap,
    info: DeviceInfo,
    setups: Sequence[JointSetup],
    step: Step,
    start: Posture | None,
    dialogue: Dialogue,
    seconds: float,
) -> tuple[Posture | None, str | None]:
    """A posture, or what was wrong with it."""
    try:
        posture = _hold(tap, setups, step, dialogue, seconds)
    except CalibrationError as error:
        return None, str(error)
    wrong = complaint(info, setups, posture, start, step.joint)
    return (posture, None) if wrong is None else (None, wrong)


def _hold(tap: Tap, setups: Sequence[JointSetup], step: Step, dialogue: Dialogue, seconds: float) -> Posture:
    if step.joint is None:
        angles = {setup.joint: math.radians(step.angle_deg) for setup in setups}
        dialogue.ready()
    else:
        angles = {step.joint: math.radians(dialogue.angle_deg(step.joint, step.angle_deg))}
    counts, _ = sample_arrays(tap.collect(seconds))
    return Posture(step.name, angles, counts, tap.pulses())
