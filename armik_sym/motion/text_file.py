"""Writing text files, with errors that name the file and what to do."""

from __future__ import annotations

from pathlib import Path

from armik_sym.errors import MotionFileError


def write_lines(path: Path, lines: list[str]) -> None:
    r"""Write a UTF-8 text file with line ends `\n`.

    Args:
        path: The file; its folder must exist.
        lines: Lines, without line ends.

    Raises:
        MotionFileError: If the file cannot be written, or a line is no Unicode text.

    Source:
        None (bookkeeping).
    """
    text = "\n".join(lines) + "\n"
    if "\0" in text:
        raise MotionFileError(f"{path}: cannot be written: a name or comment holds a NUL character")
    try:
        path.write_text(text, encoding="utf-8", newline="\n")
    except UnicodeEncodeError as error:
        bad = error.object[error.start]
        raise MotionFileError(f"{path}: cannot be written: {bad!r} is half a character") from None
    except FileNotFoundError:
        raise MotionFileError(f"{path}: cannot be written: there is no folder {path.parent}") from None
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be written: {error.strerror or error}") from None


def unreadable(path: Path, error: OSError | ValueError) -> MotionFileError:
    """Why a file cannot be read, in words.

    Args:
        path: The file.
        error: What went wrong when it was opened or read.

    Returns:
        The error to raise.

    Source:
        None (reporting).
    """
    if isinstance(error, FileNotFoundError):
        return MotionFileError(f"{path}: no such file")
    if path.is_dir():
        return MotionFileError(f"{path}: is a folder, expected a file")
    return MotionFileError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}")
