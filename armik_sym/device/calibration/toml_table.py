"""Values of a TOML file, with errors that name file, line and key."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from armik_sym.arm.toml_reader import parse_toml
from armik_sym.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class TomlTable:
    """A table of a parsed file that knows where its values stand.

    Attributes:
        name: Name of the file, beginning messages.
        text: The whole text.
        values: The parsed table.
        table: Name of the array of tables it is in, such as "joint"; empty for the top of the file.
        number: Which one of them, from 0.
    """

    name: str
    text: str
    values: Mapping[str, Any]
    table: str = ""
    number: int = 0

    @staticmethod
    def parse(text: str, name: str) -> TomlTable:
        """Parse a text.

        Args:
            text: TOML.
            name: Name of the file, beginning messages.

        Returns:
            The top of the file.

        Raises:
            CalibrationError: If it is not TOML.

        Source:
            TOML 1.0.
        """
        return TomlTable(name, text, parse_toml(text, name, CalibrationError))

    def tables(self, key: str) -> list[TomlTable]:
        """The tables of an array, such as all [[joint]].

        Args:
            key: Name of the array.

        Returns:
            The tables.

        Raises:
            CalibrationError: If there are none.

        Source:
            None (bookkeeping).
        """
        found = self.values.get(key)
        if not isinstance(found, list) or not found or not all(isinstance(each, dict) for each in found):
            raise self.wrong(key, f"expected at least one table [[{key}]]")
        return [TomlTable(self.name, self.text, each, key, number) for number, each in enumerate(found)]

    def wrong(self, key: str, expected: str) -> CalibrationError:
        """The error for a value.

        Args:
            key: Its key.
            expected: What was expected, and what to do.

        Returns:
            The error to raise.

        Source:
            None (reporting).
        """
        said = f"is {self.values[key]!r:.80}" if key in self.values else "is missing"
        return CalibrationError(f"{self.name}: line {self.line(key)}: {key} {said}: {expected}")

    def line(self, key: str) -> int:
        """The line of a key, or of the head of its table if it is not there.

        Args:
            key: The key.

        Returns:
            Number of the line, from 1.

        Source:
            None (bookkeeping).
        """
        head, inside, seen = 1, not self.table, -1
        for number, line in enumerate(self.text.split("\n"), start=1):
            bracket = re.match(r"\s*\[\[?\s*[\"']?([^\]\"']+?)[\"']?\s*\]", line)
            if bracket and not re.match(r"\s*\[.*,", line):
                if inside:
                    return head
                seen += bracket.group(1) == self.table
                inside = bracket.group(1) == self.table and seen == self.number
                head = number if inside else head
            elif inside and re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*[=.]", line):
                return number
        return head

    def check_keys(self, allowed: tuple[str, ...]) -> None:
        """Refuse keys that nothing reads, so that a spelling mistake cannot pass for a setting.

        Args:
            allowed: Keys that are read.

        Raises:
            CalibrationError: If there is another one.

        Source:
            None (bookkeeping).
        """
        for key in self.values:
            if key not in allowed:
                raise self.wrong(key, f"unknown key; allowed are {', '.join(allowed)}")

    def string(self, key: str, default: str | None = None) -> str:
        """A text.

        Args:
            key: Its key.
            default: What it is if it is missing; None: it may not.

        Returns:
            The text.

        Raises:
            CalibrationError: If it is none.

        Source:
            None (bookkeeping).
        """
        value = self.values.get(key, default)
        if not isinstance(value, str):
            raise self.wrong(key, "expected a text in quotation marks")
        return value

    def integer(self, key: str, lowest: int, highest: int) -> int:
        """A whole number.

        Args:
            key: Its key.
            lowest: The lowest allowed.
            highest: The highest allowed.

        Returns:
            The number.

        Raises:
            CalibrationError: If it is none, or outside.

        Source:
            None (bookkeeping).
        """
        value = self.values.get(key)
        if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
            raise self.wrong(key, f"expected a whole number from {lowest} to {highest}")
        return value

    def number_of(self, key: str, default: float | None = None) -> float:
        """A finite number.

        Args:
            key: Its key.
            default: What it is if it is missing; None: it may not.

        Returns:
            The number.

        Raises:
            CalibrationError: If it is none.

        Source:
            None (bookkeeping).
        """
        return self.finite(key, self.values.get(key, default))

    def finite(self, key: str, value: object) -> float:
        """A value as a finite number.

        Args:
            key: Its key.
            value: The value, or a part of it.

        Returns:
            The number.

        Raises:
            CalibrationError: If it is none.

        Source:
            None (bookkeeping).
        """
        real = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not real or not abs(value) <= sys.float_info.max:  # type: ignore[arg-type]
            raise self.wrong(key, "expected a finite number")
        number = float(value)  # type: ignore[arg-type]
        if not math.isfinite(number):
            raise self.wrong(key, "expected a finite number")
        return number
