"""Text files of others, one numbered line at a time, in bounded memory."""

from __future__ import annotations

import io
import re
from pathlib import Path
from types import TracebackType
from typing import TextIO

from armik_sym.errors import MotionFileError
from armik_sym.motion.text_file import unreadable

LONGEST_LINE = 1_000_000
MOST_BLANK_LINES = 10_000
_MOST_COMMENTS_KEPT = 1000
# Byte-order marks, as lone surrogates.
_UTF16_MARKS = ("\udcff\udcfe", "\udcfe\udcff")
_NOT_UTF8 = re.compile("[\udc80-\udcff]")


class NumberedLines:
    """The lines of a UTF-8 text file, with or without a byte-order mark, with any line ends.

    Lines are checked as they are read, so garbage is refused at its first line, however long the file.

    Attributes:
        path: The file.
        number: Number of the line read last, from 1.
        comments: What the first comments say that `next_uncommented` passed over.

    Raises:
        MotionFileError: If the file is missing, a folder or unreadable.

    Source:
        None (bookkeeping).
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 0
        self.comments: list[str] = []
        self._file = _open(path)

    def __enter__(self) -> NumberedLines:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def next_line(self, any_encoding: bool = False) -> str | None:
        """Read the next line.

        Args:
            any_encoding: Replace bytes that are not UTF-8 instead of refusing them, for a line whose text
                does not matter.

        Returns:
            The line without its end, or None at the end of the file.

        Raises:
            MotionFileError: If it is too long, holds a NUL byte or is not UTF-8.

        Source:
            None (bookkeeping).
        """
        try:
            line = self._file.readline(LONGEST_LINE)
        except OSError as error:
            raise MotionFileError(f"{self.path}: cannot be read: {error.strerror or error}") from None
        if not line:
            return None
        self.number += 1
        if self.number == 1 and line.startswith(_UTF16_MARKS):
            raise self.error("starts like UTF-16 text: save it as UTF-8")
        if "\0" in line:
            raise self.error("holds a NUL byte: this is a binary or damaged file, expected UTF-8 text")
        if len(line) >= LONGEST_LINE:
            raise self.error(f"is longer than {LONGEST_LINE} characters: this is no table of numbers")
        if not line.isascii():
            line = self._decoded(line, any_encoding)
        return line.rstrip("\n")

    def next_content(self, blanks: str = "") -> str | None:
        """Read on to the next line that is not blank.

        Args:
            blanks: Characters besides white space that leave a line blank, such as ",".

        Returns:
            The line without its end, or None at the end of the file.

        Raises:
            MotionFileError: As `next_line`, and after very many blank lines.

        Source:
            None (bookkeeping).
        """
        for _ in range(MOST_BLANK_LINES):
            line = self.next_line()
            if line is None or line.strip(blanks + " \t\r\v\f"):
                return line
        raise self.error(f"follows {MOST_BLANK_LINES} blank lines: this is no table of numbers")

    def next_uncommented(self) -> str | None:
        """Read on to the next line that is neither blank nor a comment, which starts with '#'.

        Returns:
            The line without its end, or None at the end of the file.

        Raises:
            MotionFileError: As `next_line`, and after very many blank lines or comments.

        Source:
            None (file formats of this package, see `docs/files.md`).
        """
        for _ in range(MOST_BLANK_LINES):
            line = self.next_content()
            if line is None or not line.lstrip().startswith("#"):
                return line
            if len(self.comments) < _MOST_COMMENTS_KEPT:
                self.comments.append(line.strip().lstrip("#").strip())
        raise self.error(f"follows {MOST_BLANK_LINES} comments: this is no table of numbers")

    def said(self, key: str) -> str:
        """What a comment "# key: …" says, the first if there are several.

        Args:
            key: The key with its colon, in small letters.

        Returns:
            The text behind it, or "".

        Source:
            None (file formats of this package, see `docs/files.md`).
        """
        return next((text[len(key) :].strip() for text in self.comments if text.lower().startswith(key)), "")

    def error(self, said: str) -> MotionFileError:
        """An error about the line read last.

        Args:
            said: What about it.

        Returns:
            The error, with file and line.

        Source:
            None (reporting).
        """
        return MotionFileError(f"{self.path}: line {self.number} {said}")

    def _decoded(self, line: str, any_encoding: bool) -> str:
        bad = _NOT_UTF8.search(line)
        if bad is None:
            return line
        if any_encoding:
            return _NOT_UTF8.sub("\N{REPLACEMENT CHARACTER}", line)
        byte = ord(bad.group()) - 0xDC00
        raise self.error(
            f"holds the byte 0x{byte:02x}, which is not UTF-8: save the file with the encoding UTF-8"
        )


def _open(path: Path) -> TextIO:
    try:
        raw = path.open("rb")
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from None
    # Bytes that are not UTF-8 become lone surrogates, which tell where they were.
    return io.TextIOWrapper(raw, encoding="utf-8-sig", errors="surrogateescape", newline=None)
