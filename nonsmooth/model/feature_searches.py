"""Pools of contacts whose features are searched for, laid into the engine's memory."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from nonsmooth.binding import interpreted
from nonsmooth.binding.bounds import try_out
from nonsmooth.binding.compile import bind, parameter_place
from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.memory import Heap, Memory
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CandidateSearch
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.parameters import Table
from nonsmooth.system.contact import Contact


@dataclass(frozen=True)
class FeatureSearch:
    """Contacts of two frames that one search fills.

    Attributes
    ----------
    search : CandidateSearch
        The search.
    contacts : range
        Their numbers.
    owner : str
        What messages call it.
    """

    search: CandidateSearch
    contacts: range
    owner: str

    @property
    def size(self) -> int:
        """How many numbers the search may write."""
        return 1 + CANDIDATE * (len(self.contacts) + 1)


def find_searches(contacts: Sequence[Contact]) -> list[FeatureSearch]:
    """Return the pools, in order.

    Raises
    ------
    InvalidInput
        If a shape is unbounded: nobody could say when its features have to be looked for again.
    """
    found = []
    searches = list(map(attrgetter("kinematics.candidates"), contacts))
    numbers = [number for number, search in enumerate(searches) if search is not None]
    for _, group in itertools.groupby(numbers, lambda number: id(searches[number])):
        first, *more = group
        one, search = contacts[first], searches[first]
        assert search is not None
        for shape, extent in zip(one.shapes, one.extents, strict=True):
            if not math.isfinite(extent):
                raise InvalidInput(
                    f"{type(shape).__name__} of the {one}",
                    "must be bounded where its features are searched for (`candidates`)",
                    extent,
                    "Give the shape a finite `extent`, or return contacts of given features from `between`.",
                )
        name = f"{type(one.kinematics).__name__} ({one})"
        found.append(FeatureSearch(search, range(first, first + 1 + len(more)), name))
    return found


def lay_searches(
    memory: Memory, heap: Heap, pools: Sequence[FeatureSearch], table: ContactTable, units: Mapping[tuple[int, int], int]
) -> None:
    """Lay the pools; ``units`` says which unit each frame is.  The units of a pool move as their farthest points."""
    for number, pool in enumerate(pools):
        function, values = pool.search.function, pool.search.values
        tables = {name: value for name, value in values.items() if isinstance(value, Table)}
        address, numbers = bind(function, "pair", {**values, **dict.fromkeys(tables, ())}, pool.owner)
        places = {parameter_place(function, "pair", name): shared for name, shared in tables.items()}
        whole = bind(function, "pair", values, pool.owner)[1] if tables else numbers
        try_out(function, "pair", values, whole, pool.size, pool.owner)
        start = heap.store(numbers)
        for place, shared in places.items():
            heap.refer(start + place, start, shared)
        first = pool.contacts.start
        sides = zip(table.bodies[first].tolist(), table.frames[first].tolist(), strict=True)
        one, two = (units[side] for side in sides)
        row = {
            "function": address,
            "parameters": start,
            "out": heap.output(pool.size),
            "first_contact": first,
            "n_contacts": len(pool.contacts),
            "sphere_a": one,
            "sphere_b": two,
        }
        for name, value in row.items():
            memory[getattr(owners.Search, name)][number] = value
        for unit in (one, two):
            memory[owners.Sphere.feature_radius][unit] = memory[owners.Sphere.radius][unit]


def failed_search(memory: Memory, contacts: Sequence[Contact]) -> str:
    """Return a sentence that names the search that gave no number of features; nothing if all did."""
    for number, pool in enumerate(find_searches(contacts)):
        found = memory.floats[int(memory[owners.Search.out][number])]
        if not found >= 0.0:
            function = pool.search.function
            what = interpreted.noted(function) or f"raises or gives {found:g}"
            return f"{pool.owner}: {described(function)}, {what} where it must give how many features it has found."
    return ""
