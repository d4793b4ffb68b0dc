"""Frames that come in pieces: nothing the recorder writes may come between the pieces of one."""

from __future__ import annotations

import contextlib
import itertools
import socket
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from device_recorders import sequences, simulated

from armik_sym.device.recording import GapReason, Recorder, read_recording


@contextmanager
def sending(pieces: Iterable[tuple[bytes, float]]) -> Iterator[tuple[str, threading.Event]]:
    """A server that sends pieces, and waits after each; and what is set when it has sent all."""
    sent, ended = threading.Event(), threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            connection, _ = listener.accept()
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with connection, contextlib.suppress(OSError):  # The recorder may hang up first.
                for piece, pause in pieces:
                    connection.sendall(piece)
                    time.sleep(pause)
                sent.set()
                ended.wait(20.0)

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield f"socket://127.0.0.1:{listener.getsockname()[1]}", sent
        finally:
            ended.set()
            thread.join()


def record(pieces: Iterable[tuple[bytes, float]], file: Path) -> None:
    with sending(pieces) as (port, sent):
        recorder = Recorder(port, file)

        def stop() -> None:
            sent.wait(30.0)
            time.sleep(0.2)
            recorder.stop()

        watcher = threading.Thread(target=stop)
        watcher.start()
        recorder.run(30.0)
        watcher.join()


def test_stamps_and_warnings_stand_between_frames(tmp_path: Path) -> None:
    data = b"".join(frame.data for frame in itertools.islice(simulated().frames(), 121))
    pieces = [(data[at : at + 11], 0.003) for at in range(0, len(data), 11)]
    file = tmp_path / "a.armikrec"
    record(pieces, file)
    assert sequences(file) == list(range(120))
    recording = read_recording(file)
    assert (recording.damaged, recording.lost) == (0, 0)
    assert recording.complete


def test_a_silence_within_a_frame_does_not_break_it(tmp_path: Path) -> None:
    data = b"".join(frame.data for frame in itertools.islice(simulated().frames(), 21))
    file = tmp_path / "a.armikrec"
    record([(data[:400], 1.4), (data[400:], 0.0)], file)
    assert sequences(file) == list(range(20))
    recording = read_recording(file)
    assert recording.damaged == 0
    assert [gap.reason for gap in recording.gaps] == [GapReason.SILENCE]


def test_a_recording_ends_between_two_frames(tmp_path: Path) -> None:
    frames = [frame.data for frame in itertools.islice(simulated().frames(), 400)]
    data = b"".join(frames)
    file = tmp_path / "a.armikrec"
    with sending((data[at : at + 13], 0.002) for at in range(0, len(data), 13)) as (port, _):
        Recorder(port, file).run(0.7)
    recording = read_recording(file)
    assert 10 < recording.n < 398
    assert (recording.damaged, recording.torn, recording.complete) == (0, False, True)
