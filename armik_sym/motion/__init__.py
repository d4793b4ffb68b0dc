"""Recorded motion in, solved motion out: markers, hand paths, joint angles and the bundled tasks."""

from armik_sym.motion.bvh import read_bvh, write_bvh
from armik_sym.motion.bvh_motion import BvhMotion
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_csv import read_joint_angles, write_joint_angles
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.motion.marker_recording import MarkerRecording
from armik_sym.motion.path_csv import read_path, write_path
from armik_sym.motion.read_markers import read_markers, write_markers
from armik_sym.motion.read_motion import read_motion, write_motion
from armik_sym.motion.storage import read_storage, write_storage
from armik_sym.motion.storage_table import StorageTable
from armik_sym.motion.tasks import Task, load_task, task_names

__all__ = [
    "BvhMotion",
    "HandPath",
    "JointMotion",
    "MarkerRecording",
    "StorageTable",
    "Task",
    "load_task",
    "read_bvh",
    "read_joint_angles",
    "read_markers",
    "read_motion",
    "read_path",
    "read_storage",
    "task_names",
    "write_bvh",
    "write_joint_angles",
    "write_markers",
    "write_motion",
    "write_path",
    "write_storage",
]
