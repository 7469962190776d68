"""What differs between the results of two sides, and which components the differing systems share."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

Results = dict[str, dict[str, Any]]
_CUT_OFF = "cut off"
"""How a run ended, by the adapter, that took longer than its limit."""
_ROWS = 8
"""Components that the table names."""
_HASHES = ("q", "times", "impulses")


def unfinished(this: Results, other: Results) -> list[str]:
    """Return the names of the systems that the limit of time cut off on a side; they are not compared."""
    return [name for name in this if _CUT_OFF in (this[name]["end"], other[name]["end"])]


def compared(this: Results, other: Results) -> list[str]:
    """Return the names of the systems that are compared."""
    left_out = set(unfinished(this, other))
    return [name for name in this if name not in left_out]


def difference(this: dict[str, Any], other: dict[str, Any]) -> str:
    """Return what differs between two results of a system, "" if nothing does."""
    words = [name for name in _HASHES if this[name] != other[name]]
    if this["end"] != other["end"]:
        words.append(f"end: {_short(other['end'])} → {_short(this['end'])}")
    return ", ".join(words)


def differing(this: Results, other: Results) -> dict[str, str]:
    """Return what differs, by the names of the systems that do."""
    rows = {name: difference(this[name], other[name]) for name in compared(this, other)}
    return {name: what for name, what in rows.items() if what}


def by_component(this: Results, other: Results) -> list[tuple[str, int, int]]:
    """Return of every component of a differing system how many systems have it and how many of them differ.

    The first is the component whose systems are most nearly those that differ, by the coefficient of Dice: twice the
    number of systems in both sets over the sum of the numbers in either.
    """
    different = differing(this, other)
    used = Counter(one for name in compared(this, other) for one in _components(this[name], other[name]))
    met = Counter(one for name in different for one in _components(this[name], other[name]))
    rows = [(one, used[one], n) for one, n in met.items()]
    return sorted(rows, key=lambda row: (-row[2] / (row[1] + len(different)), row[0]))


def table(this: Results, other: Results) -> Iterator[str]:
    """Yield the lines of the tables in Markdown."""
    names, different = compared(this, other), differing(this, other)
    if not different:
        yield f"all {len(names)} equal"
    else:
        yield f"{len(different)} of {len(names)} differ"
        yield from ("", "| system | differs in | components |", "|---|---|---|")
        for name, what in different.items():
            yield f"| {name} | {what} | {', '.join(_components(this[name], other[name]))} |"
        yield from ("", "| component of a system that differs | systems with it | of these differ |", "|---|---|---|")
        for one, n, n_different in by_component(this, other)[:_ROWS]:
            yield f"| {one} | {n} | {n_different} |"
    if left_out := unfinished(this, other):
        yield from ("", f"Not compared, as they did not end in time: {', '.join(left_out)}")


def _components(this: dict[str, Any], other: dict[str, Any]) -> list[str]:
    found: list[str] = this["components"] or other["components"]
    return found


def _short(text: str) -> str:
    words = " ".join(text.replace("|", "/").split())
    return words if len(words) <= 120 else words[:119] + "…"
