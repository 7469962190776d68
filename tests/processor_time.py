"""Processor time of each test, with the list of those that are too long for the fast tier."""

from __future__ import annotations

import os
from collections.abc import Generator
from typing import final

import pytest

LONG = 1.0
"""Processor time [s] from which a run names a test: a hundred such tests take a minute of two cores."""
_NAME = "processor_time"


@final
class ProcessorTimes:
    """Measures tests and lists the long ones at the end of a run.

    Processor time, that of ended child processes included, depends less on what else the machine does than wall time.
    The process that runs a test measures it, and its report carries the number to the process that prints.
    """

    def __init__(self) -> None:
        self._began = 0.0
        self._long: dict[str, float] = {}

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self) -> Generator[None, object, object]:
        """Note the time before the fixtures of a test are made."""
        self._began = _used()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Write the time since then into each report of the test."""
        report = yield
        report.user_properties.append((_NAME, _used() - self._began))
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the time at which the fixtures of a long test were taken down."""
        for name, seconds in report.user_properties if report.when == "teardown" else ():
            if name == _NAME and isinstance(seconds, float) and seconds > LONG:
                self._long[report.nodeid] = seconds

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the long tests, the longest first."""
        if self._long:
            terminalreporter.section(f"tests over {LONG:g} s of processor time")
            for test, seconds in sorted(self._long.items(), key=lambda row: -row[1]):
                terminalreporter.write_line(f"{seconds:6.1f} s  {test}")


def _used() -> float:
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
