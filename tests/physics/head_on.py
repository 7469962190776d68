"""Meetings of a pair head on, by the marks that they get."""

from __future__ import annotations

import nonsmooth as ns
from tests.benchmarks.head_on.meeting import Meeting, drawn, meet
from tests.benchmarks.head_on.pairs import PAIRS

SEED, COUNT = 1, 12
"""Fixed draw of the tests."""
FINE = ns.EventDriven(impact_tolerance=1e-11)
"""Engine with which speeds are exact to 1e-9."""


def wrong(meetings: list[Meeting], **options: object) -> list[str]:
    """Return the meetings that are not right, each with its mark and the reason."""
    found = ((meeting, meet(meeting, **options)) for meeting in meetings)  # type: ignore[arg-type]
    return [f"{verdict.mark} {meeting}: {verdict.reason}" for meeting, verdict in found if verdict.mark != "."]


def drawn_of(name: str) -> list[Meeting]:
    """Return the fixed draw of a pair."""
    return [drawn(name, number, SEED) for number in range(COUNT)]


def central_of(name: str) -> list[Meeting]:
    """Return central meetings of a pair along each of its axes, in line and turned."""
    return [Meeting(name, axis, turn=turn) for axis in PAIRS[name].central for turn in (0.0, 1e-9, 1e-3, 0.3)]
