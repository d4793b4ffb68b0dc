"""A real browser for the tests of the report; without one they are skipped, saying what is missing."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# A browser in a container has no user namespaces for its own sandbox, and little shared memory; WebGL is
# computed by the processor.
_ARGUMENTS = ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"]


class Watched:
    """An open page, and everything it complained about or asked the world for."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.complaints: list[str] = []
        self.requests: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))

    def _console(self, message: Any) -> None:
        # Hints of the graphics driver about speed come as warnings.
        if message.type == "error":
            self.complaints.append(f"{message.type}: {message.text}")

    def open(self, file: Path) -> None:
        self.page.goto(file.as_uri())
        self.until("window.armik !== undefined")
        self.page.evaluate("armik.ready()")

    def until(self, condition: str, seconds: float = 180.0) -> None:
        """Wait; asked from outside, because the policy of the page lets nobody evaluate text inside."""
        end = time.monotonic() + seconds
        while not self.page.evaluate(condition):
            assert time.monotonic() < end, f"still not so: {condition}"
            self.page.wait_for_timeout(50)

    def state(self) -> Any:
        return self.page.evaluate("armik.state()")

    def wrist(self) -> Any:
        return self.page.evaluate("armik.wrist()")


@contextmanager
def browser() -> Iterator[Any]:
    """A headless browser; one at a time in a process."""
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="playwright is missing: pip install playwright"
    )
    program = next((found for name in _NAMES if (found := shutil.which(name))), None)
    if program is None:
        pytest.skip("no Chromium found: apt-get install chromium")
    with playwright.sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=program, args=_ARGUMENTS, timeout=180_000)
        try:
            yield started
        finally:
            started.close()


def new_page(started: Any, file: Path) -> Watched:
    """A report in a new window, all of it drawn."""
    page = started.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(180_000)  # all tests at once on a small machine
    watched = Watched(page)
    watched.open(file)
    return watched
