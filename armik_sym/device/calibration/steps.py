"""The postures of a guided calibration, in plain words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from armik_sym.device.calibration.setup import JointSetup

ZERO_POSE = "zero pose"
_BENT = "elbow bent"
_LEGEND = (
    "Let the arm hang straight down beside the body: elbow straight, palm towards the thigh, hand in line "
    "with the forearm. Every joint is at 0° now."
)

# Posture to start from, what to do, and an angle that a person can hold, in [deg].
_KNOWN: dict[str, tuple[str, str, float]] = {
    "shoulder_abduction": (ZERO_POSE, "Lift the straight arm out to the side until it is level.", 90.0),
    "shoulder_flexion": (ZERO_POSE, "Lift the straight arm to the front until it is level.", 90.0),
    "elbow_flexion": (ZERO_POSE, "Bend the elbow until the forearm points level ahead, thumb up.", 90.0),
    "shoulder_internal_rotation": (
        _BENT,
        "Keep the elbow bent, turn the forearm inwards, to the belly.",
        45.0,
    ),
    "forearm_pronation": (_BENT, "Keep the elbow bent, turn the palm downwards (thumb inwards).", 60.0),
    "wrist_extension": (ZERO_POSE, "Let the arm hang, bend the hand backwards, towards its back.", 45.0),
    "wrist_ulnar_deviation": (ZERO_POSE, "Let the arm hang, bend the hand towards the little finger.", 30.0),
}
_LAST = ("shoulder_internal_rotation", "forearm_pronation")


@dataclass(frozen=True, slots=True)
class Step:
    """One posture to take.

    Attributes:
        name: What it is called.
        text: What to do.
        joint: The joint that moves; None if all are at a known angle.
        angle_deg: The angle proposed for it, in [deg].
        start: Name of the posture from which only this joint moves; None for the first.
    """

    name: str
    text: str
    joint: str | None
    angle_deg: float
    start: str | None


def guided_steps(setups: Sequence[JointSetup], thorough: bool = False) -> list[Step]:
    """The postures that determine all joints, each a small change of one before.

    Args:
        setups: The joints.
        thorough: Whether every joint is also held half-way, so that a wrong angle is found out.

    Returns:
        The postures, the zero pose first.

    Source:
        None (this package); angles in the ranges of Nguyen 2021, Table 2.
    """
    names = [setup.joint for setup in setups]
    # Rotation and pronation can be seen with a bent elbow only: they come after it, and start from it.
    ordered = [name for name in names if name not in _LAST] + [name for name in names if name in _LAST]
    steps = [Step(ZERO_POSE, _LEGEND, None, 0.0, None)]
    for joint in ordered:
        start, text, angle = _KNOWN.get(
            joint, (ZERO_POSE, f"From the zero pose move {joint} alone to a known angle.", 90.0)
        )
        if start == _BENT:
            start = _name("elbow_flexion", 90.0) if "elbow_flexion" in names else ZERO_POSE
        steps.append(Step(_name(joint, angle), text, joint, angle, start))
        if thorough:
            half = f"{text} This time go half-way only."
            steps.append(Step(_name(joint, angle / 2), half, joint, angle / 2, start))
    return steps


def _name(joint: str, angle_deg: float) -> str:
    return f"{joint} at {angle_deg:g}°"
