"""The hand-written C that rides along with generated code."""

from __future__ import annotations

from importlib import resources


def loop_text(name: str) -> str:
    """One hand-written file of `compiled/c`.

    Args:
        name: File name.

    Returns:
        C source text.

    Source:
        None (packaging).
    """
    return (resources.files("armik_sym.compiled") / "c" / name).read_text(encoding="ascii")
