"""What stands in a chapter: sentences, charts and tables, by section."""

from __future__ import annotations

import base64
import itertools
from dataclasses import dataclass
from typing import Any

from armik_sym.report.hand_path_figure import hand_path_figure
from armik_sym.report.html.chapter import MEASURED_NAME, Chapter
from armik_sym.report.html.chart import SOLVED_LINE, Chart, styles_of
from armik_sym.report.html.motion_charts import error_charts, joint_charts, rate_charts
from armik_sym.report.html.sentences import (
    asked,
    in_words,
    largest_step,
    room,
    servo_verdict,
    tracking,
    verdict,
)
from armik_sym.report.html.servo_charts import difference_chart, servo_charts
from armik_sym.report.html.swivel_chart import swivel_chart
from armik_sym.report.html.tables import (
    Table,
    difference_table,
    joint_table,
    method_table,
    servo_table,
    settings_table,
)
from armik_sym.report.page import figure_bytes
from armik_sym.report.swivel_map_panel import TINTS
from armik_sym.report.words import without_exponents


@dataclass(frozen=True, eq=False)
class KeyLine:
    """A line of the key.

    Attributes:
        words: What the line is.
        color: Its colour.
        width: Its width, in [px].
        dash: Its dashes, as SVG takes them.
    """

    words: str
    color: str
    width: float
    dash: str


@dataclass(frozen=True, eq=False)
class Content:
    """A chapter, ready for the template.

    Attributes:
        number: Number of the chapter, from 0.
        title: What the motion is.
        note: Where the data come from.
        ok: Whether the solution is what was asked for.
        verdict: One sentence.
        servo_ok: Whether the drives can follow; None if nobody asked.
        servo_verdict: One sentence, or nothing.
        reasons: What speaks against the solution.
        servo_reasons: What speaks against the drives.
        blocked: Which instants have no posture at all, and why.
        facts: Short facts: name and value.
        asked: What was asked for.
        key: What the lines are.
        tints: What the colours of the swivel map are: colour and words.
        picture: The hand path and the arm at a few instants for print, WebP as base64.
        charts: Charts by section.
        tables: Tables by section.
    """

    number: int
    title: str
    note: str
    ok: bool
    verdict: str
    servo_ok: bool | None
    servo_verdict: str
    reasons: tuple[str, ...]
    servo_reasons: tuple[str, ...]
    blocked: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    asked: tuple[str, ...]
    key: tuple[KeyLine, ...]
    tints: tuple[tuple[str, str], ...]
    picture: str
    charts: dict[str, list[Chart]]
    tables: dict[str, Table | None]

    def chart_data(self) -> dict[str, dict[str, Any]]:
        """The charts as the page reads them, by the ids the template gives them.

        Returns:
            Traces and layouts by id.

        Source:
            None (plotly).
        """
        return {
            self.chart_id(section, i): chart.data()
            for section, charts in self.charts.items()
            for i, chart in enumerate(charts)
        }

    def chart_id(self, section: str, i: int) -> str:
        """The id of a chart in the page.

        Args:
            section: Its section.
            i: Its number in the section.

        Returns:
            The id.

        Source:
            None (bookkeeping).
        """
        return f"chart-{self.number}-{section}-{i}"


def content_of(chapter: Chapter, number: int) -> Content:
    """What stands in a chapter.

    Args:
        chapter: The chapter.
        number: Its number, from 0.

    Returns:
        The content.

    Source:
        None (reporting).
    """
    s, servo = chapter.solution, chapter.servo
    map_, difference = swivel_chart(chapter), difference_chart(chapter)
    return Content(
        number=number,
        title=chapter.title,
        note=chapter.note,
        ok=s.ok,
        verdict=verdict(chapter),
        servo_ok=None if servo is None else servo.ok,
        servo_verdict=servo_verdict(chapter),
        reasons=tuple(in_words(s.arm, reason) for reason in s.reasons),
        servo_reasons=() if servo is None else tuple(in_words(s.arm, reason) for reason in servo.reasons),
        blocked=() if chapter.map is None else chapter.map.explain_blocked(),
        facts=_facts(chapter),
        asked=tuple(asked(chapter)),
        key=_key(chapter),
        tints=_tints(),
        picture=_picture(chapter),
        charts={
            "map": [map_] if map_ else [],
            "joints": joint_charts(chapter),
            "errors": error_charts(s) if chapter.path_known else [],
            "rates": rate_charts(s),
            "servo": servo_charts(chapter),
            "difference": [difference] if difference else [],
        },
        tables={
            "joints": joint_table(s).for_readers(),
            "servo": None if servo is None else servo_table(servo).for_readers(),
            "methods": _for_readers(method_table(chapter)),
            "difference": _for_readers(difference_table(chapter)),
            "settings": settings_table(chapter),
        },
    )


def _for_readers(table: Table | None) -> Table | None:
    return None if table is None else table.for_readers()


def _facts(chapter: Chapter) -> tuple[tuple[str, str], ...]:
    s = chapter.solution
    hand = [("Hand on its path", tracking(s))] if chapter.path_known else []
    facts = [*hand, ("Range of motion", room(s)), ("Smoothness", largest_step(s))]
    if chapter.servo is not None:
        peak = without_exponents(f"{1000 * chapter.servo.tracking.hand_peak:.2g}")
        facts.append(
            ("Drives", f"{'can' if chapter.servo.ok else 'cannot'} follow; hand at most {peak} mm off")
        )
    found = chapter.differences.get("")
    if found is not None and found.elbow_summary is not None:
        facts.append(
            ("Against the measured motion", f"elbow on average {1000 * found.elbow_summary.mean:.0f} mm away")
        )
    return tuple(facts)


def _key(chapter: Chapter) -> tuple[KeyLine, ...]:
    names = [*([MEASURED_NAME] if chapter.measured is not None else []), *chapter.others]
    styles = {f"solved (method {chapter.solution.method})": SOLVED_LINE, **styles_of(names)}
    return tuple(
        KeyLine(name, style["color"], style["width"], style.get("dash", "").replace("px", ""))
        for name, style in styles.items()
    )


def _picture(chapter: Chapter) -> str:
    figure = hand_path_figure(chapter.solution, title=chapter.title, note=chapter.note)
    return base64.b64encode(figure_bytes(figure, ".webp")).decode("ascii")


def _tints() -> tuple[tuple[str, str], ...]:
    words = [f"{low[0]:g} to {high[0]:g}°" for low, high in itertools.pairwise(TINTS)]
    words.append(f"over {TINTS[-1][0]:g}°")
    return tuple((colour, text) for (_, colour), text in zip(TINTS, words, strict=True))
