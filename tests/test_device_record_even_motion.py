"""Recorded angles at even times; and devices that come back under another name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import armik_sym as ak
from armik_sym.device.recording import even_motion
from armik_sym.device.recording.port_again import find_again, identity_of
from armik_sym.errors import CalibrationWarning, OptionError, RecordingError


def moving(time: np.ndarray) -> ak.JointMotion:
    return ak.JointMotion(time, np.column_stack([np.sin(time), 0.3 * np.cos(2 * time)]), ("a", "b"))


def test_even_times_follow_the_true_motion_through_losses_and_steps() -> None:
    random = np.random.default_rng(1)
    time = np.arange(5000) / 500
    kept = random.random(5000) > 0.2
    kept[0] = kept[-1] = True
    true, step = moving(time), np.radians(0.09)
    recorded = ak.JointMotion(time[kept], np.round(true.q[kept] / step) * step, true.joint_names)
    even = even_motion(recorded, 100.0, 6.0)
    np.testing.assert_allclose(np.diff(even.time), 0.01, atol=1e-12)
    assert even.time[0] == 0.0
    inner = slice(20, -20)
    off = np.abs(even.q - moving(even.time).q)[inner]
    assert off.max() < step / 2
    assert np.abs(np.diff(even.q, 3, axis=0)).max() < np.abs(np.diff(recorded.q, 3, axis=0)).max() / 20


def test_the_longest_stretch_without_a_gap_is_taken() -> None:
    time = np.concatenate([np.arange(0, 1, 0.01), np.arange(1.5, 4, 0.01), np.arange(5, 6, 0.01)])
    with pytest.warns(CalibrationWarning, match=r"2 gaps of more than 0.1 s.*1.50 to 3.99 s"):
        even = even_motion(moving(time), 50.0)
    assert even.time[0] == pytest.approx(1.5)
    assert even.time[-1] == pytest.approx(3.98, abs=0.011)


def test_too_little_and_wrong_options_are_refused() -> None:
    with pytest.raises(RecordingError, match="nothing to follow"):
        even_motion(moving(np.array([0.0, 1.0, 2.0])))
    with pytest.raises(OptionError, match="below half the rate"):
        even_motion(moving(np.arange(100) / 100), 50.0, 30.0)


@dataclass
class Listed:
    device: str
    vid: int | None = 0x0403
    pid: int | None = 0x6001
    serial_number: str | None = "A1"
    location: str | None = None


def test_an_adapter_is_found_under_its_new_name() -> None:
    ports = [Listed("/dev/ttyUSB0"), Listed("/dev/ttyUSB1", serial_number="B2"), Listed("/dev/ttyS0", None)]
    identity = identity_of("/dev/ttyUSB0", ports)
    assert identity is not None
    assert identity_of("/dev/ttyS0", ports) is None
    assert find_again("/dev/ttyUSB0", identity, ports) == "/dev/ttyUSB0"
    moved = [Listed("/dev/ttyUSB2"), *ports[1:]]
    assert find_again("/dev/ttyUSB0", identity, moved) == "/dev/ttyUSB2"
    # Two that cannot be told apart, or none: the old name is waited for.
    assert find_again("/dev/ttyUSB0", identity, [*moved, Listed("/dev/ttyUSB3")]) == "/dev/ttyUSB0"
    assert find_again("/dev/ttyUSB0", identity, ports[1:]) == "/dev/ttyUSB0"
    assert find_again("/dev/ttyS0", None, moved) == "/dev/ttyS0"
