"""Type definitions in the hand-written C: found, renamed, taken out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping


def struct_members(source: str, name: str) -> str:
    """The lines between the braces of `struct name {…};` or `typedef struct {…} name;`.

    Args:
        source: C text, members indented, braces at the start of their lines.
        name: Name of the structure.

    Returns:
        The members, one or more per line.

    Raises:
        LookupError: If the text does not define it.

    Source:
        None (C99, 6.7.2.1).
    """
    return _struct(source, name).group("members")


def enumeration(source: str, constant: str) -> str:
    """The definition `enum {…};` in which a constant occurs.

    Args:
        source: C text.
        constant: One of the constants.

    Returns:
        The whole definition.

    Raises:
        LookupError: If the text does not define it.

    Source:
        None (C99, 6.7.2.2).
    """
    found = re.search(rf"(?m)^enum \{{[^}}]*\b{constant}\b[^}}]*\}};$", source)
    if found is None:
        raise LookupError(f"no enum with {constant}")
    return found.group()


def without_structs(source: str, names: Iterable[str], place: str) -> str:
    """The text with definitions of structures replaced by a remark.

    Args:
        source: C text.
        names: Structures to take out.
        place: Where they are defined instead.

    Returns:
        C text.

    Raises:
        LookupError: If the text does not define one of them.

    Source:
        None (text).
    """
    for name in names:
        found = _struct(source, name)
        source = f"{source[: found.start()]}/* {name}: see {place}. */\n{source[found.end() :]}"
    return source


def without_blocks(source: str, macro: str) -> str:
    """The text without its parts `#ifdef macro … #endif`.

    Args:
        source: C text; the parts hold no other conditions.
        macro: Name of the macro.

    Returns:
        C text.

    Source:
        None (C99, 6.10.1).
    """
    return re.sub(rf"(?ms)^#ifdef {macro}\n.*?^#endif\n", "", source)


def aligned(lines: str) -> str:
    """Lines with the comments behind them in one column.

    Args:
        lines: C text, one line or more.

    Returns:
        C text.

    Source:
        None (text).
    """
    parts = [line.partition(" /*") for line in lines.splitlines()]
    width = max(len(code.rstrip()) for code, mark, _ in parts if mark) if " /*" in lines else 0
    return "".join(f"{code.rstrip():<{width if mark else 0}}{mark}{rest}\n" for code, mark, rest in parts)


def renamed(source: str, names: Mapping[str, str]) -> str:
    """The text with identifiers replaced, in comments too.

    Args:
        source: C text.
        names: New names by old ones.

    Returns:
        C text.

    Source:
        None (text).
    """
    pattern = rf"\b({'|'.join(map(re.escape, names))})\b"
    return re.sub(pattern, lambda found: names[found.group()], source)


def _struct(source: str, name: str) -> re.Match[str]:
    members = r"(?P<members>(?:  .*\n)+)"
    for head, tail in (("typedef struct", f" {name}"), (f"struct {name}", "")):
        found = re.search(rf"(?m)^{head} \{{\n{members}\}}{tail};\n", source)
        if found is not None:
            return found
    raise LookupError(f"no struct {name}")
