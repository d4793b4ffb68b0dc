"""From raw counts of a device to joint angles: what a calibration is, and how it is found."""

from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.calibration_file import load_calibration, parse_calibration
from armik_sym.device.calibration.converter import AngleConverter, sample_arrays
from armik_sym.device.calibration.encoder import EncoderZero
from armik_sym.device.calibration.fit import fit_calibration
from armik_sym.device.calibration.joint import JointCalibration, JointQuality, ScaleSource
from armik_sym.device.calibration.posture import Posture
from armik_sym.device.calibration.setup import JointSetup, arm_setup, datasheet_scale
from armik_sym.device.calibration.write import calibration_text, save_calibration

__all__ = [
    "AngleConverter",
    "Calibration",
    "EncoderZero",
    "JointCalibration",
    "JointQuality",
    "JointSetup",
    "Posture",
    "ScaleSource",
    "arm_setup",
    "calibration_text",
    "datasheet_scale",
    "fit_calibration",
    "load_calibration",
    "parse_calibration",
    "sample_arrays",
    "save_calibration",
]
