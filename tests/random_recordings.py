"""Random marker recordings for round trips, with gaps, odd names and odd rates."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from armik_sym.motion.marker_recording import MarkerRecording

RATES = st.one_of(
    st.sampled_from([59.94, 29.97, 100.0, 120.0, 69.992615, 1000.0, 23.976]),
    st.floats(0.5, 5000.0, allow_nan=False),
)
COORDINATES = st.one_of(
    st.floats(-20.0, 20.0, allow_nan=False), st.sampled_from([0.0, -0.0, 1e-300, 5e-324, 1 / 3, -1e-9, 1e5])
)


def names(forbidden: str = "", size: int = 24) -> st.SearchStrategy[list[str]]:
    """Names as people give them: letters of any alphabet, digits, colons, blanks inside."""
    letters = st.characters(
        codec="utf-8", categories=("L", "N", "P", "S", "Zs"), exclude_characters=forbidden
    )
    name = st.text(letters, min_size=1, max_size=size).map(str.strip).filter(bool)
    return st.lists(name, min_size=1, max_size=4, unique=True)


@st.composite
def recordings(draw: st.DrawFn, forbidden: str = "", grid: bool = False) -> MarkerRecording:
    """A recording; on a grid its times are whole frames of the declared rate."""
    labels = tuple(draw(names(forbidden)))
    n = draw(st.integers(1, 6))
    rate = draw(RATES)
    first = draw(st.integers(0, 500))
    time = np.arange(first, first + n) / rate
    values = draw(st.lists(COORDINATES, min_size=3 * n * len(labels), max_size=3 * n * len(labels)))
    position = np.array(values).reshape(n, len(labels), 3)
    missing = draw(st.lists(st.booleans(), min_size=n * len(labels), max_size=n * len(labels)))
    position[np.array(missing).reshape(n, len(labels))] = np.nan
    declared = rate if grid or draw(st.booleans()) else None
    return MarkerRecording(time, labels, position, declared_rate=declared)


def assert_same(read: MarkerRecording, written: MarkerRecording) -> None:
    """The same to the last bit, gaps included."""
    assert read.names == written.names
    np.testing.assert_array_equal(read.time, written.time)
    np.testing.assert_array_equal(read.position, written.position)
    if written.declared_rate is not None:
        assert read.rate == written.declared_rate
