"""Every error and warning the package raises on purpose.

Each error derives from `ArmikError` and from the builtin that fits, so that callers can catch
either. Messages say what is wrong, with which value, what was expected and what to do.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray


class ArmikError(Exception):
    """Base of all errors raised on purpose by this package."""


class ShapeError(ArmikError, ValueError):
    """An array does not have the shape that is needed."""


class UnitError(ArmikError, ValueError):
    """A quantity has no declared unit, an unknown one, or one its values contradict."""


class ArmModelError(ArmikError, ValueError):
    """An arm is described wrongly: DH rows, range of motion, segment lengths or names."""


class ArmFileError(ArmModelError):
    """An arm or patient file cannot be read or contradicts itself."""


class HandPathError(ArmikError, ValueError):
    """A hand path holds values that cannot be followed: NaN, time running backwards, no rotation."""


class MotionFileError(ArmikError, ValueError):
    """A motion file cannot be read, is cut off, or does not declare what is needed."""


class RecordingError(ArmikError, ValueError):
    """A marker recording holds values that make no recording, or lacks what is asked of it."""


class ProtocolError(ArmikError, ValueError):
    """A value does not fit the frame it is to be sent in, or a device speaks another protocol."""


class CalibrationError(ArmikError, ValueError):
    """A calibration cannot be made, read or used: postures that leave it open, another device, a bad file."""


class DeviceError(ArmikError, RuntimeError):
    """A device cannot be reached, or does not do what is needed."""


class LimitError(ArmikError, ValueError):
    """A posture leaves the range of motion, or limits contradict each other."""


class OptionError(ArmikError, ValueError):
    """An option has a value the method cannot work with."""


class DriveError(ArmikError, ValueError):
    """A drive, a load or a drive file is described wrongly."""


class TuningError(ArmikError, ValueError):
    """No controller of the kind asked for has the bandwidth and phase margin asked for."""


class RetimingError(ArmikError, ValueError):
    """A motion cannot be re-timed under the limits given."""


class UnknownNameError(ArmikError, ValueError):
    """A name that does not exist; the message lists those that do."""

    def __init__(self, kind: str, name: object, valid: Iterable[str]) -> None:
        self.kind = kind
        self.name = name
        self.valid = sorted(valid)
        super().__init__(f"unknown {kind} {name!r}: valid are {', '.join(self.valid)}")


class CompilerError(ArmikError, RuntimeError):
    """The C compiler is missing or failed; `output` holds what it printed."""

    def __init__(self, message: str, output: str = "") -> None:
        self.output = output
        super().__init__(message if not output else f"{message}\n{output.strip()}")


class UnreachablePathError(ArmikError, RuntimeError):
    """The arm cannot bring the hand to some samples of the path.

    Attributes:
        samples: Indices of the samples that cannot be reached, shape (k,).
        shortfall: How far the hand stays away from each of them, shape (k,), in [m].
        turn: How far the hand stays turned away, shape (k,), in [rad].
    """

    def __init__(
        self,
        message: str,
        samples: Sequence[int] | NDArray[np.int64],
        shortfall: NDArray[np.float64],
        turn: NDArray[np.float64],
    ) -> None:
        self.samples = np.asarray(samples, dtype=np.int64)
        self.shortfall = shortfall
        self.turn = turn
        super().__init__(message)


class SolverError(ArmikError, RuntimeError):
    """A solver stopped without an answer that can be trusted; `status` is its own word for why."""

    def __init__(self, message: str, status: str = "") -> None:
        self.status = status
        super().__init__(message)


class ArmikWarning(UserWarning):
    """Base of the warnings of this package."""


class CompilerWarning(ArmikWarning):
    """Kinematics run in CasADi's virtual machine because no C compiler could be used."""


class CacheWarning(ArmikWarning):
    """The per-user cache folder cannot be used; compiled code lives in a temporary folder."""


class CalibrationWarning(ArmikWarning):
    """A device counts otherwise than its calibration says, such as after it was switched off."""


class MotionFileWarning(ArmikWarning):
    """A motion file contradicts itself in a way that can be lived with, such as frames it promised."""
