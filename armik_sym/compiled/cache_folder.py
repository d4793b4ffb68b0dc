"""The per-user folder in which compiled code is kept."""

from __future__ import annotations

import functools
import os
import stat
import tempfile
import warnings
from pathlib import Path

import platformdirs

from armik_sym.errors import CacheWarning

ENVIRONMENT_VARIABLE = "ARMIK_CACHE_DIR"


def cache_folder() -> Path:
    """The private folder for compiled code: created with mode 0700, owned by this user.

    `$ARMIK_CACHE_DIR`, else the platform's per-user cache. Code is loaded from here, so a folder that
    others own or may write to is never used; a temporary private one serves this process instead.

    Returns:
        The folder; it exists.

    Source:
        None (XDG base directory specification, through platformdirs).
    """
    chosen = os.environ.get(ENVIRONMENT_VARIABLE)
    wanted = (
        Path(chosen).expanduser()
        if chosen
        else Path(platformdirs.user_cache_dir("armik_sym", appauthor=False))
    )
    problem = _prepare(wanted)
    if problem is None:
        return wanted
    return temporary_folder(f"{wanted} {problem}")


def _prepare(folder: Path) -> str | None:
    """Create the folder if need be; say what is wrong with it, or nothing."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        info = folder.stat()
    except OSError as error:
        return f"cannot be created ({error.strerror})"
    if hasattr(os, "getuid"):
        if info.st_uid != os.getuid():
            return "belongs to another user"
        if info.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
            return "can be written by other users (chmod 700 mends it)"
    if not os.access(folder, os.W_OK | os.X_OK):
        return "is read-only"
    return None


@functools.cache
def temporary_folder(problem: str) -> Path:
    """A private folder that lives as long as this process, with one warning that says why.

    Args:
        problem: What is wrong with the cache folder.

    Returns:
        The folder; it exists.

    Source:
        None (packaging).
    """
    warnings.warn(
        f"the cache folder {problem}; compiled code is kept in a temporary folder for this process only. "
        f"Set {ENVIRONMENT_VARIABLE} to a private writable folder to keep it.",
        CacheWarning,
        stacklevel=4,
    )
    holder = tempfile.TemporaryDirectory(prefix="armik_sym_", ignore_cleanup_errors=True)
    _HOLDERS.append(holder)
    return Path(holder.name)


# Keeps temporary folders alive until the interpreter ends.
_HOLDERS: list[tempfile.TemporaryDirectory[str]] = []
