"""A device without hardware: it plays a motion as frames on a port, with sensors and faults."""

from armik_sym.device.simulator.encoder import Encoder
from armik_sym.device.simulator.faults import Faults, Jump, Silence, Stuck
from armik_sym.device.simulator.playback import AtEnd
from armik_sym.device.simulator.potentiometer import OpenWiper, Potentiometer
from armik_sym.device.simulator.sensor_layout import sensors_of
from armik_sym.device.simulator.serving import ServedDevice, serve_pty, serve_socket
from armik_sym.device.simulator.simulated_device import SimulatedDevice, WireFrame
from armik_sym.device.simulator.true_calibration import true_calibration
from armik_sym.device.simulator.truth import Fate, Truth

__all__ = [
    "AtEnd",
    "Encoder",
    "Fate",
    "Faults",
    "Jump",
    "OpenWiper",
    "Potentiometer",
    "ServedDevice",
    "Silence",
    "SimulatedDevice",
    "Stuck",
    "Truth",
    "WireFrame",
    "sensors_of",
    "serve_pty",
    "serve_socket",
    "true_calibration",
]
