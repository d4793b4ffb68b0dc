"""How far measured joint angles may be off: noise carried through the closed form, and what is not rigid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from armik_sym.fitting.landmarks import Landmarks
from armik_sym.fitting.recorded_angles import angles_on_branches
from armik_sym.swivel.equivalent_angles import without_turns
from armik_sym.swivel.spherical_arm import SphericalArm

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_TINY = 1e-12


@dataclass(frozen=True, eq=False)
class FittedChain:
    """What turns recorded points into joint angles.

    Attributes:
        spherical: The fitted arm.
        hand_axes: Fingers, ulnar and dorsal in the hand frame, as columns, shape (3, 3).
        hand_length: From wrist to the end of the chain, in [m]; 0 if it ends at the wrist.
        base: Shoulder in the axes of the base frame, shape (3,); None if it moves with the recorded one.
    """

    spherical: SphericalArm
    hand_axes: Array
    hand_length: float
    base: Array | None

    def target(self, marks: Landmarks) -> tuple[Array, Array, Array]:
        """Position and rotation of the hand in the base frame, and the elbow from the shoulder.

        Args:
            marks: The points.

        Returns:
            Shapes (n, 3), (n, 3, 3) and (n, 3).

        Source:
            None (definition).
        """
        base = marks.shoulder if self.base is None else self.base
        rotation = marks.hand_directions() @ self.hand_axes.T
        end = marks.wrist
        if self.hand_length > 0:
            given = marks.turned is not None
            end = end + self.hand_length * rotation @ self.hand_axes[:, 0] if given else marks.hand
        return end - base + self.spherical.shoulder.centre, rotation, marks.elbow - base

    def rigid_target(self, marks: Landmarks) -> tuple[Array, Array, Array]:
        """The same for the arm with its segments in the recorded directions: no length, no base enters.

        Args:
            marks: The points.

        Returns:
            Shapes (n, 3), (n, 3, 3) and (n, 3).

        Source:
            None (definition).
        """
        lengths = self.spherical.arm.lengths
        rotation = marks.hand_directions() @ self.hand_axes.T
        elbow = lengths["upper_arm"] * _unit(marks.elbow - marks.shoulder)
        wrist = elbow + lengths["forearm"] * _unit(marks.wrist - marks.elbow)
        end = wrist + self.hand_length * rotation @ self.hand_axes[:, 0]
        return end + self.spherical.shoulder.centre, rotation, elbow


@dataclass(frozen=True, eq=False)
class PredictedError:
    """Expected error of the joint angles.

    Attributes:
        noise: From the noise of the points, sample by sample, standard deviation, shape (n, dof), in [rad].
        misfit: Root mean square of what shoulder movement and changing lengths add, shape (dof,), in [rad].
        total: Root mean square of both over all samples, shape (dof,), in [rad].
    """

    noise: Array
    misfit: Array
    total: Array


def predicted_error(
    chain: FittedChain, marks: Landmarks, branch: Indices, noise: Mapping[str, float], turned_noise: float
) -> PredictedError:
    """Expected error of the angles of a fixed-length arm that follows recorded points.

    Noise: var q = Σ σ_p² (∂q/∂p)², with differences over a step of σ_p. Misfit: D = q(arm follows the hand)
    - q(arm with its segments in the recorded directions); mean D² - mean var D is what noise does not
    explain. Total: √(mean var q + misfit²).

    Args:
        chain: The arm.
        marks: The points.
        branch: Branch of the closed form of each sample, shape (n,).
        noise: Noise of each point per coordinate, in [m]; NaN counts as 0.
        turned_noise: Noise of a given orientation per component, in [rad].

    Returns:
        The errors.

    Source:
        JCGM 100:2008 (GUM), §5.1.2 (law of propagation of uncertainty).
    """

    def both(at: Landmarks) -> tuple[Array, Array]:
        followed = angles_on_branches(chain.spherical, *chain.target(at), branch)
        rigid = angles_on_branches(chain.spherical, *chain.rigid_target(at), branch)
        return followed, without_turns(followed - rigid)

    q, apart = both(marks)
    of_q, of_apart = np.zeros_like(q), np.zeros_like(q)
    for moved in _perturbed(marks, noise, turned_noise):
        q_moved, apart_moved = both(moved)
        of_q += without_turns(q_moved - q) ** 2
        of_apart += without_turns(apart_moved - apart) ** 2
    misfit2 = np.maximum(np.mean(apart**2, axis=0) - np.mean(of_apart, axis=0), 0.0)
    return PredictedError(np.sqrt(of_q), np.sqrt(misfit2), np.sqrt(np.mean(of_q, axis=0) + misfit2))


def _perturbed(marks: Landmarks, noise: Mapping[str, float], turned_noise: float) -> list[Landmarks]:
    """The points with one coordinate of one point off by its noise, one after another."""
    moved = [
        marks.moved(name, sigma * axis)
        for name, sigma in noise.items()
        if np.isfinite(sigma) and sigma > 0
        for axis in np.eye(3)
    ]
    if marks.turned is not None and np.isfinite(turned_noise) and turned_noise > 0:
        from scipy.spatial.transform import Rotation  # slow to import, and few recordings have orientations

        for axis in np.eye(3):
            turn = Rotation.from_rotvec(turned_noise * axis).as_matrix()
            moved.append(replace(marks, turned=turn @ marks.turned))
    return moved


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), _TINY))
