"""Angles of the device as angles of the human arm, and where elbow and hand are: whole or live."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.model import Arm
from armik_sym.arm.product_of_transforms import hand_pose, joint_frames
from armik_sym.device.calibration.calibration import Calibration
from armik_sym.device.calibration.encoder import EncoderZero
from armik_sym.device.protocol.frames import Sample
from armik_sym.elbow import human_posture
from armik_sym.errors import CalibrationError, ShapeError
from armik_sym.motion.joint_motion import JointMotion

Array = NDArray[np.float64]

NEAR_LINE = 0.01
"""Nearer than this to the line from shoulder to wrist the elbow points nowhere, in [m]."""


def human_angles(q: ArrayLike) -> Array:
    """Angles of the human arm whose upper arm points and turns as the device measured it.

    Flexion, abduction and internal rotation from eq. (8), the branch inside the range of motion; from the
    elbow on the angles are the same. Every sample by itself, so live and recorded angles agree.

    Args:
        q: Device angles, at least the three of the shoulder, shape (n, k) or (k,), in [rad]; NaN where there
            is none.

    Returns:
        Human angles, same shape, in [rad]; the three of the shoulder are NaN where one of them is, and the
        others where they are.

    Raises:
        ShapeError: If there are fewer than three angles.

    Source:
        Nguyen 2021, eq. 8 (ledger: nguyen2021 8).
    """
    given = np.asarray(q, dtype=np.float64)
    if given.ndim not in (1, 2) or given.shape[-1] < 3:
        raise ShapeError(f"device angles {given.shape}: expected (n, k) or (k,) with k ≥ 3, in [rad]")
    rows = given.reshape(-1, given.shape[-1])
    out = rows.copy()
    out[:, :3] = np.nan
    known = np.isfinite(rows[:, :3]).all(axis=1)
    if known.any():
        out[known, :3] = human_posture(rows[known, :3])
    return out.reshape(given.shape)


def human_motion(motion: JointMotion) -> JointMotion:
    """A motion of the device's joints as one of the human arm's.

    Args:
        motion: Motion of the first three or more joints of `catalog.ehmcs`, in their order.

    Returns:
        The motion of as many joints of `catalog.human`.

    Raises:
        ShapeError: If the joints are others.

    Source:
        Nguyen 2021, eq. 8 (ledger: nguyen2021 8).
    """
    expected = ehmcs().joint_names
    if motion.dof < 3 or motion.joint_names != expected[: motion.dof]:
        raise ShapeError(
            f"joints {', '.join(motion.joint_names)}: expected the first three or more of "
            f"{', '.join(expected)}"
        )
    return JointMotion(motion.time, human_angles(motion.q), human().joint_names[: motion.dof])


def full_posture(arm: Arm, joint_names: Sequence[str], q: ArrayLike) -> Array:
    """Angles of all joints of an arm, those not measured at 0.

    Args:
        arm: The arm.
        joint_names: Joints measured, one per column.
        q: Their angles, shape (n, k), in [rad].

    Returns:
        Shape (n, dof), in [rad].

    Raises:
        CalibrationError: If a joint is none of the arm's, or the joints come in another order: then angles of
            the same name are others, as those of `catalog.ehmcs` and `catalog.human` are.

    Source:
        None (bookkeeping).
    """
    angles = np.asarray(q, dtype=np.float64)
    posture = np.zeros((len(angles), arm.dof))
    for column, name in enumerate(joint_names):
        if name not in arm.joint_names:
            raise CalibrationError(
                f"measured joint {name!r} is none of arm {arm.name!r}: it has {', '.join(arm.joint_names)}"
            )
        posture[:, arm.joint_names.index(name)] = angles[:, column]
    order = [name for name in arm.joint_names if name in joint_names]
    if order != list(joint_names):
        raise CalibrationError(
            f"measured joints {', '.join(joint_names)} come as {', '.join(order)} in arm {arm.name!r}, where "
            "angles of these names are others: take the arm that the device was calibrated as"
        )
    return posture


def swivel_angle(arm: Arm, q: ArrayLike) -> Array:
    """How the elbow is turned about the line from shoulder to wrist: ψ = atan2(e · (ŵ × d), e · d).

    d is "down" at right angles to the line ŵ, e the elbow seen from it: 0 where the elbow hangs lowest,
    growing by the right-hand rule about ŵ. For a left arm stretched forwards, positive is outwards.

    Args:
        arm: `catalog.ehmcs` or another arm with the same order of frames: shoulder, elbow, wrist at the
            origins of frames 1, 3 and 5.
        q: Joint angles, shape (n, dof), in [rad].

    Returns:
        Shape (n,), in [rad]; NaN where a joint is NaN, the elbow is on the line, or the line is vertical.

    Raises:
        CalibrationError: If the arm does not say which way is up.

    Source:
        Korein (1985), A geometric investigation of reach (swivel angle).
    """
    if arm.up is None:
        raise CalibrationError(f"arm {arm.name!r} does not say which way is up: no swivel angle")
    frames = joint_frames(arm.chain, np.asarray(q, dtype=np.float64), arm.lengths)[..., :3, 3]
    shoulder, elbow, wrist = frames[:, 1], frames[:, 3], frames[:, 5]
    w = _unit(wrist - shoulder)
    e = _across(elbow - shoulder, w)
    d = _across(np.broadcast_to(-arm.up, w.shape), w)
    angle = np.arctan2((e * np.cross(w, d)).sum(axis=1), (e * d).sum(axis=1))
    unclear = (np.linalg.norm(e, axis=1) < NEAR_LINE) | (np.linalg.norm(d, axis=1) < NEAR_LINE)
    return np.where(unclear, np.nan, angle)


@dataclass(frozen=True, slots=True, eq=False)
class LivePose:
    """Where the arm is at the latest samples.

    Attributes:
        device: Device angles, shape (n, joints), NaN in a dead zone, in [rad].
        human: Human angles of the same postures, shape (n, joints), in [rad].
        endpoint: Position of the hand frame in the base, shape (n, 3), in [m].
        swivel: Swivel angle of the elbow, shape (n,), in [rad].
    """

    device: Array
    human: Array
    endpoint: Array
    swivel: Array


class LiveAngles:
    """From samples as they come to angles of device and human arm, endpoint and swivel angle.

    Attributes:
        arm: The arm that the device is.
        lost_counts: Joints whose encoder lost counts, see `AngleConverter`.
    """

    def __init__(
        self, calibration: Calibration, arm: Arm | None = None, zero: EncoderZero = EncoderZero.STORED
    ) -> None:
        """Start in front of the first sample.

        Args:
            calibration: Calibration of the device.
            arm: The arm that it is; None: `catalog.ehmcs`, with the joints the calibration has.
            zero: Where the zero of encoders comes from.
        """
        measured = len(calibration.joints)
        self.arm = arm if arm is not None else ehmcs(4 if measured < 5 else 5 if measured == 5 else 7)
        self._names = calibration.joint_names
        full_posture(self.arm, self._names, np.zeros((1, measured)))
        self._converter = calibration.converter(zero)

    @property
    def lost_counts(self) -> dict[str, int]:
        """Joints whose index pulses do not come whole turns apart, and by how many counts they are off."""
        return self._converter.lost_counts

    def angles(self, samples: Sequence[Sample]) -> Array:
        """Device angles of the next samples; every sample has to pass here, or through `take`.

        Args:
            samples: The samples.

        Returns:
            Shape (n, joints), in [rad]; NaN where there is no angle.

        Raises:
            ShapeError: If a sample has too few channels.

        Source:
            None (this package).
        """
        return self._converter.samples(samples)

    def take(self, samples: Sequence[Sample]) -> LivePose:
        """Everything about the next samples.

        Args:
            samples: The samples.

        Returns:
            Angles, endpoint and swivel angle; NaN where a joint has no angle.

        Raises:
            ShapeError: If a sample has too few channels.

        Source:
            Nguyen 2021, eq. 2, 3 and 8.
        """
        return self.pose(self.angles(samples))

    def pose(self, q: Array) -> LivePose:
        """Everything about device angles, such as the latest ones.

        Args:
            q: Device angles, shape (n, joints), in [rad].

        Returns:
            Angles, endpoint and swivel angle; NaN where a joint has no angle.

        Source:
            Nguyen 2021, eq. 2, 3 and 8.
        """
        # Fewer than three joints are no shoulder: there are no human angles then.
        person = human_angles(q) if q.shape[1] >= 3 else np.full_like(q, np.nan)
        posture = full_posture(self.arm, self._names, q)
        if not len(q):
            return LivePose(q, person, np.empty((0, 3)), np.empty(0))
        position, _ = hand_pose(self.arm.chain, posture, self.arm.lengths)
        return LivePose(q, person, position, swivel_angle(self.arm, posture))


def _across(vectors: Array, unit: Array) -> Array:
    """The part of vectors at right angles to unit vectors, shape (n, 3)."""
    return np.asarray(vectors - unit * (vectors * unit).sum(axis=1, keepdims=True))


def _unit(vectors: Array) -> Array:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, np.finfo(float).tiny))
