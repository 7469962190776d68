"""Checks of what stands in a table."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

from nonsmooth.errors import InvalidInput, UnknownName


def check_keys(thing: str, table: Any, known: Collection[str], required: Sequence[str] = ()) -> None:
    """Raise InvalidInput unless it is a table with all required and no unknown keys."""
    if not isinstance(table, dict):
        raise InvalidInput(thing, "must be a table", table, f"Its keys are {', '.join(known)}.")
    for key in table:
        if key not in known:
            raise UnknownName(f"{thing}: key", key, known)
    for key in required:
        if key not in table:
            raise InvalidInput(f"{thing}: {key}", "must be given", None, "Add it; the page on scenario files has all.")


def tables_in(thing: str, value: Any) -> list[dict[str, Any]]:
    """Return an array of tables; raise InvalidInput if it is none."""
    if not (isinstance(value, list) and all(isinstance(one, dict) for one in value)):
        raise InvalidInput(
            thing, "must be an array of tables", value, f"Write [[{thing.rpartition(' ')[2]}]] above each."
        )
    return value


def number(thing: str, value: Any, unit: str, positive: bool = False) -> float:
    """Return a finite number; raise InvalidInput if it is none, or not positive where it must be."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InvalidInput(thing, "must be a finite number", value, f"Give it in [{unit}].")
    if positive and value <= 0.0:
        raise InvalidInput(thing, "must be positive", value, f"Give it in [{unit}].")
    return float(value)


def words(thing: str, value: Any, n: int | None = None) -> list[str]:
    """Return a list of words, of n where that is given; raise InvalidInput if it is none."""
    right = isinstance(value, list) and all(isinstance(one, str) for one in value)
    if not right or (n is not None and len(value) != n):
        count = "" if n is None else f"{n} "
        raise InvalidInput(thing, f"must be a list of {count}names", value, 'For example ["ball", "floor"].')
    return list(value)
