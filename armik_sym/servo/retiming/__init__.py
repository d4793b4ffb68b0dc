"""The same path in another time: as fast as limits of speed and acceleration allow."""

from armik_sym.servo.retiming.retime import drive_limits, retime
from armik_sym.servo.retiming.retimed import Retimed

__all__ = ["Retimed", "drive_limits", "retime"]
