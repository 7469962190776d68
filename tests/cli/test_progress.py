"""When progress is written, and what stays of it."""

from __future__ import annotations

import io

import pytest

from nonsmooth.cli.progress import LINES, TERMINAL, Progress, Style, on_standard_error


class _Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def _written(style: Style, seconds: float) -> str:
    """Run of ten simulated seconds in so many seconds of wall time, reported a hundred times."""
    clock, stream = _Clock(), io.StringIO()
    progress = Progress(stream, style, clock)
    for i in range(1, 101):
        clock.now = seconds * i / 100
        progress(0.1 * i, 10.0)
    progress.finish()
    return stream.getvalue()


@pytest.mark.parametrize("style", [LINES, TERMINAL])
def test_a_short_run_says_nothing(style: Style) -> None:
    assert _written(style, 0.9) == ""


def test_lines_are_few_and_whole() -> None:
    lines = _written(LINES, 30.0).splitlines()
    assert len(lines) == 3
    assert lines[0] == "t = 0.7 of 10 s (7%), about 28 s to go"


def test_a_terminal_has_one_line_that_is_gone_in_the_end() -> None:
    written = _written(TERMINAL, 30.0)
    assert "\n" not in written
    assert 50 < written.count("t = ") <= 101
    assert written.endswith("\r\x1b[K")


def test_what_came_before_the_run_is_not_in_the_estimate() -> None:
    """The engine may have been compiled for half a minute."""
    clock, stream = _Clock(), io.StringIO()
    progress = Progress(stream, LINES, clock)
    clock.now = 30.0
    progress(1.0, 10.0)
    clock.now = 41.0
    progress(2.0, 10.0)
    assert stream.getvalue().splitlines() == ["t = 1 of 10 s (10%)", "t = 2 of 10 s (20%), about 88 s to go"]


def test_the_next_of_several_runs_is_estimated_by_itself() -> None:
    clock, stream = _Clock(), io.StringIO()
    progress = Progress(stream, LINES, clock)
    clock.now = 100.0
    progress(10.0, 10.0)
    clock.now = 101.0
    progress(0.1, 10.0)
    clock.now = 111.0
    progress(5.0, 10.0)
    assert stream.getvalue().splitlines()[-1] == "t = 5 of 10 s (50%), about 10 s to go"


def test_a_stream_that_takes_nothing_does_not_stop_the_run() -> None:
    class Full(io.StringIO):
        def flush(self) -> None:
            raise BrokenPipeError

    clock, stream = _Clock(), Full()
    progress = Progress(stream, LINES, clock)
    clock.now = 100.0
    progress(1.0, 10.0)
    progress.finish()
    assert stream.getvalue().startswith("t = 1 of 10 s")


def test_without_standard_error_nothing_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", None)
    progress = on_standard_error()
    progress(1.0, 10.0)
    progress.finish()
