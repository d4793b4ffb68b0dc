"""The page: chapters, charts, kinematics and scripts in one file that needs nothing else."""

from __future__ import annotations

import base64
import datetime
import hashlib
import json
import os
from collections.abc import Sequence
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from armik_sym._version import __version__
from armik_sym.errors import MotionFileError, OptionError
from armik_sym.report.html.chapter import Chapter
from armik_sym.report.html.content import content_of
from armik_sym.report.html.scene import scene_of
from armik_sym.report.html.tables import versions
from armik_sym.report.wasm import PageKinematics, page_kinematics
from armik_sym.swivel.spherical_arm import recognise, why_not_spherical

Array = NDArray[np.float64]

# How many bytes frames computed beforehand may take, of all arms together: the page stays below 8 MB.
_BUDGET = 900_000
_ENDINGS = (".html", ".htm")
# In the order in which they are needed.
_SCRIPTS = ("numbers.js", "charts.js", "scene.js", "player.js", "start.js")


def write_report(
    path: str | os.PathLike[str],
    chapters: Sequence[Chapter],
    *,
    title: str | None = None,
    note: str | None = None,
    kinematics: str = "auto",
) -> Path:
    """Write a report: one file that opens in any browser, without a network.

    Args:
        path: The file, ending in .html.
        chapters: The motions; with several, the page has a tab for each.
        title: Heading of the page; None takes that of the only chapter.
        note: A remark below it, for example where the data come from.
        kinematics: What moves the arm in the page: "auto" (WebAssembly if a compiler makes it), "wasm" or
            "frames".

    Returns:
        The path written.

    Raises:
        OptionError: If there is no chapter, or `kinematics` is another word.
        CompilerError: If `kinematics` is "wasm" and nothing compiles to it.
        MotionFileError: If the ending is another one or the file cannot be written.

    Source:
        None (plotly.js, Jinja2).
    """
    file = Path(path)
    if file.suffix.lower() not in _ENDINGS:
        raise MotionFileError(f"{file}: cannot write a report as {file.suffix!r}: valid is .html")
    if not chapters:
        raise OptionError("a report needs at least one chapter")
    text = _rendered(chapters, title, note, kinematics)
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise MotionFileError(f"{file}: cannot be written: {error.strerror or error}") from None
    return file


def _rendered(chapters: Sequence[Chapter], title: str | None, note: str | None, kind: str) -> str:
    import jinja2
    from markupsafe import Markup
    from plotly.offline import get_plotlyjs

    arms = _kinematics(chapters, kind)
    contents = [content_of(chapter, i) for i, chapter in enumerate(chapters)]
    data = {
        "kinematics": [found.data for found, _ in arms],
        "chapters": [
            {"scene": scene_of(chapter, _index(arms, chapter)), "charts": content.chart_data()}
            for chapter, content in zip(chapters, contents, strict=True)
        ],
    }
    scripts = [get_plotlyjs(), arms[0][0].script, "\n".join(_asset(name) for name in _SCRIPTS)]
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_asset), autoescape=True, undefined=jinja2.StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    return environment.get_template("page.html.j2").render(
        title=title or contents[0].title,
        note=note or "",
        contents=contents,
        kinematics_notes=[arms[_index(arms, chapter)][0].note for chapter in chapters],
        swivel_notes=[arms[_index(arms, chapter)][0].why_no_swivel for chapter in chapters],
        versions=versions(),
        version=__version__,
        written=f"{datetime.datetime.now().astimezone():%d %B %Y, %H:%M}",
        # Files of packages, and JSON without any "<": nothing a user wrote is taken as markup.
        style=Markup(_asset("page.css")),  # noqa: S704
        scripts=[Markup(script) for script in scripts],  # noqa: S704
        policy=_policy(scripts),
        data=Markup(_json_in_html(data)),  # noqa: S704
    )


def _json_in_html(data: object) -> str:
    """JSON that cannot end the element it stands in, whatever texts are inside."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _policy(scripts: Sequence[str]) -> str:
    """What the page may do: run exactly these scripts, and reach nothing outside of itself."""
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'none'; script-src {allowed} 'wasm-unsafe-eval'; style-src 'unsafe-inline'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def _asset(name: str) -> str:
    return resources.files("armik_sym.report.html").joinpath("assets", name).read_text(encoding="utf-8")


_Found = list[tuple[PageKinematics, Chapter]]


def _kinematics(chapters: Sequence[Chapter], kind: str) -> _Found:
    """One kinematics for each arm, with the first chapter that uses it."""
    found: _Found = []
    arms = len({id(chapter.solution.arm) for chapter in chapters})
    budget = _BUDGET // arms
    for chapter in chapters:
        arm = chapter.solution.arm
        if any(first.solution.arm is arm for _, first in found):
            continue
        same = [each for each in chapters if each.solution.arm is arm]
        postures = np.vstack([each.solution.q for each in same])
        reference = None
        if why_not_spherical(arm) is None:
            reference = np.vstack([_reference(each) for each in same])
        made = page_kinematics(arm, postures, reference, kind, budget=budget)  # type: ignore[arg-type]
        found.append((made, chapter))
    return found


def _reference(chapter: Chapter) -> Array:
    """Where the elbow points at a swivel angle of 0, at every sample."""
    if chapter.map is not None:
        return chapter.map.reference
    return np.tile(recognise(chapter.solution.arm).reference, (len(chapter.solution.q), 1))


def _index(arms: _Found, chapter: Chapter) -> int:
    return next(i for i, (_, first) in enumerate(arms) if first.solution.arm is chapter.solution.arm)
