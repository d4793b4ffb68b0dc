"""What an HTML page needs in order to move the arm by itself."""

from __future__ import annotations

import base64
import logging
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armik_sym.arm.model import Arm
from armik_sym.compiled.compiler import find_zig
from armik_sym.errors import CompilerError, OptionError, ShapeError
from armik_sym.report.wasm.drawn_points import DrawnPoints, drawn_points
from armik_sym.report.wasm.frames import fixed_frames, turned_frames
from armik_sym.report.wasm.module_source import script_text
from armik_sym.report.wasm.wasm_compiler import NO_COMPILER, wasm_module
from armik_sym.swivel.closed_form import checked_reference
from armik_sym.swivel.constants import ROUNDING
from armik_sym.swivel.geometry import pose_geometry
from armik_sym.swivel.spherical_arm import recognise, why_not_spherical

Array = NDArray[np.float64]
Kind = Literal["auto", "wasm", "frames"]

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class PageKinematics:
    """The kinematics of one arm for a page.

    Attributes:
        kind: "wasm" (the generated C as WebAssembly) or "frames" (computed beforehand).
        note: One sentence about it for the reader of the page.
        why_no_swivel: Why the elbow cannot be turned while the hand stays; empty if it can.
        landmarks: Index of shoulder, elbow, wrist and hand among the points that the page draws, as far as
            the arm has them.
        data: What `armikKinematics` of `script` takes, ready for JSON.
    """

    kind: Literal["wasm", "frames"]
    note: str
    why_no_swivel: str
    landmarks: dict[str, int]
    data: dict[str, Any]

    @property
    def script(self) -> str:
        """JavaScript that defines `armikKinematics(data)`, which promises the kinematics."""
        return script_text("kinematics.js")


def page_kinematics(
    arm: Arm,
    postures: ArrayLike,
    reference: ArrayLike | None = None,
    kind: Kind = "auto",
    budget: int | None = None,
) -> PageKinematics:
    """The kinematics of an arm for a page: WebAssembly, or frames where nothing compiles to it.

    Args:
        arm: The arm.
        postures: All postures that the page draws, shape (n, dof), in [rad]; frames know only these.
        reference: Where the elbow points at ψ = 0 in the frames, shape (3,) or (n, 3); the arm's own if left
            out. WebAssembly is told with each call.
        kind: "auto" (WebAssembly if a compiler makes it), "wasm" (or an error) or "frames".
        budget: How many bytes frames may take; None for what a page alone has room for.

    Returns:
        Data and script for the page.

    Raises:
        CompilerError: If `kind` is "wasm" and there is no compiler for it, or it fails.
        OptionError: If `kind` is another word.
        ShapeError: If shapes do not fit, or there are no postures.

    Source:
        None (this package).
    """
    if kind not in ("auto", "wasm", "frames"):
        raise OptionError(f"kind is {kind!r}: valid are auto, wasm, frames")
    q = np.asarray(postures, dtype=np.float64)
    if q.ndim != 2 or q.shape[1] != arm.dof or not len(q):
        raise ShapeError(f"postures {q.shape}: expected (n, {arm.dof}) for arm {arm.name!r}, n at least 1")
    if not np.isfinite(q).all():
        bad = int(np.argwhere(~np.isfinite(q))[0, 0])
        raise ShapeError(f"postures: sample {bad} holds an angle that is no finite number")
    points, why = drawn_points(arm), why_not_spherical(arm) or ""
    common = _common(arm, points, why)
    because = "as asked for"
    if kind != "frames":
        try:
            return _with_wasm(arm, points, why, common)
        except CompilerError as error:
            if kind == "wasm":
                raise
            _LOG.warning("no WebAssembly for the page: %s", error)
            because = "because " + ("the compiler for WebAssembly failed" if find_zig() else NO_COMPILER)
    return _with_frames(arm, points, why, common, q, reference, because, budget)


def _common(arm: Arm, points: DrawnPoints, why: str) -> dict[str, Any]:
    return {
        "dof": arm.dof,
        "jointNames": list(arm.joint_names),
        "lower": arm.rom.lower.tolist(),
        "upper": arm.rom.upper.tolist(),
        "rounding": ROUNDING,
        "landmarks": points.landmarks,
        "whyNoSwivel": why,
    }


def _with_wasm(arm: Arm, points: DrawnPoints, why: str, common: dict[str, Any]) -> PageKinematics:
    module, compiler = wasm_module(arm)
    version = compiler.version.partition(" (")[0]  # without the address of the compiler's home
    note = f"The arm of this page is moved by the generated C code, as WebAssembly by zig ({version})."
    data = common | {
        "kind": "wasm",
        "note": note,
        "module": _text(module),
        "lengths": arm.length_values.tolist(),
        "points": points.local.ravel().tolist(),
    }
    if not why:
        spherical = recognise(arm)
        offsets = [triple.offset for triple in (spherical.shoulder, spherical.wrist) if triple]
        data |= {
            "geometry": pose_geometry(spherical).tolist(),
            "reference": spherical.reference.tolist(),
            "limits": [*common["lower"], *common["upper"], *offsets],
        }
    return PageKinematics("wasm", note, why, points.landmarks, data)


def _with_frames(
    arm: Arm,
    points: DrawnPoints,
    why: str,
    common: dict[str, Any],
    q: Array,
    reference: ArrayLike | None,
    because: str,
    budget: int | None,
) -> PageKinematics:
    note = f"The arm of this page moves in steps that were computed beforehand, {because}."
    if why:
        frames = fixed_frames(arm, points, q, budget)
    else:
        directions = None if reference is None else checked_reference(recognise(arm), reference, len(q))
        frames = turned_frames(arm, points, q, directions, budget=budget)
    arrays = {"q": frames.q, "drawn": frames.drawn, "psi": frames.psi, "turned": frames.turned}
    data = common | {"kind": "frames", "note": note, "steps": frames.turned.shape[1]}
    data |= {key: _text(value.astype("<f8").tobytes()) for key, value in arrays.items()}
    return PageKinematics("frames", note, why, points.landmarks, data)


def _text(values: bytes) -> str:
    return base64.b64encode(values).decode("ascii")
