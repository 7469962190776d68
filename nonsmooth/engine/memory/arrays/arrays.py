"""Arrays: what one layer of the engine, or an engine of one's own, works with, and functions that give lengths."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias, final

from nonsmooth.engine.memory.layout import MOST_BLOCKS, MOST_ENTRIES

Counts: TypeAlias = Mapping[str, int]
Size: TypeAlias = Callable[[Counts], int]


@final
@dataclass(frozen=True, eq=False)
class Arrays:
    """The scalars and the arrays of a layer: the length of each array as a function of the counts of a system.

    Attributes
    ----------
    floats, integers : dict
        Those in which a step may find what one before it left.
    later_floats, later_integers : dict
        Output, and room for the worst case, mostly unused: they come last, and cost no memory before they are written.
    scalars : dict
        What each scalar is before any run; a whole number stays one, a float is a float.
    """

    floats: dict[str, Size] = field(default_factory=dict)
    integers: dict[str, Size] = field(default_factory=dict)
    later_floats: dict[str, Size] = field(default_factory=dict)
    later_integers: dict[str, Size] = field(default_factory=dict)
    scalars: dict[str, float] = field(default_factory=dict)


def whole(*names: str) -> dict[str, float]:
    """Return scalars that are whole numbers, 0 before any run."""
    return dict.fromkeys(names, 0)


def real(*names: str) -> dict[str, float]:
    """Return scalars that are floats, 0 before any run."""
    return dict.fromkeys(names, 0.0)


def per(stride: int, count: str) -> Size:
    """Return a length of so many for each of what is counted."""
    return lambda n: stride * n[count]


def fixed(length: int) -> Size:
    """Return a length that is the same in all systems."""
    return lambda n: length


def entries(n: Counts) -> int:
    """Return the length of a matrix of all unknowns of the contacts."""
    return int(min((3 * n["n_slots"]) ** 2, MOST_ENTRIES))


def blocks(n: Counts) -> int:
    """Return how many pairs of contacts may act on one another."""
    return int(min(n["n_slots"] ** 2, MOST_BLOCKS))


def guards(n: Counts) -> int:
    """Return the number of guards: three for each contact, and those of the system."""
    return 3 * n["n_slots"] + n["n_own_guards"]


def ends(count: str) -> Size:
    """Return the length of a list of starts, with the end behind the last."""
    return lambda n: n[count] + 1
