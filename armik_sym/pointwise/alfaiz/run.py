"""The method of Al-Faiz for many poses: along a path, or each by itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from armik_sym.arm.model import Arm
from armik_sym.errors import OptionError, ShapeError
from armik_sym.pointwise.alfaiz.c_loop import CompiledLoop
from armik_sym.pointwise.alfaiz.found import Found, Loop
from armik_sym.pointwise.alfaiz.numpy_loop import NumpyLoop
from armik_sym.pointwise.alfaiz.options import AlfaizOptions
from armik_sym.pointwise.alfaiz.printed_loop import PrintedLoop
from armik_sym.pointwise.hand_targets import HandTargets, PointwiseOutcome
from armik_sym.pointwise.library import PointwiseLibrary
from armik_sym.progress import Progress, ProgressCallback
from armik_sym.symbolic import Orientation
from armik_sym.symbolic.alfaiz_closed_form import closed_form_fits

Array = NDArray[np.float64]

# Samples per call into C: between calls Ctrl-C and progress have their turn.
BLOCK = 256


def run_alfaiz(
    arm: Arm,
    targets: HandTargets,
    options: AlfaizOptions,
    *,
    start: Array | None,
    seed: int = 0,
    library: PointwiseLibrary,
    progress: ProgressCallback | None = None,
    block: int = BLOCK,
) -> PointwiseOutcome:
    """Solve samples one after another, each near the posture before, or independently of each other.

    Args:
        arm: The arm; it must be built like `catalog.alfaiz`.
        targets: What the hand has to reach, with its rotation.
        options: Options of the method.
        start: Posture before the first sample, shape (7,), in [rad]; None if it is not known. With shape
            (n, 7) the samples are independent, each near its own posture.
        seed: Not used: nothing is random.
        library: Compiled loops; without them NumPy serves.
        progress: Told how many samples are done.
        block: Samples per call into C; results do not depend on it.

    Returns:
        Postures inside the range of motion. A sample counts as reached if the closed form has a posture
        inside; otherwise the answer is the one that leaves the range least, put back into it. Iterations are
        postures looked at.

    Raises:
        OptionError: If the closed form does not hold for the arm, or the targets have no rotation.
        ShapeError: If `start` fits neither the arm nor the samples.

    Source:
        Al-Faiz, eq. 4-57, corrected.
    """
    del seed
    _check(arm, targets)
    n = len(targets)
    starts = None if start is None else np.ascontiguousarray(start, dtype=np.float64)
    chain = starts is None or starts.ndim == 1
    if starts is not None and starts.shape != ((7,) if chain else (n, 7)):
        raise ShapeError(f"start has shape {starts.shape}, expected (7,), or ({n}, 7): one per sample")
    pose = np.ascontiguousarray(targets.pose, dtype=np.float64)
    found = Found.empty(n)
    loop = _loop(arm, options, library)
    for first in range(0, n, block):
        part = slice(first, min(first + block, n))
        before = found.q[first - 1] if chain and first else starts
        loop(part, pose, before, chain, found)
        if progress is not None:
            progress(Progress("samples", part.stop))
    return PointwiseOutcome(found.q, found.reached, found.evaluations, int(found.evaluations.sum()))


def _loop(arm: Arm, options: AlfaizOptions, library: PointwiseLibrary) -> Loop:
    if options.search == "printed":
        return PrintedLoop(arm, options)
    if library.library is not None:
        return CompiledLoop(library.library, arm, options)
    return NumpyLoop(arm, options)


def _check(arm: Arm, targets: HandTargets) -> None:
    if not closed_form_fits(arm):
        raise OptionError(
            f'method "alfaiz" needs an arm with the rows of catalog.alfaiz, arm {arm.name!r} has others: '
            'use "trajectory", "lm", "sugihara", "pro-isade" or "isade"'
        )
    if targets.orientation is not Orientation.FULL:
        raise OptionError(
            'method "alfaiz" needs the rotation of the hand at every sample: for positions only use '
            '"trajectory", "lm", "sugihara", "pro-isade" or "isade"'
        )
