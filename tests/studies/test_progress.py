"""What is shown of a study while it runs."""

from __future__ import annotations

import io

import pytest

from nonsmooth.studies.progress import Bar, Lines, Progress


class _Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("kind", [Lines, Bar])
def test_rate_time_left_and_failures(kind: type[Lines] | type[Bar], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    stream, clock = _Terminal(), _Clock()
    progress = Progress(kind(stream), 1000, 100, clock)
    for _ in range(4):
        clock.now += 10.0
        progress.add(100, 1)
    progress.finish()
    assert "500 of 1000 runs, 10 per s, about 50 s to go, 4 failed" in stream.getvalue()


def test_a_short_study_says_nothing() -> None:
    stream, clock = io.StringIO(), _Clock()
    progress = Progress(Lines(stream), 10, 0, clock)
    for _ in range(10):
        clock.now += 0.1
        progress.add(1, 0)
    assert stream.getvalue() == ""
