"""Running the tests of the swivel angle once with compiled loops and once without."""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator
from unittest import mock

_CALLERS = ("evaluate", "closed_form", "intervals", "blocking", "postures_at")


@contextlib.contextmanager
def swivel_backend(backend: str) -> Iterator[None]:
    """With "vm", `backend="auto"` finds no library."""
    if backend != "vm":
        yield
        return
    with contextlib.ExitStack() as stack:
        for name in _CALLERS:
            module = importlib.import_module(f"armik_sym.swivel.{name}")
            stack.enter_context(mock.patch.object(module, "swivel_library", return_value=None))
        yield
