"""What an arm is: DH chain, range of motion, segment lengths, and the catalogue of arms."""

from armik_sym.arm import catalog
from armik_sym.arm.chain import DHChain
from armik_sym.arm.dh import DHConvention, DHLink, JointType
from armik_sym.arm.load_arm import load_arm
from armik_sym.arm.model import Arm
from armik_sym.arm.range_of_motion import RangeOfMotion
from armik_sym.arm.save_arm import save_arm
from armik_sym.arm.segment_lengths import segment_lengths
from armik_sym.arm.urdf import save_urdf

__all__ = [
    "Arm",
    "DHChain",
    "DHConvention",
    "DHLink",
    "JointType",
    "RangeOfMotion",
    "catalog",
    "load_arm",
    "save_arm",
    "save_urdf",
    "segment_lengths",
]
