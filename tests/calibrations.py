"""Calibrations and postures of simulated sensors, for tests."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

from armik_sym.device.calibration import Calibration, JointCalibration, JointQuality, Posture, ScaleSource
from armik_sym.device.channels import Channel, DeviceInfo, SensorKind
from armik_sym.device.simulator import Encoder, Potentiometer

TURN = 2 * math.pi
POT = Channel(SensorKind.POTENTIOMETER, 4096)
ENCODER = Channel(SensorKind.ENCODER, 4000)


def pot_joint(name: str = "elbow", channel: int = 0, **more: object) -> JointCalibration:
    """A potentiometer with 345° over its track and its zero in the middle."""
    values = {
        "scale": math.radians(345) / 4096,
        "direction": 1,
        "zero": 2048.0,
        "valid": (41.0, 4054.0),
        **more,
    }
    return JointCalibration(name, channel, POT.kind, POT.span, **values)  # type: ignore[arg-type]


def encoder_joint(name: str = "flexion", channel: int = 0, **more: object) -> JointCalibration:
    """An encoder of 4,000 counts per turn."""
    values = {"scale": TURN / 4000, "direction": 1, "zero": 0.0, **more}
    return JointCalibration(name, channel, ENCODER.kind, ENCODER.span, **values)  # type: ignore[arg-type]


def device(*channels: Channel, device_id: int = 7, rate: float = 500.0) -> DeviceInfo:
    """A device with these sensors."""
    return DeviceInfo(device_id, rate, channels, "test")


def held(
    sensors: Sequence[Potentiometer | Encoder],
    postures: Sequence[Sequence[float]],
    names: Sequence[str],
    samples: int = 500,
    seed: int = 0,
) -> list[Posture]:
    """Postures held before sensors that stay switched on; angles in [deg], one per sensor."""
    readers = [sensor.switched_on(np.random.SeedSequence([seed, k])) for k, sensor in enumerate(sensors)]
    taken = []
    for number, angles in enumerate(postures):
        columns = [
            reader.read(np.full(samples, math.radians(angle))).counts
            for reader, angle in zip(readers, angles, strict=True)
        ]
        known = {name: math.radians(angle) for name, angle in zip(names, angles, strict=True)}
        taken.append(Posture(f"posture {number}", known, np.column_stack(columns)))
    return taken


_TEXT = st.text(st.characters(codec="utf-8"), max_size=20)
_FINITE = st.floats(allow_nan=False, allow_infinity=False)
_POSITIVE = st.floats(min_value=1e-12, max_value=1e3)


@st.composite
def any_joint(draw: st.DrawFn, name: str, channel: int) -> JointCalibration:
    """Any joint calibration that is allowed."""
    kind = draw(st.sampled_from(SensorKind))
    pot = kind is SensorKind.POTENTIOMETER
    lowest = draw(st.floats(-1e6, 1e6))
    return JointCalibration(
        name,
        channel,
        kind,
        draw(st.integers(2, 0x10000 if pot else 0xFFFFFFFF)),
        draw(_POSITIVE),
        draw(st.sampled_from([1, -1])),
        draw(_FINITE),
        draw(_FINITE),
        draw(st.none() | st.just((lowest, lowest + 5.0))) if pot else None,
        draw(st.just(math.inf) | _POSITIVE),
        None if pot else draw(st.none() | _FINITE),
        draw(st.sampled_from(ScaleSource)),
        JointQuality(
            draw(st.integers(0, 99)), draw(st.integers(0, 10**9)), *(draw(_FINITE) for _ in range(4))
        ),
    )


@st.composite
def any_calibration(draw: st.DrawFn) -> Calibration:
    """Any calibration that is allowed."""
    names = draw(st.lists(_TEXT, min_size=1, max_size=4, unique=True))
    joints = tuple(draw(any_joint(name, channel)) for channel, name in enumerate(names))
    notes = tuple(draw(st.lists(_TEXT, max_size=3)))
    return Calibration(draw(st.integers(0, 0xFFFFFFFF)), draw(_TEXT), joints, draw(_TEXT), notes)
