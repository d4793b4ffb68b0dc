"""Where the files that come with the package lie."""

from __future__ import annotations

from pathlib import Path

from armik_sym.errors import MotionFileError


def data_folder() -> Path:
    """The folder with the bundled `tasks`, `arms` and `patients`.

    An installed wheel carries it as `armik_sym/_data`; a working copy has it as `data`.

    Returns:
        The folder.

    Raises:
        MotionFileError: If neither exists.

    Source:
        None (bookkeeping).
    """
    package = Path(__file__).resolve().parents[1]
    candidates = (package / "_data", package.parent / "data")
    for folder in candidates:
        if (folder / "tasks").is_dir():
            return folder
    raise MotionFileError(
        f"the bundled data are missing: neither {candidates[0]} nor {candidates[1]} holds a folder 'tasks'; "
        "install the package again"
    )
