"""A file that only grows: what is written to it survives the end of the program at any moment."""

from __future__ import annotations

import contextlib
import errno
import os
import threading
from pathlib import Path

from armik_sym.errors import MotionFileError

SYNC_EVERY = 1.0
"""Time between two requests to put the file on the disk itself, in [s]: what a power cut can cost."""

_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


class RecordFile:
    """A new file, written without any buffer in this program.

    What `append` was given is in the hands of the operating system when it returns: kill -9 cannot take it
    back. A thread of its own asks the system once a second to bring it to the disk, so that a slow disk
    keeps nobody from reading the port.

    Attributes:
        path: The file.
        size: Bytes written so far.

    Raises:
        MotionFileError: If the file exists, or cannot be created.

    Source:
        None (this package).
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.size = 0
        self._file = _create(self.path)
        self._synced = 0
        self._trouble: OSError | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._keep_syncing, name="armik record sync", daemon=True)
        self._thread.start()

    def append(self, data: bytes) -> None:
        """Write bytes at the end of the file.

        Args:
            data: The bytes.

        Raises:
            MotionFileError: If the disk is full or broken, or the file closed; what was written stays.

        Source:
            None (this package).
        """
        if self.closed:
            raise MotionFileError(f"{self.path}: is closed, nothing can be written any more")
        left = memoryview(data)
        try:
            if self._trouble is not None:
                raise self._trouble
            while left:
                written = os.write(self._file, left)
                self.size += written
                left = left[written:]
        except OSError as error:
            raise MotionFileError(_cannot_go_on(self.path, self.size, error)) from error

    def close(self) -> None:
        """Bring everything to the disk and close the file; a second time, nothing happens."""
        if self._closing.is_set():
            return
        self._closing.set()
        self._thread.join()
        with contextlib.suppress(OSError):
            os.fsync(self._file)
        os.close(self._file)

    @property
    def closed(self) -> bool:
        """Whether nothing can be written any more."""
        return self._closing.is_set()

    def discard(self) -> None:
        """Close and delete the file, because nothing was recorded."""
        self.close()
        self.path.unlink(missing_ok=True)

    def _keep_syncing(self) -> None:
        _sync_folder(self.path.parent)
        while not self._closing.wait(SYNC_EVERY):
            if self.size == self._synced:
                continue
            self._synced = self.size
            try:
                os.fsync(self._file)
            except OSError as error:
                # Devices that are no disk, such as /dev/full, know no such thing.
                if error.errno not in (errno.EINVAL, errno.ENOTSUP):
                    self._trouble = error
                    return


def _create(path: Path) -> int:
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)
    try:
        handle = os.open(path, flags, 0o644)
    except FileExistsError:
        raise MotionFileError(
            f"{path}: exists already, and a recording never overwrites: choose another name"
        ) from None
    except FileNotFoundError:
        raise MotionFileError(
            f"{path}: folder {path.parent} does not exist: create it, or choose another"
        ) from None
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be created: {error.strerror or error}") from None
    return handle


def _sync_folder(folder: Path) -> None:
    """Bring the name of a new file to the disk, where the system knows how."""
    if os.name != "posix":
        return
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _cannot_go_on(path: Path, size: int, error: OSError) -> str:
    kept = f"the {size:,} bytes written so far are kept and can be read"
    if error.errno in _FULL:
        return (
            f"{path}: the disk is full, or a limit is reached ({error.strerror}); recording stopped, {kept}: "
            "make room, or record to another disk"
        )
    return f"{path}: cannot be written any more ({error.strerror or error}); recording stopped, {kept}"
