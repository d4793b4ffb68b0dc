"""Writes the files of arms, whatever their format."""

from __future__ import annotations

import os
from pathlib import Path

from armik_sym.errors import ArmFileError


def write_arm_file(path: str | os.PathLike[str], text: str) -> Path:
    """Write a text as a file.

    Args:
        path: The file; its folder must exist.
        text: What it holds.

    Returns:
        The path written.

    Raises:
        ArmFileError: If the file cannot be written.

    Source:
        None (bookkeeping).
    """
    file = Path(path)
    try:
        file.write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        said = f"there is no folder {file.parent}" if isinstance(error, FileNotFoundError) else error.strerror
        raise ArmFileError(f"{file}: cannot be written: {said}") from None
    return file
