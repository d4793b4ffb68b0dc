"""Options that do not go with what a file holds, and options that are numbers or words."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from armik_sym.errors import OptionError


def only(what: str, typed: Mapping[str, object], allowed: Collection[str] = ()) -> None:
    """Refuse options that do not go with something.

    Args:
        what: What they would have to go with, in words.
        typed: Options by their name on the command line, None where they were not given.
        allowed: Names of those that go with it.

    Raises:
        OptionError: If another one is given.

    Source:
        None (command line).
    """
    wrong = [name for name, value in typed.items() if value is not None and name not in allowed]
    if wrong:
        raise OptionError(f"{wrong[0]} does not go with {what}")


def number_or_word(text: str | None) -> str | float | None:
    """A number where one was typed, else the word.

    Args:
        text: What was typed, or None.

    Returns:
        The number, the word, or None.

    Source:
        None (command line).
    """
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        return text
