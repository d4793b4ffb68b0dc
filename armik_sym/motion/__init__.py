"""Recorded motion in, solved motion out: hand paths, joint angles and the bundled tasks."""

from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_csv import read_joint_angles, write_joint_angles
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.path_csv import read_path, write_path
from armik_sym.motion.tasks import Task, load_task, task_names

__all__ = [
    "HandPath",
    "JointMotion",
    "Task",
    "load_task",
    "read_joint_angles",
    "read_path",
    "task_names",
    "write_joint_angles",
    "write_path",
]
