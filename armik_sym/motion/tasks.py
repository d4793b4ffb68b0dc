"""The five tasks of Nguyen 2021 as bundled motions.

They are synthetic: the recordings were never published.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from armik_sym.errors import UnknownNameError
from armik_sym.motion.bundled import data_folder
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_csv import read_joint_angles
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.path_csv import read_path

_TITLES: Mapping[str, str] = {
    "drinking_reach": "Drinking, reaching for the cup",
    "drinking_lift": "Drinking, lifting the cup to the mouth",
    "brushing": "Brushing teeth",
    "playing_ball": "Playing ball",
    "catching_ball": "Catching a ball",
}


@dataclass(frozen=True, eq=False)
class Task:
    """One task: what the hand did, and what the joints did meanwhile.

    Attributes:
        name: Short name, as in `task_names()`.
        title: Name in words.
        path: Path of the hand frame, position and rotation, computed from the measured angles.
        measured: Joint angles as the exoskeleton would have measured them (synthetic).
        arm_name: The arm of the catalogue that the angles belong to.

    Source:
        Nguyen 2021, §4.1 and Figs. 8-13 (what the tasks are; the numbers are made).
    """

    name: str
    title: str
    path: HandPath
    measured: JointMotion
    arm_name: str = "ehmcs"


def task_names() -> tuple[str, ...]:
    """Names of the five tasks, in the order of the paper.

    Returns:
        The names.

    Source:
        Nguyen 2021, Table 6.
    """
    return tuple(_TITLES)


def load_task(name: str) -> Task:
    """Load one of the five bundled tasks.

    Args:
        name: One of `task_names()`.

    Returns:
        The task, in SI units.

    Raises:
        UnknownNameError: If there is no task of that name.
        MotionFileError: If the bundled files are missing or damaged.

    Source:
        Nguyen 2021, §4.1 and Figs. 8-13 (what the tasks are; the numbers are made, see
        `data/make_tasks.py`).
    """
    if name not in _TITLES:
        raise UnknownNameError("task", name, _TITLES)
    folder = data_folder() / "tasks"
    return Task(
        name=name,
        title=_TITLES[name],
        path=read_path(folder / f"{name}_path.csv"),
        measured=read_joint_angles(folder / f"{name}_angles.csv"),
    )
