"""The E-HMCS, or any frame of joint sensors like it, on a serial port."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armik_sym.device.angles import LiveAngles, LivePose, human_angles, human_motion, swivel_angle
    from armik_sym.device.calibration import (
        AngleConverter,
        Calibration,
        EncoderZero,
        JointCalibration,
        JointSetup,
        Posture,
        arm_setup,
        calibration_text,
        fit_calibration,
        load_calibration,
        parse_calibration,
        save_calibration,
    )
    from armik_sym.device.channels import Channel, DeviceInfo, SensorKind
    from armik_sym.device.protocol import (
        FrameParser,
        OtherFrame,
        ParserCounts,
        Sample,
        encode_info,
        encode_payload,
        encode_sample,
    )
    from armik_sym.device.protocol.firmware import write_firmware
    from armik_sym.device.recording import (
        DeviceRecording,
        Gap,
        GapReason,
        Recorder,
        RecorderStatus,
        RecordingSummary,
        SensorWarning,
        WarningKind,
        even_motion,
        read_recording,
    )
    from armik_sym.device.simulator import (
        Encoder,
        Faults,
        Potentiometer,
        SimulatedDevice,
        sensors_of,
        serve_pty,
        serve_socket,
        true_calibration,
    )

__all__ = [
    "AngleConverter",
    "Calibration",
    "Channel",
    "DeviceInfo",
    "DeviceRecording",
    "Encoder",
    "EncoderZero",
    "Faults",
    "FrameParser",
    "Gap",
    "GapReason",
    "JointCalibration",
    "JointSetup",
    "LiveAngles",
    "LivePose",
    "OtherFrame",
    "ParserCounts",
    "Posture",
    "Potentiometer",
    "Recorder",
    "RecorderStatus",
    "RecordingSummary",
    "Sample",
    "SensorKind",
    "SensorWarning",
    "SimulatedDevice",
    "WarningKind",
    "arm_setup",
    "calibration_text",
    "encode_info",
    "encode_payload",
    "encode_sample",
    "even_motion",
    "fit_calibration",
    "human_angles",
    "human_motion",
    "load_calibration",
    "parse_calibration",
    "read_recording",
    "save_calibration",
    "sensors_of",
    "serve_pty",
    "serve_socket",
    "swivel_angle",
    "true_calibration",
    "write_firmware",
]

# Where each public name lives. Loaded when first used, like the names of the package itself.
_HOMES = {
    "armik_sym.device.angles": ("LiveAngles", "LivePose", "human_angles", "human_motion", "swivel_angle"),
    "armik_sym.device.calibration": (
        "AngleConverter", "Calibration", "EncoderZero", "JointCalibration", "JointSetup", "Posture",
        "arm_setup", "calibration_text", "fit_calibration", "load_calibration", "parse_calibration",
        "save_calibration",
    ),
    "armik_sym.device.channels": ("Channel", "DeviceInfo", "SensorKind"),
    "armik_sym.device.protocol": (
        "FrameParser", "OtherFrame", "ParserCounts", "Sample", "encode_info", "encode_payload",
        "encode_sample",
    ),
    "armik_sym.device.protocol.firmware": ("write_firmware",),
    "armik_sym.device.recording": (
        "DeviceRecording", "Gap", "GapReason", "Recorder", "RecorderStatus", "RecordingSummary",
        "SensorWarning", "WarningKind", "even_motion", "read_recording",
    ),
    "armik_sym.device.simulator": (
        "Encoder", "Faults", "Potentiometer", "SimulatedDevice", "sensors_of", "serve_pty", "serve_socket",
        "true_calibration",
    ),
}  # fmt: skip
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'armik_sym.device' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
