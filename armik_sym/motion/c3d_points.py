"""The points of a c3d file, once its header is known to tell the truth."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym.errors import MotionFileError
from armik_sym.motion.c3d_header import C3DHeader
from armik_sym.motion.c3d_parameters import from_dec

Array = NDArray[np.float64]


def read_points(path: Path, header: C3DHeader) -> Array:
    """Read the points: four numbers each in every frame, x, y, z and a residual, then the analog values.

    Only points are copied into memory. A point is missing where its residual is negative, or a
    coordinate is not finite.

    Args:
        path: The file.
        header: Its header, held against the length of the file.

    Returns:
        Points in the unit of the file, shape (frames, points, 3); NaN where missing.

    Raises:
        MotionFileError: If the file cannot be read.

    Source:
        The C3D file format user guide, Motion Lab Systems (2021).
    """
    real = header.scale < 0
    words = 2 if real and header.dec else 1
    kind = "<u2" if words == 2 else f"{header.order}{'f4' if real else 'i2'}"
    width = header.points * 4
    shape = (header.frames, (width + header.analog) * words)
    try:
        every = np.memmap(path, dtype=kind, mode="r", offset=header.start, shape=shape)
    except (OSError, ValueError) as error:
        raise MotionFileError(f"{path}: cannot be read: {error}") from None
    part = np.array(every[:, : width * words])
    del every
    # Bytes that are no number (signalling NaN) are gaps like any other NaN.
    with np.errstate(invalid="ignore"):
        numbers = from_dec(part) if words == 2 else part.astype(np.float64)
    points = numbers.reshape(header.frames, header.points, 4)
    position = points[..., :3] if real else points[..., :3] * header.scale
    missing = (points[..., 3] < 0) | ~np.isfinite(position).all(axis=2)
    return np.where(missing[..., None], np.nan, position)
