"""The file that only grows: full disks, names, what is kept."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest
from device_recorders import simulated

import armik_sym as ak
from armik_sym.device.recording import read_recording
from armik_sym.device.recording.record_file import RecordFile
from armik_sym.device.simulator import serve_socket
from armik_sym.errors import MotionFileError

ROOT = Path(ak.__file__).parents[1]

LIMITED = """
import resource, sys
from armik_sym.device.recording import Recorder
from armik_sym.errors import MotionFileError

resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
try:
    Recorder(sys.argv[1], sys.argv[2]).run(20.0)
except MotionFileError as error:
    sys.exit(str(error))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no limits on the size of files")
def test_a_full_disk_ends_the_recording_and_keeps_it(tmp_path: Path) -> None:
    file = tmp_path / "a.armikrec"
    with serve_socket(simulated(), speed=4.0) as served:
        done = subprocess.run(
            [sys.executable, "-c", LIMITED, served.port, str(file)],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
            env={"PYTHONPATH": str(ROOT)},
        )
    assert done.returncode == 1
    assert "the disk is full, or a limit is reached" in done.stderr
    assert "are kept and can be read" in done.stderr
    assert file.stat().st_size == 20_000
    recording = read_recording(file)
    # 20,000 bytes of samples of 33 bytes, and a stamp of 25 about every 60 of them.
    assert 500 < recording.n < 606
    assert recording.sequence.tolist() == list(range(recording.n))
    assert not recording.complete


def test_what_was_appended_is_there_before_the_file_is_closed(tmp_path: Path) -> None:
    path = tmp_path / "a"
    file = RecordFile(path)
    file.append(b"one")
    assert path.read_bytes() == b"one"
    file.append(b"two")
    assert (path.read_bytes(), file.size) == (b"onetwo", 6)
    file.close()
    file.close()
    assert file.closed
    with pytest.raises(MotionFileError, match="exists already"):
        RecordFile(path)
    with pytest.raises(MotionFileError, match="is closed"):
        file.append(b"three")
    assert path.read_bytes() == b"onetwo"


def test_a_discarded_file_is_gone_with_its_thread(tmp_path: Path) -> None:
    before = threading.active_count()
    file = RecordFile(tmp_path / "a")
    assert threading.active_count() == before + 1
    file.discard()
    assert threading.active_count() == before
    assert not list(tmp_path.iterdir())
