"""Reading and writing text files with errors that name the file and what to do."""

from __future__ import annotations

from pathlib import Path

from armik_sym.errors import MotionFileError

_HEAD = 2**20
_LARGEST = 256 * 2**20
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")


def read_lines(path: Path) -> list[str]:
    """The lines of a UTF-8 text file, with or without a byte-order mark, with any line ends.

    Args:
        path: The file.

    Returns:
        Its lines, without line ends.

    Raises:
        MotionFileError: If the file is missing, a folder, unreadable, empty, binary or not UTF-8.

    Source:
        None (bookkeeping).
    """
    raw = _read_bytes(path)
    if not raw.strip():
        raise MotionFileError(f"{path}: the file is empty")
    if raw.startswith(_UTF16_MARKS):
        raise MotionFileError(f"{path}: the file is UTF-16 text: save it as UTF-8")
    if b"\0" in raw:
        line = raw[: raw.index(b"\0")].count(b"\n") + 1
        raise MotionFileError(
            f"{path}: line {line} holds a NUL byte: this is a binary or damaged file, expected UTF-8 text"
        )
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise MotionFileError(
            f"{path}: line {line} holds the byte 0x{raw[error.start]:02x}, which is not UTF-8: save the file "
            "with the encoding UTF-8"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def write_lines(path: Path, lines: list[str]) -> None:
    r"""Write a UTF-8 text file with line ends `\n`.

    Args:
        path: The file; its folder must exist.
        lines: Lines, without line ends.

    Raises:
        MotionFileError: If the file cannot be written.

    Source:
        None (bookkeeping).
    """
    try:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
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


def _read_bytes(path: Path) -> bytes:
    """All bytes, or only the first of a file that cannot be text, so that garbage is refused early."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
            if b"\0" in head:
                return head
            if len(head) == _HEAD and b"\n" not in head and b"\r" not in head:
                raise MotionFileError(
                    f"{path}: line 1 is longer than {_HEAD} bytes: this is no table of numbers"
                )
            raw = bytearray(head)
            while len(raw) <= _LARGEST and (more := file.read(16 * _HEAD)):
                raw += more
    except MotionFileError:
        raise
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from None
    if len(raw) > _LARGEST:
        raise MotionFileError(f"{path}: has more than {_LARGEST // 2**20} MiB, the most that is read at once")
    return bytes(raw)
