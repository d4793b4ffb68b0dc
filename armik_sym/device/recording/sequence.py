"""Which samples are missing, by the numbers the device gives them."""

from __future__ import annotations

from dataclasses import dataclass

_ROUND = 1 << 32
_HALF = 1 << 31
_CLOCKS_APART = 0.5  # [s], what two clocks and the way from one to the other can differ after a gap
_CLOCKS_DRIFT = 0.02  # and how much more for each second of the gap


@dataclass(slots=True)
class SequenceCounter:
    """Numbers samples through, over the wrap of the device's counter and over its restarts.

    The numbers and the clock of a device that was switched off begin at 0 again. That shows as a step back of
    either; and after the port was lost also as a clock that went on less than the host's did.

    Attributes:
        number: Number of the latest sample, counted from the first one; what is missing is left out, too.
        lost: Samples that are missing by their numbers.
        restarts: How often the device began anew.
        wraps: Of the device's clock since the first sample or the latest restart.
        rate: What the device says its rate is, in [Hz], or None as long as it is not known.

    Source:
        None (this package).
    """

    number: int = -1
    lost: int = 0
    restarts: int = 0
    wraps: int = 0
    rate: float | None = None
    _sequence: int = 0
    _time: int = 0

    def step(self, sequence: int, time_us: int, gap: float = 0.0, reopened: bool = False) -> bool:
        """Take the numbers of the next sample.

        Args:
            sequence: Its number, modulo 2^32.
            time_us: The device's clock, modulo 2^32, in [µs].
            gap: By the clock of the host, how long nothing had come before this sample, in [s]; 0 if that
                was no time worth speaking of.
            reopened: Whether the port was lost in between.

        Returns:
            True if the device restarted between the sample before and this one.

        Source:
            None (this package).
        """
        if self.number < 0:
            self.number, self._sequence, self._time = 0, sequence, time_us
            return False
        ahead = (sequence - self._sequence) % _ROUND
        elapsed = (time_us - self._time) % _ROUND
        rounds = max(round((gap * 1e6 - elapsed) / _ROUND), 0)
        same = 0 < ahead < _HALF and (elapsed < _HALF or gap > 0)
        if same and reopened and ahead > 1:
            behind = gap - (elapsed + rounds * _ROUND) * 1e-6
            same = behind <= _CLOCKS_APART + _CLOCKS_DRIFT * gap
        if same:
            self.wraps += rounds + (time_us < self._time)
            missing = ahead - 1
        else:
            self.restarts += 1
            self.wraps = 0
            missing = self._since_start(sequence, time_us)
        self.number += missing + 1
        self.lost += missing
        self._sequence, self._time = sequence, time_us
        return not same

    def _since_start(self, sequence: int, time_us: int) -> int:
        """Samples a device sent since it was switched on, if its clock says that there was time for them."""
        if self.rate is None or sequence > 1.5 * self.rate * time_us * 1e-6 + 10:
            return 0
        return sequence
