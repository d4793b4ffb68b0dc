"""Markers of a known arm that moves in a known way, as a laboratory would record them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from anatomy import ELBOW, FORWARD, HAND, MEDIAL, UP, WRIST

import armik_sym as ak
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.motion.marker_recording import MarkerRecording

LENGTHS = {"upper_arm": 0.301, "forearm": 0.247, "hand": 0.083}
FRAME = "x forward, y up, z right"
POINTS = {
    "shoulder": "SHO",
    "elbow": ["ELB_lat", "ELB_med"],
    "wrist_radial": "WRI_rad",
    "wrist_ulnar": "WRI_uln",
    "hand_radial": "MCP2",
    "hand_ulnar": "MCP5",
}
RATE = 100.0
# Where the laboratory has its origin, seen from the shoulder.
ORIGIN = np.array([0.4, 1.1, -0.7])


@dataclass(frozen=True, eq=False)
class Known:
    """A recording and the truth behind it."""

    recording: MarkerRecording
    arm: ak.Arm
    q: np.ndarray
    hand: np.ndarray
    shoulder: np.ndarray


def slow_angles(arm: ak.Arm, n: int, seed: int) -> np.ndarray:
    """A movement like reaching: parts up to 1 Hz, away from limits and from poles of shoulder and wrist."""
    rng = np.random.default_rng(seed)
    t = np.arange(n) / RATE
    middle = np.deg2rad([35.0, 25.0, 10.0, 75.0, -15.0, 5.0, 8.0])
    swing = np.deg2rad([20.0, 12.0, 15.0, 30.0, 25.0, 15.0, 8.0])
    q = np.tile(middle, (n, 1))
    for frequency in (0.25, 0.6, 1.0):
        share = rng.uniform(0.2, 0.33, arm.dof) * swing
        q += share * np.sin(2 * np.pi * frequency * t[:, None] + rng.uniform(0, 2 * np.pi, arm.dof))
    return q


def known_markers(
    side: str = "left",
    n: int = 300,
    seed: int = 0,
    noise: float = 0.0,
    sway: float = 0.0,
    lengths: Mapping[str, float] = LENGTHS,
    straight: tuple[float, float] | None = None,
) -> Known:
    """Markers with white noise [m] on a shoulder that sways [m]; every marker is there in every sample.

    From one share of the time to another the elbow may be straight.
    """
    arm = ak.catalog.human().with_lengths(**lengths)
    q = slow_angles(arm, n, seed)
    if straight is not None:
        share = np.linspace(0.0, 1.0, n)
        near = np.clip(np.minimum(share - straight[0], straight[1] - share) / 0.15 + 1.0, 0.0, 1.0)
        q[:, 3] *= 1.0 - near**2 * (3.0 - 2.0 * near)
    frames = joint_frames(arm.chain, q, arm.lengths)
    elbow, wrist, hand = (frames[:, k, :3, 3] for k in (ELBOW, WRIST, HAND))
    hinge, ulnar = frames[:, ELBOW, :3, 2], frames[:, HAND, :3, 1]
    across = frames[:, WRIST, :3, 2]
    across = across * np.sign(np.sum(across * ulnar, axis=1))[:, None]
    t = np.arange(n) / RATE
    phase = np.array([0.0, 1.0, 2.0])
    shoulder = sway * np.sin(2 * np.pi * 0.4 * t[:, None] + phase)
    markers = {
        "SHO": np.zeros((n, 3)),
        "ELB_lat": elbow + 0.04 * hinge,
        "ELB_med": elbow - 0.04 * hinge,
        "WRI_rad": wrist - 0.03 * across,
        "WRI_uln": wrist + 0.03 * across,
        "MCP2": hand - 0.035 * ulnar,
        "MCP5": hand + 0.035 * ulnar,
    }
    base = np.stack([value + shoulder for value in markers.values()], axis=1)
    position = base @ recording_from_base(side).T + ORIGIN
    position += noise * np.random.default_rng(seed + 1).normal(size=position.shape)
    recording = MarkerRecording(t, tuple(markers), position, source="known.trc")
    return Known(recording, arm, q, hand, shoulder)


def recording_from_base(side: str) -> np.ndarray:
    """From the base of the arm to the axes `FRAME`; the model's left arm stands for a right one mirrored."""
    sideways = MEDIAL if side == "left" else -MEDIAL
    return np.stack([FORWARD, UP, sideways])


def with_gaps(recording: MarkerRecording, gaps: dict[str, list[tuple[int, int]]]) -> MarkerRecording:
    """The recording without some markers from a sample to before another."""
    position = np.array(recording.position)
    for name, spans in gaps.items():
        for first, end in spans:
            position[first:end, recording.index(name)] = np.nan
    return MarkerRecording(recording.time, recording.names, position, recording.note, recording.source)
