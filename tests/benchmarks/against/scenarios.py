"""The scenarios of both sides, and how much of each is run."""

from __future__ import annotations

from typing import Any

from tests.benchmarks.against.sides import Side

_GROUP = "nonsmooth.scenarios"
_PART = 0.6
"""Part of a scenario's time that is run."""
_PARTS = {"ball_box": 0.1, "dice_throw": 0.3, "dominoes": 0.4, "polyhedron_stack": 0.3, "slider_crank": 0.1}
"""The same for those that are slow."""


def names(side: Side) -> set[str]:
    """Return the names of the scenarios of a side, read from its project file."""
    return set(side.project["entry-points"][_GROUP])


def tasks(sides: tuple[Side, Side]) -> dict[str, dict[str, Any]]:
    """Return the tasks of the scenarios that both sides have, by name."""
    common = sorted(names(sides[0]) & names(sides[1]))
    return {name: {"scenario": name, "parameters": {}, "part": _PARTS.get(name, _PART)} for name in common}


def only_one(sides: tuple[Side, Side]) -> list[str]:
    """Return the names of the scenarios that only one side has."""
    return sorted(names(sides[0]) ^ names(sides[1]))
