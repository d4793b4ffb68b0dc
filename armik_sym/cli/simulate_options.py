"""Options of `armik simulate-device` in words: where, what goes wrong and when."""

from __future__ import annotations

from typing import TYPE_CHECKING

from armik_sym.errors import OptionError

if TYPE_CHECKING:
    from armik_sym.device.simulator import Jump, Silence, Stuck


def socket_address(text: str) -> tuple[str, int]:
    """An address typed as HOST:PORT.

    Args:
        text: What was typed.

    Returns:
        Host and number of the port.

    Raises:
        OptionError: If it is not of that form.

    Source:
        None (command line).
    """
    host, colon, number = text.removeprefix("socket://").rpartition(":")
    if not colon or not host or not number.isdecimal() or int(number) > 0xFFFF:
        raise OptionError(
            f"--socket {text!r}: expected HOST:PORT, for example 127.0.0.1:4400; port 0: any free"
        )
    return host.strip("[]"), int(number)


def times(name: str, text: str | None) -> tuple[float, ...]:
    """Times typed with commas between them.

    Args:
        name: Name of the option.
        text: What was typed, or None.

    Returns:
        The times, in [s].

    Raises:
        OptionError: If one is no number.

    Source:
        None (command line).
    """
    return () if text is None else tuple(_numbers(name, text, ",", "times in seconds, such as 5,12.5"))


def silences(typed: list[str] | None) -> tuple[Silence, ...]:
    """Spans of time typed as FROM or FROM:TO.

    Args:
        typed: What was typed.

    Returns:
        The spans.

    Raises:
        OptionError: If one is not of that form.

    Source:
        None (command line).
    """
    from armik_sym.device.simulator import Silence

    found = []
    for text in typed or []:
        numbers = _numbers("--silent", text, ":", "FROM or FROM:TO in seconds, such as 5:7", (1, 2))
        found.append(Silence(*numbers))
    return tuple(found)


def stuck_channels(typed: list[str] | None) -> tuple[Stuck, ...]:
    """Stuck channels typed as CHANNEL:FROM or CHANNEL:FROM:TO.

    Args:
        typed: What was typed.

    Returns:
        The faults.

    Raises:
        OptionError: If one is not of that form.

    Source:
        None (command line).
    """
    from armik_sym.device.simulator import Stuck

    form = "CHANNEL:FROM or CHANNEL:FROM:TO, such as 2:5:7"
    found = []
    for text in typed or []:
        channel, *span = _numbers("--stuck", text, ":", form, (2, 3))
        found.append(Stuck(_whole("--stuck", text, channel, form), *span))
    return tuple(found)


def jumps(typed: list[str] | None) -> tuple[Jump, ...]:
    """Jumps typed as CHANNEL:AT:COUNTS.

    Args:
        typed: What was typed.

    Returns:
        The faults.

    Raises:
        OptionError: If one is not of that form.

    Source:
        None (command line).
    """
    from armik_sym.device.simulator import Jump

    form = "CHANNEL:AT:COUNTS, such as 2:5:-300"
    found = []
    for text in typed or []:
        channel, at, counts = _numbers("--jump", text, ":", form, (3, 3))
        found.append(Jump(_whole("--jump", text, channel, form), at, _whole("--jump", text, counts, form)))
    return tuple(found)


def _numbers(
    name: str, text: str, between: str, form: str, how_many: tuple[int, int] | None = None
) -> list[float]:
    try:
        found = [float(part) for part in text.split(between)]
    except ValueError:
        raise OptionError(f"{name} {text!r}: expected {form}") from None
    if how_many is not None and not how_many[0] <= len(found) <= how_many[1]:
        raise OptionError(f"{name} {text!r}: expected {form}")
    return found


def _whole(name: str, text: str, value: float, form: str) -> int:
    if not value.is_integer():
        raise OptionError(f"{name} {text!r}: {value:g} is no whole number; expected {form}")
    return int(value)
