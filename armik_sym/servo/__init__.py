"""Joint servos: can the drives of an exoskeleton follow this motion, and if not, how much slower can they?"""

from armik_sym.servo.body import RigidBody, Subject
from armik_sym.servo.check import ServoCheck, check
from armik_sym.servo.controller import Cascade, Pid
from armik_sym.servo.drive import Drive, Gear, JointDrive, Motor
from armik_sym.servo.drive_file import drives, load_drive
from armik_sym.servo.margins import LoopMargins, loop_margins
from armik_sym.servo.motion import ArmMotion
from armik_sym.servo.plant import JointPlant
from armik_sym.servo.retiming import Retimed, retime
from armik_sym.servo.setup import ServoOptions
from armik_sym.servo.tuning import tune_cascade, tune_pid
from armik_sym.servo.verdict import JointVerdict, Tolerances

__all__ = [
    "ArmMotion",
    "Cascade",
    "Drive",
    "Gear",
    "JointDrive",
    "JointPlant",
    "JointVerdict",
    "LoopMargins",
    "Motor",
    "Pid",
    "Retimed",
    "RigidBody",
    "ServoCheck",
    "ServoOptions",
    "Subject",
    "Tolerances",
    "check",
    "drives",
    "load_drive",
    "loop_margins",
    "retime",
    "tune_cascade",
    "tune_pid",
]
