"""The C of the protocol and an example of a sending device, written out for a microcontroller's project."""

from __future__ import annotations

import os
from importlib import resources
from pathlib import Path

from armik_sym.errors import OptionError

FRAME_FILES = ("armik_frame.h", "armik_frame.c")
EXAMPLE_FILES = ("firmware.h", "firmware.c", "board.h", "board_host.c")


def firmware_text(name: str) -> str:
    """One of the C files of the protocol or its example.

    Args:
        name: File name.

    Returns:
        C source text.

    Source:
        None (packaging).
    """
    folder = resources.files("armik_sym.device.protocol") / "c"
    return (folder / name if name in FRAME_FILES else folder / "example" / name).read_text(encoding="ascii")


def write_firmware(out_dir: str | os.PathLike[str]) -> Path:
    """Write the frame code and the firmware example in C99 into a folder.

    The folder gets `armik_frame.h` and `.c` (encoder and parser), `firmware.h` and `.c` (the main loop),
    `board.h` (the five functions it needs of a microcontroller) and `board_host.c` (these functions on a
    computer). To build it there: `cc -std=c99 *.c -o board`; `./board 10` writes ten seconds of bytes.

    Args:
        out_dir: The folder, created if need be.

    Returns:
        The folder.

    Raises:
        OptionError: If the folder cannot be written to, or holds another file under one of the names.

    Source:
        None (this package); docs/device_protocol.md.
    """
    folder = Path(out_dir)
    texts = {folder / name: firmware_text(name) for name in (*FRAME_FILES, *EXAMPLE_FILES)}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file, text in texts.items():
            if file.exists() and file.read_bytes() != text.encode("ascii"):
                raise OptionError(
                    f"{file} was changed, or is of other origin: move it, or name another folder"
                )
        for file, text in texts.items():
            file.write_bytes(text.encode("ascii"))
    except OSError as error:
        raise OptionError(f"cannot write the firmware to {folder}: {error}") from None
    return folder
