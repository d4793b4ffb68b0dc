"""Markers over time, as a motion-capture system recorded them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import HandPathError, RecordingError, ShapeError, UnknownNameError
from armik_sym.motion.checks import check_finite, check_increasing, check_shape, float_copy
from armik_sym.motion.low_pass import check_even, low_pass
from armik_sym.motion.marker_gaps import Filling, MarkerGaps, check_fill, fill_gaps, gaps_of
from armik_sym.motion.promised_rows import joined
from armik_sym.motion.table_checks import contradicting_rate

Array = NDArray[np.float64]

# In any unit a number that can be written, and whose square is one, in [m].
_FARTHEST = 1e100


@dataclass(frozen=True, eq=False, repr=False)
class MarkerRecording:
    """Positions of named markers over time; a marker that was not seen is NaN.

    Attributes:
        time: Strictly increasing times, shape (n,) with n ≥ 1, in [s]; read-only.
        names: Names of the m markers, each once, such as "RELB" or "subject:RELB".
        position: Positions, shape (n, m, 3), in [m]; NaN in all three coordinates where a marker is
            missing (one missing coordinate makes the marker missing); read-only.
        note: What was done to the data and what was odd in the file, in words.
        source: Where the data come from, such as a file name.
        declared_rate: Samples per second the file declares, in [Hz], or None; times in files are often
            rounded, the declared rate (59.94) is not.

    Raises:
        ShapeError: If shapes or the number of names do not fit.
        RecordingError: If time does not increase, a value is infinite (or beyond 10¹⁰⁰ m), a name is
            empty or occurs twice, or the declared rate contradicts the times by more than 1 %.

    Source:
        None (definition).
    """

    time: Array
    names: tuple[str, ...]
    position: Array
    note: str = ""
    source: str = ""
    declared_rate: float | None = None

    def __post_init__(self) -> None:
        names = _checked_names(self.names)
        try:
            time, position = _checked_values(self.time, self.position, len(names))
        except HandPathError as error:
            raise RecordingError(str(error)) from None
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "position", position)
        _check_rate(time, self.declared_rate)

    @property
    def n(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, in [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def rate(self) -> float:
        """Samples per second, in [Hz]: as declared, else (n - 1) / duration; NaN for a single sample."""
        if self.declared_rate is not None:
            return self.declared_rate
        return (self.n - 1) / self.duration if self.n > 1 else float("nan")

    @property
    def gaps(self) -> tuple[MarkerGaps, ...]:
        """Gaps of every marker, in the order of `names`."""
        return tuple(gaps_of(name, self.time, self.position[:, i]) for i, name in enumerate(self.names))

    def of(self, name: str) -> Array:
        """Positions of one marker.

        Args:
            name: Its name; a name without its prefix ("RELB" for "subject:RELB") will do if only one
                marker ends so.

        Returns:
            Positions, shape (n, 3), in [m]; NaN where it is missing; read-only.

        Raises:
            UnknownNameError: If there is no such marker, or several.

        Source:
            None (bookkeeping).
        """
        return self.position[:, self.index(name)]

    def index(self, name: str) -> int:
        """Index of one marker in `names`.

        Args:
            name: Its name, with or without its prefix, as in `of`.

        Returns:
            The index.

        Raises:
            UnknownNameError: If there is no such marker, or several.

        Source:
            None (bookkeeping).
        """
        if name in self.names:
            return self.names.index(name)
        found = [i for i, full in enumerate(self.names) if full.endswith(f":{name}")]
        if len(found) != 1:
            raise UnknownNameError("marker", name, [self.names[i] for i in found] or self.names)
        return found[0]

    def selected(self, names: Sequence[str]) -> MarkerRecording:
        """Only some of the markers.

        Args:
            names: Their names, in the order wanted, as in `of`.

        Returns:
            The recording of these.

        Raises:
            UnknownNameError: If there is no such marker, or several.

        Source:
            None (bookkeeping).
        """
        chosen = [self.index(name) for name in names]
        return replace(self, names=tuple(self.names[i] for i in chosen), position=self.position[:, chosen])

    def renamed(self, mapping: Mapping[str, str]) -> MarkerRecording:
        """The same recording with other names.

        Args:
            mapping: New name for old name, as in `of`; markers not listed keep theirs.

        Returns:
            The recording.

        Raises:
            UnknownNameError: If there is no such marker, or several.
            RecordingError: If a name would occur twice.

        Source:
            None (bookkeeping).
        """
        names = list(self.names)
        for old, new in mapping.items():
            names[self.index(old)] = new
        return replace(self, names=tuple(names))

    def filled(self, method: str = "cubic", longest: float = 0.1) -> MarkerRecording:
        """Fill gaps that are short enough; the note states method, number and the longest gap filled.

        Args:
            method: "linear" or "cubic" (spline).
            longest: Longest gap to fill, in [s], between the samples on its two sides; gaps at the ends
                of the recording stay open.

        Returns:
            The recording.

        Raises:
            OptionError: If the method is another one, or the length is not positive.

        Source:
            None (this package).
        """
        check_fill(method, longest)
        position, done = self.position.copy(), Filling(0, 0, 0.0, 0)
        for i in range(len(self.names)):
            position[:, i], filling = fill_gaps(self.time, self.position[:, i], method, longest)
            done += filling
        said = (
            f"gaps up to {longest:g} s filled by {method} interpolation: {done.gaps} gaps, {done.samples} "
            f"samples, the longest {done.longest:.4g} s; {done.left} gaps left open"
        )
        return replace(self, position=position, note=joined(self.note, said))

    def filtered(self, cutoff_hz: float) -> MarkerRecording:
        """Low-pass filter without phase shift, between gaps; the note states it.

        Args:
            cutoff_hz: Frequency at which the amplitude falls to 1/√2, in [Hz].

        Returns:
            The recording.

        Raises:
            OptionError: If the cut-off is not between 0 and half the rate.
            RecordingError: If the times are not evenly spaced.

        Source:
            Winter (2009), Biomechanics and motor control of human movement, section 3.4.4.2.
        """
        check_even(self.time)
        position = np.stack(
            [low_pass(self.position[:, i], self.rate, cutoff_hz) for i in range(len(self.names))], axis=1
        )
        said = f"low-pass filtered at {cutoff_hz:g} Hz (Butterworth, second order, forwards and backwards)"
        return replace(self, position=position, note=joined(self.note, said))

    def __len__(self) -> int:
        return self.n

    def __repr__(self) -> str:
        missing = float(np.isnan(self.position[..., 0]).mean())
        return (
            f"MarkerRecording({len(self.names)} markers, {self.n} samples, {self.duration:g} s at "
            f"{self.rate:g} Hz, {100 * missing:.1f} % missing{', ' + self.source if self.source else ''})"
        )


def _checked_values(time: Array, position: Array, m: int) -> tuple[Array, Array]:
    t, p = float_copy(time, "time"), float_copy(position, "position")
    check_shape(t, "time", (None,), "(n,)")
    if len(t) < 1:
        raise ShapeError("time has shape (0,), expected (n,) with n ≥ 1: a recording needs a sample")
    n = len(t)
    check_shape(p, "position", (n, m, 3), f"({n}, {m}, 3): {n} times, {m} names, 3 coordinates")
    check_finite(t, "time")
    check_increasing(t)
    far = np.argwhere(np.abs(p) > _FARTHEST)
    if far.size:
        i, j, k = far[0]
        said = "is infinite" if np.isinf(p[i, j, k]) else f"has the coordinate {p[i, j, k]:g} m"
        raise RecordingError(f"position of sample {i}, marker {j} {said}: a missing marker is NaN")
    p = np.where(np.isnan(p).any(axis=2, keepdims=True), np.nan, p)
    p.flags.writeable = False
    return t, p


def _checked_names(names: Sequence[str]) -> tuple[str, ...]:
    if isinstance(names, str):
        raise RecordingError(f"names is the text {names!r}, expected a tuple with one name for each marker")
    given = tuple(names)
    for i, name in enumerate(given):
        if not isinstance(name, str) or not name.strip():
            raise RecordingError(f"name of marker {i} is {name!r}, expected a text that is not blank")
    repeated = (
        [name for i, name in enumerate(given) if name in given[:i]] if len(set(given)) < len(given) else []
    )
    if repeated:
        raise RecordingError(f"marker {repeated[0]!r} occurs twice: every marker needs its own name")
    if not given:
        raise ShapeError("names is empty: a recording needs a marker")
    return given


def _check_rate(time: Array, rate: float | None) -> None:
    if rate is None:
        return
    if not (np.isfinite(rate) and rate > 0):
        raise RecordingError(f"declared_rate is {rate!r} Hz, expected a positive number")
    measured = contradicting_rate(rate, time)
    if measured is not None:
        raise RecordingError(
            f"declared_rate is {rate:g} Hz, but the times have {measured:g} samples per second: one of the "
            "two is wrong"
        )
