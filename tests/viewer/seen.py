"""A page in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

READY = "document.documentElement.dataset.ready === 'yes'"


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
        self.page.wait_for_function(READY)

    def __call__(self, script: str) -> Any:
        """Return what a script gives."""
        return self.page.evaluate(script)
