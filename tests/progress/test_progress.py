"""When progress is shown, what is said of the rest, and what stays of it."""

from __future__ import annotations

import io
import sys
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from nonsmooth.progress import (
    Bar,
    Display,
    Lines,
    ProgressMeter,
    Quiet,
    RangeCovered,
    RunsDone,
    SameLine,
    TimeReached,
    of_long_run,
    on_standard_error,
)


class _Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def _shown(display: Display, seconds: float) -> None:
    """Run ten simulated seconds in so many seconds of wall time, reported a hundred times."""
    clock = _Clock()
    with ProgressMeter(display, clock) as pace:
        progress = TimeReached(pace)
        for i in range(1, 101):
            clock.now = seconds * i / 100
            progress(0.1 * i, 10.0, 3 * i)


@pytest.mark.parametrize("kind", [Lines, Bar])
def test_a_short_run_says_nothing(kind: type[Lines] | type[Bar]) -> None:
    stream = _Terminal()
    _shown(kind(stream), 0.9)
    assert stream.getvalue() == ""


@pytest.mark.parametrize("kind", [Bar, SameLine])
def test_a_display_waits_as_long_as_it_is_told(kind: type[Bar] | type[SameLine]) -> None:
    stream = _Terminal()
    _shown(kind(stream, 3.0), 2.9)
    assert stream.getvalue() == ""
    _shown(kind(stream, 3.0), 6.0)
    assert "t = " in stream.getvalue()


def test_the_line_of_a_notebook_is_erased() -> None:
    stream = io.StringIO()
    _shown(SameLine(stream, 1.0), 6.0)
    *shown, blank, end = stream.getvalue().split("\r")
    assert len(shown) > 5
    assert all(one.startswith("t = ") for one in shown[1:])
    assert (blank.strip(), end) == ("", "")


def test_a_long_run_is_shown_only_where_a_person_sees_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", io.StringIO())
    assert of_long_run() is None
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=1)))
    assert isinstance(of_long_run(), SameLine)
    monkeypatch.setattr("sys.stderr", _Terminal())
    assert isinstance(of_long_run(), Bar)
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(of_long_run).result() is None
    monkeypatch.setattr("sys.stderr", None)
    assert of_long_run() is None


def test_a_quiet_display_shows_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    _shown(Quiet(), 1e6)
    assert capsys.readouterr() == ("", "")


def test_lines_are_few_and_whole() -> None:
    stream = io.StringIO()
    _shown(Lines(stream), 30.0)
    lines = stream.getvalue().splitlines()
    assert len(lines) == 3
    assert lines[0] == "t = 0.8 of 10 s (8%, 24 events, about 28 s to go)"


@pytest.mark.slow
def test_a_terminal_has_one_line_that_is_gone_in_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """With all that the bar tells; what is printed meanwhile stands above it."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    stream = _Terminal()
    _shown(Bar(stream), 30.0)
    written = stream.getvalue()
    assert 50 < written.count("t = ") <= 101
    for word in ("t = 5 of 10 s", "━", "50%, 150 events, about 15 s to go"):
        assert word in written
    assert written.endswith("\x1b[2K")


def test_what_came_before_the_run_does_not_count() -> None:
    """The engine may have been compiled for half a minute."""
    clock, stream = _Clock(), io.StringIO()
    progress = TimeReached(ProgressMeter(Lines(stream), clock))
    clock.now = 30.0
    progress(1.0, 10.0)
    assert stream.getvalue() == ""
    clock.now = 41.0
    progress(2.0, 10.0)
    assert stream.getvalue() == "t = 2 of 10 s (20%, about 88 s to go)\n"


def test_the_next_of_several_runs_is_estimated_by_itself() -> None:
    clock, stream = _Clock(), io.StringIO()
    progress = TimeReached(ProgressMeter(Lines(stream), clock))
    for now, t in ((0.0, 1.0), (100.0, 10.0), (101.0, 0.1), (111.0, 5.0)):
        clock.now = now
        progress(t, 10.0)
    assert stream.getvalue().splitlines()[-1] == "t = 5 of 10 s (50%, about 10 s to go)"


def test_runs_have_a_rate_that_leaves_out_those_done_before() -> None:
    clock, stream = _Clock(), io.StringIO()
    counted = RunsDone(ProgressMeter(Lines(stream), clock), 1000, 100)
    for _ in range(4):
        clock.now += 20.0
        counted.add(100, 1)
    assert stream.getvalue().splitlines()[-1] == "500 of 1000 runs (50%, 4 failed, 5 per s, about 100 s to go)"


def test_the_last_of_all_runs_leaves_no_time() -> None:
    clock, stream = _Clock(), io.StringIO()
    counted = RunsDone(ProgressMeter(Lines(stream), clock), 5)
    clock.now = 4.0
    counted.add(5, 5)
    assert stream.getvalue() == "5 of 5 runs (100%, 5 failed, 1.25 per s, about 0 s to go)\n"


def test_orbits_cover_a_range_both_ways() -> None:
    """Behind a fold, where the parameter turns back, no more of the range is covered."""
    clock, stream = _Clock(), io.StringIO()
    covered = RangeCovered(ProgressMeter(Lines(stream), clock), "gamma", 2.0, (1.0, 5.0))
    for value in (1.5, 1.0, 2.5, 3.0, 2.8):
        clock.now += 20.0
        covered.add(value)
    assert stream.getvalue().splitlines() == [
        "orbit 1, gamma = 1.5 (12%, 0.05 per s, about 140 s to go)",
        "orbit 2, gamma = 1 (25%, 0.05 per s, about 120 s to go)",
        "orbit 3, gamma = 2.5 (38%, 0.05 per s, about 100 s to go)",
        "orbit 4, gamma = 3 (50%, 0.05 per s, about 80 s to go)",
        "orbit 5, gamma = 2.8 (50%, 0.05 per s, about 100 s to go)",
    ]


def test_a_stream_that_takes_nothing_does_not_stop_the_run() -> None:
    class Full(io.StringIO):
        def flush(self) -> None:
            raise BrokenPipeError

    stream = Full()
    _shown(Lines(stream), 30.0)
    assert stream.getvalue().startswith("t = 0.8 of 10 s")


def test_without_standard_error_nothing_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", None)
    _shown(on_standard_error(), 30.0)
