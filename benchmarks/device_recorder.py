"""What recording costs: processor time per second at 1,000 samples a second, and memory over ten minutes.

    python benchmarks/device_recorder.py [--minutes 10] [--seconds 30]

The simulated device runs in a process of its own, so only the recorder is measured: first in real time, once
bare and once with all that `armik record` can show (angles, swivel, endpoint); then ten simulated
minutes as fast as they can be read, with the resident memory after one minute and at the end.
"""

from __future__ import annotations

import argparse
import contextlib
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from armik_sym.device.recording import Recorder, read_recording

RATE = 1000
AIM_SHARE = 0.25  # of one core
AIM_GROWTH = 2.0  # [MB]


@contextlib.contextmanager
def simulator(folder: Path, *options: object) -> Iterator[str]:
    """A simulated device in a process of its own, on a pseudo-terminal."""
    port, calibration = folder / "port", folder / "device.toml"
    words = ["simulate-device", "--rate", RATE, "--link", port, "--calibration", calibration, *options]
    process = subprocess.Popen(
        [sys.executable, "-m", "armik_sym", *map(str, words)], stdout=subprocess.DEVNULL
    )
    try:
        while not port.exists():
            time.sleep(0.05)
        yield str(port)
    finally:
        process.terminate()
        process.wait()


def bare(folder: Path, seconds: float) -> tuple[float, int]:
    """Share of a core of the recorder alone, and samples lost."""
    file = folder / "bare.armikrec"
    with simulator(folder) as port:
        recorder = Recorder(port, file)
        before, began = time.process_time(), time.monotonic()
        recorder.run(seconds)
        share = (time.process_time() - before) / (time.monotonic() - began)
    return share, read_recording(file).lost


def with_live_line(folder: Path, seconds: float) -> tuple[float, int]:
    """Share of a core of `armik record` with all it can show, start-up and angles at the end left out."""
    used = []
    for length in (1.0, 1.0 + seconds):
        file = folder / f"live{length:g}.armikrec"
        words = ["record", "--out", file, "--seconds", length, "--live", "swivel,endpoint"]
        with simulator(folder) as port:
            words += ["--port", port, "--calibration", folder / "device.toml"]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(
                [sys.executable, "-m", "armik_sym", *map(str, words)], capture_output=True, check=False
            )
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        lost = read_recording(file).lost
    began = time.process_time()
    read_recording(file).angles()
    return (used[1] - used[0] - (time.process_time() - began)) / seconds, lost


def memory(folder: Path, minutes: float) -> tuple[float, float, int]:
    """Peak resident memory after a minute and at the end, in MB, and samples, of a fast recording."""
    file, wanted = folder / "long.armikrec", round(minutes * 60 * RATE)
    peaks: list[float] = []

    class Watched(Recorder):
        def _understand(self, arrival):  # type: ignore[no-untyped-def]
            super()._understand(arrival)
            samples = self._tally.samples
            if not peaks and samples >= 60 * RATE:
                peaks.append(peak())
            if samples >= wanted:
                self.stop()

    with simulator(folder, "--speed", 0) as port:
        summary = Watched(port, file).run(1200.0)
    return peaks[0], peak(), summary.status.samples


def peak() -> float:
    """Peak resident memory of this process, in MB."""
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return size / (1 << 20 if sys.platform == "darwin" else 1 << 10)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--minutes", type=float, default=10.0)
    options.add_argument("--seconds", type=float, default=30.0)
    chosen = options.parse_args()
    good = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, measure in (("recorder alone", bare), ("armik record --live", with_live_line)):
            share, lost = measure(folder, chosen.seconds)
            good &= share < AIM_SHARE
            print(f"{title:20} {100 * share:5.1f} % of a core at {RATE:,}/s, {lost} lost (aim < 25 %)")
        first, last, samples = memory(folder, chosen.minutes)
        good &= last - first < AIM_GROWTH
        print(
            f"memory               {first:.1f} MB after 1 minute, {last:.1f} MB after {samples:,} samples "
            f"({samples / RATE / 60:.1f} simulated minutes; aim: growth < {AIM_GROWTH:g} MB)"
        )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
