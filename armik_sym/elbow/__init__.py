"""Angles of the measuring device as angles of the human arm, and back.

The E-HMCS abducts first and flexes second, the human arm the other way round: their first three angles
differ while the upper arm points the same way. `device_to_human` is eq. (8) of Nguyen 2021, right in every
quadrant; `human_posture` converts whole postures of `catalog.ehmcs` to postures of `catalog.human`.
"""

from armik_sym.elbow.conversion import device_to_human, human_to_device
from armik_sym.elbow.postures import device_posture, human_posture
from armik_sym.symbolic.elbow_direction import device_elbow_direction, human_elbow_direction

__all__ = [
    "device_elbow_direction",
    "device_posture",
    "device_to_human",
    "human_elbow_direction",
    "human_posture",
    "human_to_device",
]
