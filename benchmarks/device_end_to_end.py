"""End to end over a real serial path: simulator, recorder, file, angles, hand path, `armik solve`.

    python benchmarks/device_end_to_end.py [--seconds 60]

A simulated device plays a bundled task at 500 samples a second on a pseudo-terminal; `armik record` records
it with its calibration; `armik solve` takes the path of the hand from the measured angles, and finds joint
angles for it again. Then the same with 1 % of the bytes damaged and the port closed twice: every undamaged
sample has to be there, and nothing else may be counted.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.device.calibration import save_calibration
from armik_sym.device.protocol import FrameParser, Sample
from armik_sym.device.recording import Recorder, read_recording
from armik_sym.device.simulator import Faults, SimulatedDevice, sensors_of, serve_pty, true_calibration

RATE = 500.0


def armik(*words: object) -> subprocess.CompletedProcess[str]:
    """Run the command line."""
    return subprocess.run(
        [sys.executable, "-m", "armik_sym", *map(str, words)], capture_output=True, text=True, check=False
    )


def clean(folder: Path, seconds: float) -> bool:
    """Record without faults, and solve what was recorded."""
    arm = ak.catalog.ehmcs()
    device = SimulatedDevice(ak.load_task("brushing").measured, sensors_of(arm), rate=RATE)
    file = folder / "clean.armikrec"
    calibration = save_calibration(true_calibration(device, arm), folder / "device.toml")
    with serve_pty(device, seconds=seconds) as served:
        done = armik(
            "record", "--port", served.port, "--out", file, "--calibration", calibration,
            "--seconds", seconds + 0.9,
        )  # fmt: skip
        sent = served.truth.sent
    recording = read_recording(file)
    print(f"recorded             {recording!r}; sent {len(sent)}, exit code {done.returncode}")
    off = np.degrees(np.abs(recording.angles().q - device.true_angles(recording.sequence)).max())
    print(f"angles               largest error {off:.2f}°")
    began = time.monotonic()
    solved = armik("solve", file, "--out", folder / "out")
    print(f"armik solve          exit code {solved.returncode}, {time.monotonic() - began:.1f} s")
    print("\n".join("    " + line for line in (solved.stdout or solved.stderr).splitlines()))
    return (
        len(sent) == recording.n == round(seconds * RATE) and recording.lost == 0 and solved.returncode == 0
    )


def faulty(folder: Path, seconds: float) -> bool:
    """Record with damage and a port that is closed twice."""
    faults = Faults(damaged_bytes=0.01, close_at=(0.3 * seconds, 0.6 * seconds), closed_for=2.0)
    device = SimulatedDevice(
        ak.load_task("brushing").measured, sensors_of(ak.catalog.ehmcs()), rate=RATE, faults=faults
    )
    file = folder / "faulty.armikrec"
    with serve_pty(device, seconds=seconds) as served:
        recorder = Recorder(served.port, file, notices=lambda text: print(f"    {text}"))
        watcher = threading.Thread(target=lambda: (served.wait(), time.sleep(0.5), recorder.stop()))
        watcher.start()
        recorder.run(seconds + 20.0)
        watcher.join()
        undamaged, damaged = served.truth.undamaged, served.truth.damaged
    kept = {each.sequence for each in FrameParser().feed(file.read_bytes()) if isinstance(each, Sample)}
    missing = set(undamaged.tolist()) - kept
    recording = read_recording(file)
    print(f"with faults          {recording!r}")
    print(
        f"    {len(undamaged)} undamaged samples sent, {len(missing)} of them missing; {len(damaged)} damaged"
    )
    for gap in recording.gaps:
        print(f"    gap: {gap.reason.name}, {gap.seconds:.2f} s, {gap.lost} samples lost")
    return not missing and len(recording.gaps) == 2


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--seconds", type=float, default=60.0)
    chosen = options.parse_args()
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        good = clean(Path(name), chosen.seconds)
        good &= faulty(Path(name), chosen.seconds)
    print("all good" if good else "NOT good")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
