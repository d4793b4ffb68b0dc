"""Text of emitted files: templates, comments and number lists."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib import resources

import numpy as np
from numpy.typing import ArrayLike

from armik_sym.compiled.c_constant import Precision, c_constant

_PER_LINE = 4


def fill_template(name: str, values: Mapping[str, str]) -> str:
    """A template of this package with every `@KEY@` replaced.

    Args:
        name: Name of the emitted file; the template has `.in` behind it.
        values: Text by key.

    Returns:
        The text.

    Source:
        None (CMake's `configure_file` writes placeholders this way).
    """
    folder = resources.files("armik_sym.compiled") / "c"
    text = (folder / f"{name}.in").read_text(encoding="utf-8")
    for key, value in values.items():
        text = text.replace(f"@{key}@", value)
    return text


def comment_text(text: str) -> str:
    """Free text made fit for a C comment: one line of printable ASCII that neither ends nor opens one.

    Args:
        text: Any text, such as the description of an arm.

    Returns:
        The text with other characters as `_`, and with `*/`, `/*` and trigraphs broken up.

    Source:
        None (C99, 5.2.1.1 and 6.4.9).
    """
    line = " ".join(text.split())
    line = "".join(c if " " <= c <= "~" and c not in "\\@" else "_" for c in line)
    return re.sub(r"\?(?=\?)", "? ", line.replace("*/", "* /").replace("/*", "/ *"))


def number_rows(rows: ArrayLike, precision: Precision) -> str:
    """Rows of numbers as the inside of a two-dimensional C initialiser.

    Args:
        rows: Numbers, shape (n, k).
        precision: "double" or "float".

    Returns:
        C source text: `{a, b, …},` row after row.

    Source:
        None (C99, 6.7.8).
    """
    return ",\n".join(_row([c_constant(float(x), precision) for x in row]) for row in np.asarray(rows))


def _row(numbers: Sequence[str]) -> str:
    lines = [", ".join(numbers[i : i + _PER_LINE]) for i in range(0, len(numbers), _PER_LINE)]
    return "  {" + ",\n   ".join(lines) + "}"
