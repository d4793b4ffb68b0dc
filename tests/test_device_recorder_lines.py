"""Lines beside plain terminals and sockets: over the network with RFC 2217; and devices that restart."""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import serial
from device_recorders import recorded, simulated, stopped_when_sent
from serial.rfc2217 import PortManager

from armik_sym.device.recording import Recorder, read_recording
from armik_sym.device.simulator import Faults, serve_socket


@contextmanager
def redirected(device: str) -> Iterator[str]:
    """A serial port, served over the network as RFC 2217 says, by pyserial."""
    ended = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(20.0)

        class Writer:
            def __init__(self, connection: socket.socket) -> None:
                self.write = connection.sendall

        def carry() -> None:
            connection, _ = listener.accept()
            connection.settimeout(0.005)
            with connection, serial.serial_for_url(device, timeout=0.005) as port:
                manager = PortManager(port, Writer(connection))
                while not ended.is_set():
                    with contextlib.suppress(TimeoutError):
                        for byte in manager.filter(connection.recv(1024)):
                            port.write(byte)
                    if data := port.read(4096):
                        connection.sendall(b"".join(manager.escape(data)))

        thread = threading.Thread(target=carry)
        thread.start()
        try:
            yield f"rfc2217://127.0.0.1:{listener.getsockname()[1]}"
        finally:
            ended.set()
            thread.join()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # of pyserial
def test_a_port_over_the_network_with_rfc_2217(tmp_path: Path) -> None:
    device, file = simulated(rate=200.0), tmp_path / "a.armikrec"
    with serve_socket(device, seconds=2.5) as served, redirected(served.port) as port:
        recorder = Recorder(port, file)
        with stopped_when_sent(recorder, served):
            recorder.run(20.0)
    recording = read_recording(file)
    assert (recording.lost, recording.damaged, recording.gaps) == (0, 0, ())
    # The device starts as soon as the server opens it, the recording some time later.
    assert 100 < recording.n <= 500
    assert recording.port == port


def test_a_device_that_restarts_is_noticed(tmp_path: Path) -> None:
    device, file = simulated(Faults(restart_at=(0.8,))), tmp_path / "a.armikrec"
    with serve_socket(device, seconds=1.6) as served:
        _, summary = recorded(served, file)
        sent = len(served.truth.undamaged)
    recording = read_recording(file)
    assert (recording.n, recording.lost, recording.gaps) == (sent, 0, ())
    assert summary.status.restarts == 1
    assert len(recording.restarts) == 1
    assert recording.sequence.tolist() == list(range(sent))
    assert np.all(np.diff(recording.time) > 0)
    first = recording.restarts[0]
    # Placed by the clock of the host, to the delay of the line.
    assert recording.time[first] - recording.time[first - 1] == pytest.approx(0.002, abs=0.05)
    assert any("restarted" in notice for notice in summary.notices)
