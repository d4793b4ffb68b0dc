"""Simulated devices on real ports: what arrives is what the device says it sent."""

from __future__ import annotations

import errno
import os
import select
import socket
import sys
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import pytest
from simulated_devices import PlainReader, all_read, device, first_samples, open_descriptors

from armik_sym.device.simulator import Faults, ServedDevice, Silence, serve_pty, serve_socket
from armik_sym.errors import DeviceError, OptionError

Serve = Callable[..., AbstractContextManager[ServedDevice]]

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals")
PORTS = [pytest.param(serve_pty, marks=posix), serve_socket]


def raw_bytes(port: str, served: ServedDevice) -> bytes:
    """All bytes of a port, read with nothing but the operating system."""
    if port.startswith("socket://"):
        host, _, number = port.removeprefix("socket://").rpartition(":")
        connection = socket.create_connection((host, int(number)))
        handle = connection.detach()
    else:
        handle = os.open(port, os.O_RDWR | os.O_NOCTTY)
    found = bytearray()
    try:
        while True:
            ready, _, _ = select.select([handle], [], [], 0.5)
            if ready:
                data = os.read(handle, 65536)
                if not data:
                    break
                found += data
            elif served.finished:
                break
    except OSError as error:
        if error.errno != errno.EIO:
            raise
    finally:
        os.close(handle)
    return bytes(found)


@pytest.mark.parametrize("serve", PORTS)
def test_every_byte_arrives_as_it_was_sent(serve: Serve) -> None:
    simulated = device(rate=1000, faults=Faults(damaged_bytes=0.01, lost_bytes=0.002, inserted_bytes=0.002))
    with serve(simulated, speed=None, seconds=4.0) as served:
        found = raw_bytes(served.port, served)
        assert served.wait(10)
    sent = bytearray()
    for frame in simulated.frames():
        if frame.time >= 4.0:
            break
        sent += frame.data
    assert found == sent
    assert served.truth.sent.tolist() == list(range(4000))
    assert 0 < len(served.truth.damaged) == 4000 - len(served.truth.undamaged)


@pytest.mark.parametrize("serve", PORTS)
def test_in_real_time_it_waits_for_a_reader_and_then_sends_every_sample(serve: Serve) -> None:
    simulated = device(rate=200)
    reader = PlainReader()
    with serve(simulated, seconds=1.5) as served:
        time.sleep(0.2)
        assert len(served.truth) == 0
        reader.read(served, all_read(served, reader))
    assert reader.samples == first_samples(simulated, 300)
    assert reader.infos == 2
    assert served.truth.undamaged.tolist() == list(range(300))
    assert served.latest < 60


@posix
@pytest.mark.parametrize("speed", [None, 4.0])
def test_port_closed_twice_and_bytes_damaged(speed: float | None) -> None:
    faults = Faults(damaged_bytes=0.01, close_at=(2.001, 6.001), closed_for=1.0)
    reader = PlainReader()
    with serve_pty(device(faults=faults), speed, seconds=9.0) as served:
        reader.read(served, all_read(served, reader))
    got, truth = set(reader.sequences), served.truth
    assert len(truth) == 4500
    assert set(truth.undamaged.tolist()) <= got <= set(truth.sent.tolist())
    missing = set(truth.not_sent.tolist())
    # The sample at the very moment of closing is torn: begun, and cut off.
    assert {*range(1002, 1501), *range(3002, 3501)} <= missing
    assert {1001, 3001} <= set(truth.damaged.tolist())
    assert reader.openings == 3
    assert 500 < len(truth.damaged) < 2500


def test_socket_closed_twice_delivers_all_before_each_end() -> None:
    simulated = device(faults=Faults(close_at=(2.0, 6.0), closed_for=1.0))
    parser = PlainReader()
    with serve_socket(simulated, speed=None, seconds=9.0) as served:
        for _ in range(3):
            parser.parser.restart()
            deadline = time.monotonic() + 20
            while time.monotonic() < deadline:
                try:
                    data = raw_bytes(served.port, served)
                    break
                except ConnectionRefusedError:
                    time.sleep(0.01)
            parser._take(data)
    assert parser.sequences == served.truth.undamaged.tolist()
    assert len(parser.sequences) == 4500 - 1000


@posix
def test_a_reader_that_comes_back_misses_what_was_measured_meanwhile() -> None:
    simulated, first, second = device(rate=200), PlainReader(), PlainReader()
    with serve_pty(simulated) as served:
        first.read(served, lambda: len(first.samples) >= 50)
        time.sleep(0.5)
        second.read(served, lambda: len(second.samples) >= 50)
    got = set(first.sequences) | set(second.sequences)
    assert got <= set(served.truth.sent.tolist())
    assert second.sequences[0] - first.sequences[-1] > 50
    assert second.sequences == list(range(second.sequences[0], second.sequences[0] + len(second.sequences)))
    assert len(served.truth.not_sent) > 50


@pytest.mark.parametrize("serve", PORTS)
def test_silence_with_the_port_open(serve: Serve) -> None:
    simulated = device(rate=100, faults=Faults(silent=(Silence(1.0, 2.0), Silence(4.0))))
    reader = PlainReader()
    with serve(simulated, speed=None, seconds=6.0) as served:
        reader.read(served, all_read(served, reader))
    assert reader.sequences == [*range(100), *range(200, 400)]
    assert served.truth.not_sent.tolist() == [*range(100, 200), *range(400, 600)]
    assert reader.openings == 1


@pytest.mark.parametrize("serve", PORTS)
@pytest.mark.parametrize("speed", [None, 1.0])
def test_a_reader_that_does_not_read_hangs_nothing(serve: Serve, speed: float | None) -> None:
    before = threading.active_count()
    with serve(device(rate=1000), speed) as served:
        parts = served.port.removeprefix("socket://").rsplit(":", 1)
        if served.port.startswith("socket://"):
            handle = socket.create_connection((parts[0], int(parts[1]))).detach()
        else:
            handle = os.open(served.port, os.O_RDWR | os.O_NOCTTY)
        time.sleep(0.6)
    os.close(handle)
    assert threading.active_count() == before


@posix
def test_samples_unread_when_the_port_closes_are_not_called_delivered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("armik_sym.device.simulator.sender._DRAINED_WITHIN", 0.5)
    with serve_pty(device(faults=Faults(close_at=(0.2,))), seconds=0.4) as served:
        handle = os.open(served.port, os.O_RDWR | os.O_NOCTTY)
        assert served.wait(20)
        os.close(handle)
    assert served.truth.undamaged.size == 0
    assert served.truth.sent.size > 50


@pytest.mark.parametrize("serve", PORTS)
def test_nothing_is_left_behind(serve: Serve) -> None:
    threads, descriptors = threading.active_count(), open_descriptors()
    for _ in range(3):
        with serve(device(), speed=None, seconds=0.5) as served:
            reader = PlainReader()
            reader.read(served, all_read(served, reader))
        assert not Path(served.port).parent.exists() or served.port.startswith("socket://")
        with serve(device()):
            pass
    assert threading.active_count() == threads
    assert open_descriptors() == descriptors


@posix
def test_a_link_of_ones_own(tmp_path: Path) -> None:
    link = tmp_path / "ehmcs"
    link.symlink_to(tmp_path / "gone")
    with serve_pty(device(), link=link) as served:
        assert served.port == str(link)
        assert link.is_char_device()
        with pytest.raises(DeviceError, match="exists already"), serve_pty(device(), link=link):
            pass
    assert not link.is_symlink()
    with pytest.raises(DeviceError, match="No such file"), serve_pty(device(), link=tmp_path / "no" / "port"):
        pass


@posix
def test_a_port_that_cannot_be_opened_again_is_reported(tmp_path: Path) -> None:
    folder = tmp_path / "ports"
    folder.mkdir()
    faults = Faults(close_at=(0.2,), closed_for=1.0)
    with serve_pty(device(faults=faults), link=folder / "port") as served:
        handle = os.open(served.port, os.O_RDWR | os.O_NOCTTY)
        deadline = time.monotonic() + 20
        while (folder / "port").is_symlink() and time.monotonic() < deadline:
            if select.select([handle], [], [], 0.01)[0]:
                try:
                    os.read(handle, 65536)
                except OSError:
                    break
        os.close(handle)
        folder.rmdir()
        with pytest.raises(DeviceError, match="stopped"):
            served.wait(20)


def test_addresses_that_cannot_be_used() -> None:
    with serve_socket(device()) as served:
        number = int(served.port.rpartition(":")[2])
        with (
            pytest.raises(DeviceError, match=f"{number}.*choose another port"),
            serve_socket(device(), port=number),
        ):
            pass
    with serve_socket(device(), port=number) as again:
        assert again.port == f"socket://127.0.0.1:{number}"


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_impossible_speeds_are_refused(speed: float) -> None:
    with pytest.raises(OptionError, match="speed"), serve_socket(device(), speed):
        pass


def test_windows_is_told_to_use_a_socket(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("armik_sym.device.simulator.pty_line.sys.platform", "win32")
    with pytest.raises(DeviceError, match=r"serve a socket.*--socket"), serve_pty(device()):
        pass
