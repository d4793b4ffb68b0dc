"""Sensors that are stuck, jump or leave their scale are told from sensors that do their work."""

from __future__ import annotations

import itertools

import pytest
from device_recorders import simulated

import armik_sym as ak
from armik_sym.device.channels import Channel, DeviceInfo, SensorKind
from armik_sym.device.protocol import Sample
from armik_sym.device.recording import SensorWarning, WarningKind
from armik_sym.device.recording.health import SensorHealth
from armik_sym.device.simulator import Faults, Jump, SimulatedDevice, Stuck, sensors_of

POTENTIOMETER = Channel(SensorKind.POTENTIOMETER, 4096)
ENCODER = Channel(SensorKind.ENCODER, 4000)


def warnings_of(device: SimulatedDevice, seconds: float) -> list[SensorWarning]:
    health, period = SensorHealth(device.info), 1.0 / device.rate
    samples = itertools.islice(device.samples(), round(seconds * device.rate))
    return [found for sample in samples for found in health.look(sample, period)]


@pytest.mark.parametrize("task", ak.task_names())
@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_healthy_sensors_raise_nothing(task: str, rate: float) -> None:
    motion = ak.load_task(task).measured
    device = SimulatedDevice(motion, sensors_of(ak.catalog.ehmcs()), rate=rate)
    assert [each for each in warnings_of(device, 12.0) if each.kind is not WarningKind.STUCK] == []


@pytest.mark.parametrize("channel", range(7))
def test_a_stuck_sensor_is_found_within_seven_seconds(channel: int) -> None:
    device = simulated(Faults(stuck=(Stuck(channel, 1.0),)))
    found = [each for each in warnings_of(device, 8.0) if each.kind is WarningKind.STUCK]
    mine = [each for each in found if each.channel == channel]
    assert len(mine) == 1
    assert 5.0 <= mine[0].value <= 7.0


@pytest.mark.parametrize("channel", range(7))
def test_a_jump_is_found_at_its_sample(channel: int) -> None:
    device = simulated(Faults(jumps=(Jump(channel, 2.0, 300),)))
    found = [each for each in warnings_of(device, 3.0) if each.kind is WarningKind.JUMP]
    assert [(each.channel, each.sequence) for each in found] == [(channel, 1000)]
    assert abs(found[0].value) == pytest.approx(300, abs=12)


def test_the_overflow_of_a_register_is_no_jump() -> None:
    health = SensorHealth(DeviceInfo(1, 500.0, (ENCODER,)))
    counts = [65530, 65534, 2, 7, 65533]
    assert [health.look(Sample(k, 2000 * k, (count,)), 0.002) for k, count in enumerate(counts)] == [[]] * 5


@pytest.mark.parametrize(
    ("count", "kind"),
    [(0, WarningKind.AT_END), (4095, WarningKind.AT_END), (4096, WarningKind.OUT_OF_RANGE), (1, None)],
)
def test_ends_of_the_scale(count: int, kind: WarningKind | None) -> None:
    health = SensorHealth(DeviceInfo(1, 500.0, (POTENTIOMETER,)))
    found = health.look(Sample(0, 0, (count,)), 0.0)
    assert [each.kind for each in found] == ([] if kind is None else [kind])


def test_a_bad_contact_is_said_once_a_second_with_its_number() -> None:
    health = SensorHealth(DeviceInfo(1, 500.0, (POTENTIOMETER,)))
    found: list[SensorWarning] = []
    for k in range(1500):
        found += health.look(Sample(k, 2000 * k, (1000 + 1000 * (k % 2),)), 0.002)
    jumps = [each for each in found if each.kind is WarningKind.JUMP]
    assert len(jumps) == 3
    assert sum(each.times for each in jumps) == pytest.approx(1000, abs=5)
    assert "jumped by" in str(jumps[1])
    assert "samples)" in str(jumps[1])


def test_after_an_interruption_the_first_step_says_nothing() -> None:
    health = SensorHealth(DeviceInfo(1, 500.0, (POTENTIOMETER,)))
    health.look(Sample(0, 0, (1000,)), 0.0)
    health.interrupted()
    assert health.look(Sample(900, 1_800_000, (3000,)), 0.002) == []
