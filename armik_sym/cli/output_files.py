"""Files the commands write."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from armik_sym.compiled.backend import Backend
    from armik_sym.motion.joint_motion import JointMotion
    from armik_sym.solution import Solution

FIGURE_FORMATS = ("png", "pdf", "svg")


def prepare_folder(folder: Path) -> Path:
    """Create the folder for results before hours of work depend on it.

    Args:
        folder: The folder.

    Returns:
        The folder; it exists.

    Raises:
        OptionError: If it is a file or cannot be created.

    Source:
        None (command line).
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise OptionError(f"--out {folder}: a file stands in the way: choose another folder") from None
    except OSError as error:
        raise OptionError(f"--out {folder}: cannot be created: {error.strerror or error}") from None
    return folder


def figure_format_name(text: str) -> str:
    """Check the format of figures.

    Args:
        text: What was typed.

    Returns:
        "png", "pdf" or "svg".

    Raises:
        OptionError: If it is another word.

    Source:
        None (command line).
    """
    if text not in FIGURE_FORMATS:
        raise OptionError(f"--format is {text!r}: valid are {', '.join(FIGURE_FORMATS)}")
    return text


def write_results(
    solution: Solution,
    folder: Path,
    stem: str,
    *,
    data_formats: tuple[str, ...],
    measured: JointMotion | None = None,
    title: str | None = None,
    backend: Backend = "auto",
    figures: bool = True,
    figure_format: str = "png",
) -> list[Path]:
    """Write a solution and its alternatives as data files and figures.

    Args:
        solution: The solution.
        folder: Where to; it exists.
        stem: First part of all file names.
        data_formats: Endings of the data files, for example ".csv".
        measured: Measured motion to draw beside it, or None.
        title: What the motion is, for the figures.
        backend: "auto", "c" or "vm", for the swivel map.
        figures: Whether figures are drawn, too.
        figure_format: "png", or "pdf" or "svg" with lines and text that stay sharp in print.

    Returns:
        The files written: `<stem>_solution.<ending>`, for the second-best trajectory
        `<stem>_solution_2.<ending>`, and so on. With figures also `<stem>_joints.png`, `<stem>_joints_2.png`
        …, `<stem>_hand.png`, and for full poses of an arm that has a swivel map `<stem>_swivel_map.png`,
        or with the other ending.

    Raises:
        MotionFileError: If a file cannot be written.

    Source:
        None (command line).
    """
    written = []
    choices = (solution, *solution.alternatives)
    for number, each in enumerate(choices, start=1):
        written += [each.save(folder / f"{stem}_solution{_rank(number)}{ending}") for ending in data_formats]
    if not figures:
        return written

    from armik_sym.report import hand_path_figure, save_figure, solution_figure

    for number, each in enumerate(choices, start=1):
        about = f"{title}, choice {number}" if title and number > 1 else title
        joints = solution_figure(each, measured, title=about)
        written.append(save_figure(joints, folder / f"{stem}_joints{_rank(number)}.{figure_format}"))
    hand = hand_path_figure(solution, title=title)
    written.append(save_figure(hand, folder / f"{stem}_hand.{figure_format}"))
    map_ = _swivel_map_figure(solution, measured, title, backend)
    if map_ is not None:
        written.append(save_figure(map_, folder / f"{stem}_swivel_map.{figure_format}"))
    return written


def _rank(number: int) -> str:
    return f"_{number}" if number > 1 else ""


def _swivel_map_figure(
    solution: Solution, measured: JointMotion | None, title: str | None, backend: Backend
) -> Figure | None:
    """The solution and its alternatives on their swivel map; None where there is no such map."""
    from armik_sym.swivel.map import swivel_map
    from armik_sym.swivel.spherical_arm import why_not_spherical
    from armik_sym.symbolic import Orientation

    if solution.orientation is not Orientation.FULL or why_not_spherical(solution.arm) is not None:
        return None
    others: dict[str, Any] = {} if measured is None else {"measured": measured}
    others |= {f"choice {number}": each for number, each in enumerate(solution.alternatives, start=2)}
    map_ = swivel_map(solution.arm, solution.path, backend=backend)
    return map_.plot(solution, others, title=title)
