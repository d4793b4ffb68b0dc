"""Closed-form inverse kinematics with the swivel angle, for many samples at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.compiled.backend import Backend
from armik_sym.errors import OptionError, ShapeError
from armik_sym.swivel.axis_triple import AxisTriple
from armik_sym.swivel.c_postures import compiled_postures
from armik_sym.swivel.equivalent_angles import nearest_in_range
from armik_sym.swivel.evaluate import evaluate
from armik_sym.swivel.geometry import pose_geometry, position_geometry
from armik_sym.swivel.library import swivel_library
from armik_sym.swivel.parallel_axes import first_at_pole
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Sine of an angle below which a posture counts as degenerate.
DEGENERATE = 1e-7


@dataclass(frozen=True, eq=False)
class SwivelCurve:
    """All postures of one side of the elbow, sample by sample: one per swivel angle and branch.

    Attributes:
        spherical: The arm.
        triples: The three-axis groups that depend on the swivel angle: shoulder, and wrist for poses.
        elbow: Angle of joint 4, shape (n,), in [rad].
        parts: C0, C1, C2 of Rz·Ry·Rz = C0 + C1·cos ψ + C2·sin ψ for each triple, entries row by row, shape
            (n, triples, 3, 9).
        shortfall: By how much the target is out of reach, shape (n,), in [m]; the postures then stretch,
            or fold, towards it.
        off_line: How far the elbow is from the line shoulder-target, shape (n,), in [m]; 0 at the straight
            arm, where both sides of the elbow meet.
        reference_sine: Sine of the angle between reference direction and line shoulder-target, shape (n,);
            0 where another direction had to take its place.
        rest: Angles of the joints after the elbow where the caller gave them, shape (n, dof - 4), in [rad];
            None for poses.
    """

    spherical: SphericalArm
    triples: tuple[AxisTriple, ...]
    elbow: Array
    parts: Array
    shortfall: Array
    off_line: Array
    reference_sine: Array
    rest: Array | None

    def rotations(self, psi: Array) -> Array:
        """Rz·Ry·Rz of shoulder and wrist.

        Args:
            psi: Swivel angles, shape (n, m), in [rad].

        Returns:
            Shape (n, m, triples, 9), row by row.

        Source:
            Al-Faiz, eq. 38, over the swivel angle.
        """
        c, s = np.cos(psi)[..., None, None], np.sin(psi)[..., None, None]
        C = self.parts[:, None]
        return np.asarray(C[:, :, :, 0] + C[:, :, :, 1] * c + C[:, :, :, 2] * s)

    def rows(self, chosen: ArrayLike) -> SwivelCurve:
        """The curve of some samples only.

        Args:
            chosen: Indices or a mask of samples.

        Returns:
            A new curve.

        Source:
            None (bookkeeping).
        """
        k = np.asarray(chosen)
        return SwivelCurve(
            self.spherical,
            self.triples,
            self.elbow[k],
            self.parts[k],
            self.shortfall[k],
            self.off_line[k],
            self.reference_sine[k],
            None if self.rest is None else self.rest[k],
        )

    def postures(
        self,
        psi: ArrayLike,
        shoulder: ArrayLike = 1,
        wrist: ArrayLike = 1,
        wish: Array | None = None,
        backend: Backend = "auto",
    ) -> Postures:
        """All joint angles for one swivel angle and branch per sample.

        Args:
            psi: Swivel angles, shape (n,), in [rad].
            shoulder: Branch of the shoulder, 1 or -1: the sign of sin(q2 + offset), shape (n,) or a number.
            wrist: Branch of the wrist, likewise for q6; unused for positions.
            wish: Postures that decide among angles 2π apart, and where the outer two axes of shoulder or
                wrist are parallel and share one angle freely, shape (n, dof), in [rad]; the middle of the
                range of motion if left out.
            backend: "auto", "c" or "vm".

        Returns:
            Postures; angles are inside the range of motion if a turn of 2π can bring them there.

        Raises:
            ShapeError: If `wish` has another shape.

        Source:
            Al-Faiz, eq. 13-47, corrected; Shimizu et al. (2008).
        """
        n, rom = len(self.elbow), self.spherical.arm.rom
        at = np.broadcast_to(np.asarray(psi, dtype=np.float64), (n,))
        if wish is not None and wish.shape != (n, rom.dof):
            raise ShapeError(f"wish {wish.shape}: expected ({n}, {rom.dof})")
        library = swivel_library(backend)
        if library is not None:
            branch = np.broadcast_to(self._pair(shoulder, wrist), (n,))
            q, sines = compiled_postures(library, (self, self), None, branch, at, wish)
            return Postures(q, sines[:, 0], sines[:, 1])
        wished = np.tile(rom.middle, (n, 1)) if wish is None else wish
        q = np.zeros((n, rom.dof))
        q[:, 3] = self.elbow
        if self.rest is not None:
            q[:, 4:] = self.rest
        sines = np.ones((n, 2))
        Q = self.rotations(at[:, None])[:, 0]
        for i, (triple, side) in enumerate(zip(self.triples, (shoulder, wrist), strict=False)):
            part = slice(triple.first, triple.first + 3)
            first = None if wish is None else wished[:, triple.first]
            q[:, part], sines[:, i] = triple_angles(
                triple, Q[:, i], side, rom.lower[part], rom.upper[part], first, backend
            )
        moved = slice(0, 4) if self.rest is not None else slice(None)
        q[:, moved] = nearest_in_range(q[:, moved], rom.lower[moved], rom.upper[moved], wished[:, moved])
        return Postures(q, np.abs(sines[:, 0]), np.abs(sines[:, 1]))

    def _pair(self, shoulder: ArrayLike, wrist: ArrayLike) -> Indices:
        """Number of the branch among those of this side of the elbow."""
        flipped = (np.asarray(shoulder) < 0).astype(np.int64)
        return 2 * flipped + (np.asarray(wrist) < 0) if len(self.triples) == 2 else flipped


@dataclass(frozen=True, eq=False)
class Postures:
    """Joint angles and how near they are to a singularity.

    Attributes:
        q: Joint angles, shape (n, dof), in [rad].
        shoulder_sine: |sin| of the angle between the first and third axis of the shoulder, shape (n,).
        wrist_sine: The same for the wrist, shape (n,); 1 for positions.
    """

    q: Array
    shoulder_sine: Array
    wrist_sine: Array

    @property
    def degenerate(self) -> NDArray[np.bool_]:
        """Where the outer two axes of shoulder or wrist are parallel and only sum or difference counts."""
        return np.asarray(np.minimum(self.shoulder_sine, self.wrist_sine) < DEGENERATE)


def triple_angles(
    triple: AxisTriple,
    Q: Array,
    side: ArrayLike,
    lower: Array,
    upper: Array,
    wish: Array | None = None,
    backend: Backend = "auto",
) -> tuple[Array, Array]:
    """Three angles of shoulder or wrist.

    Args:
        triple: The three axes.
        Q: Rz·Ry·Rz, row by row, shape (n, 9).
        side: Branch, 1 or -1, shape (n,) or a number.
        lower: Lower limits of the three, shape (3,), in [rad].
        upper: Upper limits of the three, shape (3,), in [rad].
        wish: Angle the first joint takes where it is free, shape (n,), in [rad].
        backend: "auto", "c" or "vm".

    Returns:
        Angles, shape (n, 3), in [rad], in (-π, π] before the offset of the second; and the sine of the
        second, (n,).

    Source:
        Siciliano et al., Robotics (2009), eq. 2.19-2.20.
    """
    sides = np.broadcast_to(np.asarray(side, dtype=np.float64), (len(Q),))
    free = first_at_pole(Q, lower, upper, wish)
    pole = np.column_stack([np.cos(free), np.sin(free)])
    pairs = evaluate("swivel_sides", Q, sides[:, None], pole, backend=backend).reshape(-1, 3, 2)
    angles = np.arctan2(pairs[..., 0], pairs[..., 1])
    angles[:, 1] -= triple.offset
    return angles, pairs[:, 1, 0]


def pose_curve(
    spherical: SphericalArm,
    position: ArrayLike,
    rotation: ArrayLike,
    side: int = 1,
    reference: ArrayLike | None = None,
    backend: Backend = "auto",
) -> SwivelCurve:
    """All postures that bring the hand to given poses.

    Args:
        spherical: The arm.
        position: Positions of the hand, shape (n, 3), in [m].
        rotation: Rotations of the hand, shape (n, 3, 3).
        side: Side of the elbow: 1 or -1, the sign of the angle from upper arm to forearm about joint 4.
        reference: Where the elbow points at ψ = 0, unit vector(s) in the base frame, shape (3,) or (n, 3);
            `spherical.reference` if left out.
        backend: "auto", "c" or "vm".

    Returns:
        The curve.

    Raises:
        OptionError: If the arm has no spherical wrist or `side` is not ±1.
        ShapeError: If shapes do not fit.

    Source:
        Al-Faiz, eq. 4-38, for any arm of this kind; Shimizu et al. (2008).
    """
    geometry = pose_geometry(spherical)
    p, R = np.asarray(position, dtype=np.float64), np.asarray(rotation, dtype=np.float64)
    if p.ndim != 2 or p.shape[1:] != (3,) or R.shape != (len(p), 3, 3):
        raise ShapeError(f"position {p.shape} and rotation {R.shape}: expected (n, 3) and (n, 3, 3)")
    pose = np.hstack([p, R.reshape(-1, 9)])
    return _curve(spherical, pose, geometry, side, reference, None, backend)


def position_curve(
    spherical: SphericalArm,
    position: ArrayLike,
    rest: ArrayLike,
    side: int = 1,
    reference: ArrayLike | None = None,
    backend: Backend = "auto",
) -> SwivelCurve:
    """All postures that bring the hand to given positions while the joints after the elbow have given angles.

    The elbow then swivels about the line from shoulder to hand, and forearm and hand are one rigid piece.

    Args:
        spherical: The arm; it needs no wrist.
        position: Positions of the hand, shape (n, 3), in [m].
        rest: Angles of the joints after the elbow, shape (n, dof - 4) or (dof - 4,), in [rad].
        side: Side of the elbow, 1 or -1.
        reference: As in `pose_curve`.
        backend: "auto", "c" or "vm".

    Returns:
        The curve; `rest` is put into the postures as it is.

    Raises:
        OptionError: If `side` is not ±1.
        ShapeError: If shapes do not fit.

    Source:
        Al-Faiz, eq. 4-35, with the hand in the place of the wrist.
    """
    p = np.asarray(position, dtype=np.float64)
    free = spherical.arm.dof - 4
    if p.ndim != 2 or p.shape[1:] != (3,):
        raise ShapeError(f"position {p.shape}: expected (n, 3)")
    given = np.asarray(rest, dtype=np.float64)
    if given.shape not in ((free,), (len(p), free)):
        raise ShapeError(f"rest {given.shape}: expected ({free},) or ({len(p)}, {free})")
    given = np.broadcast_to(given, (len(p), free)).copy()
    pose = np.hstack([p, np.tile(np.eye(3).ravel(), (len(p), 1))])
    return _curve(spherical, pose, position_geometry(spherical, given), side, reference, given, backend)


def _curve(
    spherical: SphericalArm,
    pose: Array,
    geometry: Array,
    side: int,
    reference: ArrayLike | None,
    rest: Array | None,
    backend: Backend,
) -> SwivelCurve:
    if isinstance(side, bool) or side not in (1, -1):
        raise OptionError(f"side of the elbow is {side!r}, expected 1 or -1")
    r = checked_reference(spherical, reference, len(pose))
    values = evaluate("swivel_curve", pose, geometry, side, r, backend=backend)
    triples = [spherical.shoulder]
    if rest is None and spherical.wrist is not None:
        triples.append(spherical.wrist)
    parts = values[:, 1:55].reshape(-1, 2, 3, 9)[:, : len(triples)]
    return SwivelCurve(
        spherical, tuple(triples), values[:, 0], parts, values[:, 55], values[:, 56], values[:, 57], rest
    )


def checked_reference(spherical: SphericalArm, reference: ArrayLike | None, n: int) -> Array:
    """Reference directions as unit vectors, one per sample.

    Args:
        spherical: The arm.
        reference: Shape (3,) or (n, 3); None for the arm's own.
        n: Number of samples.

    Returns:
        Shape (n, 3).

    Raises:
        ShapeError: If the shape is another one.
        OptionError: If a direction has no length.

    Source:
        None (bookkeeping).
    """
    r = np.asarray(spherical.reference if reference is None else reference, dtype=np.float64)
    if r.shape not in ((3,), (n, 3)):
        raise ShapeError(f"reference {r.shape}: expected (3,) or ({n}, 3)")
    size = np.linalg.norm(r, axis=-1, keepdims=True)
    if not np.all((size > 0) & np.isfinite(size)):
        raise OptionError("reference direction has no length")
    return np.broadcast_to(r / size, (n, 3))
