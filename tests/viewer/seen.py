"""A page in a browser."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

READY = "document.documentElement.dataset.ready === 'yes'"
_PATIENCE, _PAUSE = 30.0, 10.0
"""How long something may take [s], and how often it is looked for [ms]."""


def wait_until(page: Any, condition: str) -> None:
    """Wait until a condition holds in a page or frame.

    ``wait_for_function`` makes a function of words in the page, which forbids that, wherever the condition does not
    hold at once.
    """
    end = time.monotonic() + _PATIENCE
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        page.wait_for_timeout(_PAUSE)


class Seen:
    """A page, what it asked for, and what its console said; it waits to be played, as who wants no motion has it."""

    def __init__(self, browser: Any, path: Path, **words: Any) -> None:
        given = {"viewport": {"width": 1100, "height": 750}, "reduced_motion": "reduce"} | words
        self.page = browser.new_page(**given)
        self.requests: list[str] = []
        self.errors: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", lambda message: self.errors.append(message.text) if message.type == "error" else None)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.goto(path.as_uri())
        wait_until(self.page, READY)

    def __call__(self, script: str) -> Any:
        """Return what a script gives."""
        return self.page.evaluate(script)
