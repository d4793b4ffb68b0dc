"""Segment lengths from body height, and heights that are no metres."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from armik_sym.arm.catalog import human
from armik_sym.arm.segment_lengths import segment_lengths
from armik_sym.errors import UnitError

PER_STATURE = {"upper_arm": 0.186, "forearm": 0.146, "hand": 0.108}  # Drillis & Contini, in Winter (2009)


@given(st.floats(0.4, 2.8))
def test_every_segment_is_its_share_of_the_body_height(stature):
    lengths = segment_lengths(stature)
    assert lengths.keys() == PER_STATURE.keys()
    for name, share in PER_STATURE.items():
        assert lengths[name] == pytest.approx(share * stature, rel=1e-14)


def test_the_lengths_fit_the_human_arm():
    arm = human().with_lengths(**segment_lengths(1.72))
    assert arm.lengths["upper_arm"] == pytest.approx(0.186 * 1.72)


@pytest.mark.parametrize(
    ("stature", "hint"),
    [(172, "1.72 m"), (1720, "1.72 m"), (55, "0.55 m"), (450, "0.45 m")],
)
def test_centimetres_and_millimetres_get_a_hint(stature, hint):
    with pytest.raises(UnitError) as caught:
        segment_lengths(stature)
    message = str(caught.value)
    assert f"stature is {stature:g} m, expected 0.4 to 2.8 m" in message
    assert f"did you mean {hint}?" in message


@pytest.mark.parametrize("stature", [0.0, -1.72, 0.39, 2.81, 5.6, 300, 5000, math.inf, -math.inf, math.nan])
def test_heights_that_make_no_sense_in_any_unit_are_refused_without_a_hint(stature):
    with pytest.raises(UnitError, match=r"expected 0.4 to 2.8 m$"):
        segment_lengths(stature)
