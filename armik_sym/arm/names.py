"""Names that may travel into generated C: plain identifiers and nothing else."""

from __future__ import annotations

import re

from armik_sym.errors import ArmModelError

_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}\Z", re.ASCII)

_C_KEYWORDS = frozenset(
    "auto break case char const continue default do double else enum extern float for goto if inline int "
    "long register restrict return short signed sizeof static struct switch typedef union unsigned void "
    "volatile while".split()
)


def check_identifier(name: object, what: str) -> str:
    r"""Return `name` unchanged if it is a plain identifier, refuse it otherwise.

    A plain identifier matches `[A-Za-z][A-Za-z0-9_]{0,62}` and is no C keyword, so it can stand in
    a C source, a file name and a table header without any quoting.

    Args:
        name: The name to check.
        what: What the name is for, used in the message ("joint", "arm", "segment length").

    Returns:
        The same name, as a `str`.

    Raises:
        ArmModelError: If `name` is no plain identifier.

    Source:
        None (C99, 6.4.1 and 6.4.2, with the first 63 characters significant).
    """
    if not isinstance(name, str) or not _IDENTIFIER.match(name) or name in _C_KEYWORDS:
        raise ArmModelError(
            f"{what} name {name!r} is not a plain identifier: use 1 to 63 ASCII letters, digits and "
            "underscores, starting with a letter, and no C keyword (for example 'elbow_flexion')"
        )
    return name
