"""Recording a device: the port, the recorder, the file it writes, and its reader; see docs/device.md."""

from armik_sym.device.recording.device_recording import DeviceRecording
from armik_sym.device.recording.even_motion import even_motion
from armik_sym.device.recording.gap import Gap
from armik_sym.device.recording.host_frames import GapReason
from armik_sym.device.recording.port import DEFAULT_BAUD, Port
from armik_sym.device.recording.read_recording import read_recording
from armik_sym.device.recording.recorder import Recorder
from armik_sym.device.recording.sensor_warning import SensorWarning, WarningKind
from armik_sym.device.recording.status import RecorderStatus, RecordingSummary

__all__ = [
    "DEFAULT_BAUD",
    "DeviceRecording",
    "Gap",
    "GapReason",
    "Port",
    "Recorder",
    "RecorderStatus",
    "RecordingSummary",
    "SensorWarning",
    "WarningKind",
    "even_motion",
    "read_recording",
]
