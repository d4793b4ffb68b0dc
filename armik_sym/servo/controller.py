"""Position controllers of one joint: PID, and position over speed (P-PI)."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from armik_sym.errors import DriveError
from armik_sym.servo.given_number import is_number
from armik_sym.servo.linear import Sampled


@dataclass(frozen=True)
class Pid:
    """PID with filtered derivative, by backward differences.

    u = kp e + I + D, I⁺ = I + ki T e, D⁺ = (tf D + kd (e - e_before)) / (tf + T). Beyond the limits of the
    torque, I⁺ is pulled back by (T / tracking) (u_limited - u).

    Attributes:
        kp: In [Nm/rad].
        ki: In [Nm/(rad s)].
        kd: In [Nm s/rad].
        filter_time: tf, of the derivative, in [s].
        tracking_time: Of the anti-windup, in [s].

    Raises:
        DriveError: If a gain is negative or no number, or the tracking time is not positive.

    Source:
        Åström & Hägglund, Advanced PID Control (2006), §3.5 (anti-windup by back-calculation) and §13.
    """

    kp: float
    ki: float
    kd: float
    filter_time: float
    tracking_time: float

    def __post_init__(self) -> None:
        _check(self)

    def sampled(self, step: float) -> Sampled:
        """From error to torque, for small motion.

        Args:
            step: Sampling time, in [s].

        Returns:
            The system; states I, D and the error before.

        Source:
            None (definition above).
        """
        keep = self.filter_time / (self.filter_time + step)
        rate = self.kd / (self.filter_time + step)
        A = np.array([[1.0, 0.0, 0.0], [0.0, keep, -rate], [0.0, 0.0, 0.0]])
        b = np.array([self.ki * step, rate, 1.0])
        c = np.array([1.0, keep, -rate])
        return Sampled(A, b, c, self.kp + self.ki * step + rate, step)


@dataclass(frozen=True)
class Cascade:
    """Position over speed: v* = kp e + ff, u = kv (v* - v) + I, I⁺ = I + ki T (v* - v), v = (q - q_before)/T.

    Beyond the limits of the torque, I⁺ is pulled back by (T / tracking) (u_limited - u).

    Attributes:
        kp: Of the position loop, in [1/s].
        kv: Of the speed loop, in [Nm s/rad].
        ki: Of the speed loop, in [Nm/rad].
        tracking_time: Of the anti-windup, in [s].

    Raises:
        DriveError: If a gain is negative or no number, or the tracking time is not positive.

    Source:
        Siciliano et al. 2009, §8.3.2 (position and velocity feedback).
    """

    kp: float
    kv: float
    ki: float
    tracking_time: float

    def __post_init__(self) -> None:
        _check(self)

    def sampled(self, step: float) -> Sampled:
        """From error to torque with a wanted angle that stands still: the loop cut at the torque.

        Args:
            step: Sampling time, in [s].

        Returns:
            The system; states I and the error before.

        Source:
            None (definition above).
        """
        per_error, gain = self.kp + 1.0 / step, self.kv + self.ki * step
        A = np.array([[1.0, -self.ki], [0.0, 0.0]])
        b = np.array([self.ki * step * per_error, 1.0])
        c = np.array([1.0, -gain / step])
        return Sampled(A, b, c, gain * per_error, step)


Controller = Pid | Cascade


def _check(controller: Controller) -> None:
    for key, value in asdict(controller).items():
        positive = key == "tracking_time"  # the anti-windup divides by it
        if not is_number(value) or value < 0 or (positive and value == 0):
            raise DriveError(
                f"{type(controller).__name__}: {key} is {value!r}, expected "
                f"{'a positive number' if positive else 'a number ≥ 0'}"
            )
