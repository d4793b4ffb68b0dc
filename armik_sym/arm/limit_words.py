"""The limits of a joint in the words of people who measure ranges of motion."""

from __future__ import annotations

from armik_sym.arm.display_units import joint_unit
from armik_sym.arm.model import Arm

_PAIRS = (
    ("flexion", "extension"),
    ("abduction", "adduction"),
    ("internal_rotation", "external_rotation"),
    ("pronation", "supination"),
    ("ulnar_deviation", "radial_deviation"),
)
_OPPOSITE = {one: other for a, b in _PAIRS for one, other in ((a, b), (b, a))}


def opposite_movement(name: str) -> str | None:
    """The movement that undoes another: "wrist_extension" → "wrist_flexion".

    Args:
        name: Name of a joint, which is the movement that increases its angle.

    Returns:
        The opposite movement, None if the name does not end with a movement that has one.

    Source:
        None (anatomical terms).
    """
    for movement, opposite in _OPPOSITE.items():
        if name == movement or name.endswith("_" + movement):
            return name[: len(name) - len(movement)] + opposite
    return None


def limit_words(arm: Arm, joint: int, upper: bool) -> str:
    """A limit of a joint in words, with its value.

    The lower limit of "wrist_extension" at -73° is the "wrist flexion limit (73°)"; where a range does not
    contain 0 the limit next to it is the least of a movement: "least elbow flexion (35°)".

    Args:
        arm: The arm.
        joint: Index of the joint.
        upper: Whether its upper limit is meant.

    Returns:
        The words.

    Source:
        None (anatomical terms).
    """
    name, unit = arm.joint_names[joint], joint_unit(arm, joint)
    value = float(arm.rom.upper[joint] if upper else arm.rom.lower[joint])
    opposite = opposite_movement(name)
    if opposite is None:
        return f"{_plain(name)} {'upper' if upper else 'lower'} limit ({unit.text(value)})"
    outwards = (value if upper else -value) + 0.0  # no "-0°"
    if outwards >= 0:
        return f"{_plain(name if upper else opposite)} limit ({unit.text(outwards)})"
    return f"least {_plain(opposite if upper else name)} ({unit.text(-outwards)})"


def _plain(name: str) -> str:
    return name.replace("_", " ")
