"""Files the commands write."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.motion.joint_motion import JointMotion
    from armik_sym.solution import Solution


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


def write_results(
    solution: Solution,
    folder: Path,
    stem: str,
    *,
    data_formats: tuple[str, ...],
    measured: JointMotion | None = None,
    title: str | None = None,
) -> list[Path]:
    """Write a solution as data files and figures.

    Args:
        solution: The solution.
        folder: Where to; it exists.
        stem: First part of all file names.
        data_formats: Endings of the data files, for example ".csv".
        measured: Measured motion to draw beside it, or None.
        title: What the motion is, for the figures.

    Returns:
        The files written: `<stem>_solution.<ending>`, `<stem>_joints.png`, `<stem>_hand.png`.

    Raises:
        MotionFileError: If a file cannot be written.

    Source:
        None (command line).
    """
    from armik_sym.report import hand_path_figure, save_figure, solution_figure

    written = [solution.save(folder / f"{stem}_solution{ending}") for ending in data_formats]
    joints = solution_figure(solution, measured, title=title)
    written.append(save_figure(joints, folder / f"{stem}_joints.png"))
    hand = hand_path_figure(solution, title=title)
    written.append(save_figure(hand, folder / f"{stem}_hand.png"))
    return written
