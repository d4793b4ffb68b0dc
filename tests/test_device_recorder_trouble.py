"""Wrong use of a recorder has a clear answer, and leaves no empty file behind."""

from __future__ import annotations

import os
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from device_recorders import simulated
from serial import SerialException

from armik_sym.device.recording import Port, Recorder
from armik_sym.device.recording.port_trouble import holders, port_error
from armik_sym.device.simulator import Faults, Silence, serve_pty, serve_socket, true_calibration
from armik_sym.errors import CalibrationError, DeviceError, MotionFileError, OptionError

no_windows = pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")


@contextmanager
def server(data: bytes) -> Iterator[str]:
    """A server that sends some bytes to who connects, and then nothing."""
    ended = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            connection, _ = listener.accept()
            with connection:
                connection.sendall(data)
                ended.wait(20.0)

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield f"socket://127.0.0.1:{listener.getsockname()[1]}"
        finally:
            ended.set()
            thread.join()


def refused(port: str, folder: Path, wait: float = 0.3, **options: object) -> str:
    """Why a device cannot be recorded; there must be no file."""
    file = folder / "a.armikrec"
    with pytest.raises(DeviceError) as error:
        Recorder(port, file, wait=wait, **options).run()  # type: ignore[arg-type]
    assert not file.exists()
    return str(error.value)


@no_windows
def test_no_such_port_lists_those_found(tmp_path: Path) -> None:
    text = refused(str(tmp_path / "ttyUSB7"), tmp_path)
    assert "ttyUSB7: no such port" in text
    assert "Found: " in text or "No serial port was found" in text


@no_windows
def test_a_busy_port_names_who_holds_it(tmp_path: Path) -> None:
    with serve_pty(simulated()) as served:
        port = Port(served.port)
        try:
            text = refused(served.port, tmp_path)
        finally:
            port.close()
    assert "busy" in text
    if sys.platform == "linux":
        assert f"(process {os.getpid()})" in text
        assert holders("/dev/nobody-has-this-open") == []


@no_windows
def test_a_file_is_no_port(tmp_path: Path) -> None:
    file = tmp_path / "text"
    file.write_text("x", encoding="utf-8")
    assert "is no serial port" in refused(str(file), tmp_path)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (SerialException(13, "could not open port /dev/ttyUSB0: Permission denied"), "usermod -aG dialout"),
        (SerialException(16, "could not open port: Device or resource busy"), "ModemManager"),
        (
            SerialException("could not open port 'COM3': PermissionError(13, 'Access is denied.', None, 5)"),
            "another program has the port open: close it",
        ),
        (
            SerialException("could not open port 'COM3': FileNotFoundError(2, 'cannot find', None, 2)"),
            "no such port",
        ),
        (ValueError("Invalid baud rate: 7"), "does not work at 7 baud"),
        (SerialException(5, "Input/output error"), "cannot be opened"),
    ],
)
def test_what_the_system_says_becomes_what_to_do(error: Exception, words: str) -> None:
    answer = str(port_error("COM3", error, 7))
    assert answer.startswith("COM3: ")
    assert words in answer


def test_nobody_listens_and_wrong_urls(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        number = listener.getsockname()[1]
    assert "nothing listens there" in refused(f"socket://127.0.0.1:{number}", tmp_path)
    assert "Valid are /dev/ttyUSB0, COM3, socket://" in refused("sockets://127.0.0.1:7", tmp_path)


def test_no_byte_within_a_second(tmp_path: Path) -> None:
    said: list[str] = []
    text = refused("loop://", tmp_path, wait=1.2, notices=said.append)
    assert "no sample within 1.2 s: no byte came: check that the device has power" in text
    assert "no sample within a second" in said[0]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"Hello, I am another device.\r\n" * 3, "they are text ('Hello, I am another device"),
        (bytes(range(128, 256)) * 9, "no whole frame: check that the device behind"),
    ],
)
def test_bytes_that_are_no_frames(tmp_path: Path, data: bytes, words: str) -> None:
    with server(data) as port:
        assert words in refused(port, tmp_path)


@no_windows
def test_noise_on_a_port_suggests_the_baud_rate(tmp_path: Path) -> None:
    with serve_pty(simulated(Faults(damaged_bytes=0.9))) as served:
        assert "the baud rate is wrong (this port runs at 9600" in refused(served.port, tmp_path, baud=9600)


def test_another_version_of_the_protocol(tmp_path: Path) -> None:
    with serve_socket(simulated(Faults(version=7))) as served:
        assert "speaks protocol version 7, this package speaks version 1" in refused(served.port, tmp_path)


def test_calibration_of_another_device(tmp_path: Path) -> None:
    device, file = simulated(), tmp_path / "a.armikrec"
    with serve_socket(device) as served, pytest.raises(CalibrationError, match="belongs to device 2"):
        Recorder(served.port, file, calibration=replace(true_calibration(device), device_id=2)).run(5.0)
    assert not file.exists()


def test_a_recording_is_never_overwritten(tmp_path: Path) -> None:
    file = tmp_path / "a.armikrec"
    file.write_bytes(b"precious")
    with pytest.raises(MotionFileError, match="exists already"):
        Recorder("loop://", file).run()
    assert file.read_bytes() == b"precious"
    with pytest.raises(MotionFileError, match="does not exist: create it"):
        Recorder("loop://", tmp_path / "nowhere" / "a.armikrec").run()


def test_options_are_checked(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="baud is 0"):
        Recorder("loop://", tmp_path / "a", baud=0)
    with pytest.raises(OptionError, match="seconds is -1"):
        Recorder("loop://", tmp_path / "a").run(-1)
    assert not list(tmp_path.iterdir())


def test_time_over_before_a_sample_came(tmp_path: Path) -> None:
    with serve_socket(simulated(Faults(silent=(Silence(0.0, 60.0),)))) as served:
        file = tmp_path / "a.armikrec"
        with pytest.raises(DeviceError, match="ended before a sample came"):
            Recorder(served.port, file).run(0.2)
    assert not file.exists()
