"""The two tiers: which cases of a test with many are in the fast one."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import pytest

FAST = "not slow"
"""Expression of marks by which pyproject.toml chooses the fast tier."""


def choose(config: pytest.Config) -> None:
    """Run a test that is named by its id, whatever its tier."""
    if config.option.markexpr == FAST and any("::" in name for name in config.args):
        config.option.markexpr = ""


def mark_cases(items: list[pytest.Item]) -> None:
    """Mark the cases of a test with ``fast_cases(n)`` as slow, except for n of them.

    The n cases are spread evenly over the list, so that each of several parameters takes several values.
    """
    cases: dict[tuple[Any, ...], list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("fast_cases") is not None:
            cases[item.path, item.nodeid.partition("[")[0]].append(item)
    for same in cases.values():
        marker = same[0].get_closest_marker("fast_cases")
        assert marker is not None
        (count,) = marker.args
        fast = {round((k + 0.5) * len(same) / count - 0.5) for k in range(count)}
        for index, item in enumerate(same):
            if index not in fast:
                item.add_marker(pytest.mark.slow)
