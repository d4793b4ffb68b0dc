"""A measuring device on a serial port, recorded, calibrated and solved; the device is simulated.

With a real one there is no simulator: open its port (/dev/ttyUSB0, COM3) and give the calibration that
`armik calibrate` wrote.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np

import armik_sym as ak
from armik_sym.device.recording import Recorder, even_motion, read_recording


def main() -> int:
    """Record three simulated seconds with damaged bytes, turn them into angles, and solve the hand path."""
    arm = ak.catalog.ehmcs()
    task = ak.load_task("drinking_lift")  # synthetic; the device plays it back and forth
    device = ak.device.SimulatedDevice(
        task.measured,
        ak.device.sensors_of(arm, noise=1.0),
        rate=500,
        faults=ak.device.Faults(damaged_bytes=0.0005),
    )
    serve = ak.device.serve_pty if os.name == "posix" else ak.device.serve_socket
    with tempfile.TemporaryDirectory() as folder, serve(device) as served:
        recorder = Recorder(
            served.port,
            Path(folder) / "drinking.armikrec",
            calibration=ak.device.true_calibration(device, arm),
        )
        print("recording", served.port)
        summary = recorder.run(seconds=3.0)
        recording = read_recording(summary.path)
        first = served.truth.undamaged[0]  # the recording counts from the first sample it holds
    print(recording)

    motion = recording.angles()
    error = np.abs(motion.q - device.true_angles(first + recording.sequence))
    print("largest error of a recorded angle [deg]:", np.rad2deg(error.max(axis=0)).round(2))

    even = even_motion(motion, rate=50.0)
    kinematics = ak.compile(arm)
    path = ak.HandPath(even.time, kinematics.position(even.q), kinematics.rotation(even.q))
    solution = ak.solve(arm, path, start=even.q[0])
    print(solution)
    assert solution.ok, solution.reasons
    difference = np.rad2deg(np.abs(solution.q - even.q).max())
    print(f"largest difference between solved and recorded angles: {difference:.1f}°")
    return 0


if __name__ == "__main__":
    main()
