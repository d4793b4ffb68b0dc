"""What `armik compare` prints and writes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from armik_sym.cli.console import plain_table, say, show
from armik_sym.cli.recorded import Recorded

if TYPE_CHECKING:
    from armik_sym.comparison import Comparison
    from armik_sym.compiled.backend import Backend

_ABOUT = (
    "Solved minus measured; every method was given the hand path and the first posture, nothing else. Many "
    "postures put the hand on the same path: a difference is no error of the solution."
)


def say_all(recorded: Recorded, found: Mapping[str, Comparison], failed: Mapping[str, str]) -> None:
    """Print the fit, the table and everything a reader has to know.

    Args:
        recorded: What was recorded.
        found: Comparisons by method.
        failed: Why other methods found no solution.

    Source:
        None (command line).
    """
    if recorded.report:
        say(recorded.report)
        say("")
    if found:
        show_table(found)
        say("")
        say(_ABOUT)
    for line in _remarks(recorded, found, failed):
        say(line)


def _remarks(recorded: Recorded, found: Mapping[str, Comparison], failed: Mapping[str, str]) -> list[str]:
    """What was done to the data, said once, and what is to be known of each method."""
    from armik_sym.comparison.constant_swivel import METHOD
    from armik_sym.comparison.predicting import first_inside

    moved = first_inside(recorded.arm, recorded.measured.q[0])[1]
    shared = [*recorded.notes, *([moved] if moved else [])]
    for comparison in found.values():
        shared += [note for note in comparison.notes if note not in shared]
    lines = [f"note: {note}" for note in shared]
    for name, comparison in found.items():
        solution = comparison.solution
        lines += [f"{name}: {solution.status}"] if solution.method == METHOD else []
        lines += [f"{name}: {reason}" for reason in solution.reasons]
    return lines + [f"{name}: no solution: {reason}" for name, reason in failed.items()]


def show_table(found: Mapping[str, Comparison]) -> None:
    """Print mean, RMS and maximum of every quantity, a line each, for every method.

    Args:
        found: Comparisons by method.

    Source:
        Compare Nguyen 2021, Table 6.
    """
    from armik_sym.comparison.text import rows

    columns = [("difference to measured", False)]
    for name in found:
        columns += [(f"{name}\nmean", True), ("\nRMS", True), ("\nmax", True)]
    table = plain_table(columns)
    by_quantity: dict[str, list[str]] = {}
    for comparison in found.values():
        for name, unit, factor, d in rows(comparison):
            cells = by_quantity.setdefault(f"{name.replace('_', ' ')} [{unit}]", [])
            cells += [f"{factor * value:.2f}" for value in (d.mean, d.rms, d.max)]
    for quantity, cells in by_quantity.items():
        table.add_row(quantity, *cells)
    show(table)


def write_comparisons(
    recorded: Recorded,
    found: Mapping[str, Comparison],
    failed: Mapping[str, str],
    folder: Path,
    backend: Backend,
) -> list[Path]:
    """Write tables and figures.

    Args:
        recorded: What was recorded.
        found: Comparisons by method.
        failed: Why other methods found no solution.
        folder: Where to; it exists.
        backend: "auto", "c" or "vm", for the swivel map.

    Returns:
        The files: `<stem>_comparison.txt` and `.csv`; for every method `<stem>_<method>.csv`, `.png`; and
        `<stem>_swivel_map.png` with all of them where the arm has one.

    Raises:
        MotionFileError: If a file cannot be written.

    Source:
        None (command line).
    """
    from armik_sym.comparison.csv_files import write_summary
    from armik_sym.motion.text_file import write_lines
    from armik_sym.report import save_figure

    stem = Path(recorded.name).stem
    text = folder / f"{stem}_comparison.txt"
    write_lines(text, [_report(recorded, found, failed)])
    written = [text, write_summary(found, folder / f"{stem}_comparison.csv")]
    for name, comparison in found.items():
        written.append(comparison.save(folder / f"{stem}_{name}.csv"))
        figure = comparison.plot(title=recorded.name)
        written.append(save_figure(figure, folder / f"{stem}_{name}.png"))
    return [*written, *_swivel_map(recorded, found, folder / f"{stem}_swivel_map.png", backend)]


def _report(recorded: Recorded, found: Mapping[str, Comparison], failed: Mapping[str, str]) -> str:
    parts = [recorded.name, *([recorded.report] if recorded.report else [])]
    parts += [str(comparison) for comparison in found.values()]
    parts += ["\n".join(_remarks(recorded, found, failed)), _ABOUT]
    return "\n\n".join(part for part in parts if part)


def _swivel_map(
    recorded: Recorded, found: Mapping[str, Comparison], file: Path, backend: Backend
) -> list[Path]:
    """The measured and all solved motions on one map; nothing where the arm has none."""
    from armik_sym.report import save_figure
    from armik_sym.swivel.map import swivel_map
    from armik_sym.swivel.spherical_arm import why_not_spherical

    if not found or recorded.path.rotation is None or why_not_spherical(recorded.arm) is not None:
        return []
    map_ = swivel_map(recorded.arm, recorded.path, backend=backend)
    (first, solved), *others = ((name, comparison.solution) for name, comparison in found.items())
    lines = {"measured": recorded.measured, **dict(others)}
    return [save_figure(map_.plot(solved, lines, title=f"{recorded.name}, solved by {first}"), file)]
