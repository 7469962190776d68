"""Units of the broad phase: frames that carry bounded shapes, and which of them have contacts with each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.model.pools import Pool, find_pools
from nonsmooth.system.contact import Contact

SMALL = 64
"""Systems with up to this many declared contacts keep all of them in slots."""
_SLOTS = 16
"""Slots for each unit, at least."""
_NEIGHBOURS = 6
"""Pairs with all their contacts for which each unit has slots."""
_MARGIN = 0.5
"""Margin of the list, in units of the smallest radius."""


@dataclass(frozen=True)
class Units:
    """The units of a system.

    Attributes
    ----------
    frames : dict
        (id of body, frame) -> number of the unit.
    radii : list of float
        Radius of every unit about its frame's origin [m].
    pairs : dict
        (unit, later unit) -> numbers of their contacts.
    unbounded : list of int
        Contacts with an unbounded shape.
    pools : list of Pool
        Contacts whose features are searched for.
    """

    frames: dict[tuple[int, int], int]
    radii: list[float]
    pairs: dict[tuple[int, int], list[int]]
    unbounded: list[int]
    pools: list[Pool]

    @property
    def n_slots(self) -> int:
        """Contacts that may be near each other at once."""
        counts = [len(contacts) for contacts in self.pairs.values()]
        each = max(_SLOTS, _NEIGHBOURS * max(counts, default=0))
        return len(self.unbounded) + min(sum(counts), each * len(self.frames))


def find_units(contacts: Sequence[Contact]) -> Units:
    """Return the units of many contacts; none for few, which need no list."""
    pools = find_pools(contacts)
    units = Units({}, [], {}, [], pools)
    if len(contacts) <= SMALL and not pools:
        return Units({}, [], {}, list(range(len(contacts))), [])
    for number, contact in enumerate(contacts):
        sides = [(id(body), frame) for body, frame in zip((contact.first, contact.second), contact.frames, strict=True)]
        if not all(math.isfinite(extent) for extent in contact.extents):
            units.unbounded.append(number)
            continue
        pair = []
        for side, extent in zip(sides, contact.extents, strict=True):
            if side not in units.frames:
                units.frames[side] = len(units.radii)
                units.radii.append(0.0)
            unit = units.frames[side]
            units.radii[unit] = max(units.radii[unit], extent)
            pair.append(unit)
        units.pairs.setdefault((min(pair), max(pair)), []).append(number)
    return units


def lay_units(memory: Memory, units: Units, places: dict[tuple[int, int], int]) -> None:
    """Lay the units; ``places`` says where each frame stands on the heap."""
    n = len(units.radii)
    if n == 0:
        return
    for side, unit in units.frames.items():
        memory.array("unit_frame", n)[unit] = places[side]
    memory.array("unit_radius", n)[:] = units.radii
    memory.array("unit_order", n)[:] = range(n)
    memory.scalars["margin_of_list"] = memory.scalars["widest_margin"] = _MARGIN * min(units.radii)
    ordered = sorted(units.pairs)
    starts = [0] * (n + 1)
    for one, _ in ordered:
        starts[one + 1] += 1
    for i in range(n):
        starts[i + 1] += starts[i]
    memory.array("unit_partner", n + 1)[:] = starts
    memory.array("partner_unit", len(ordered))[:] = [two for _, two in ordered]
    contacts: list[int] = []
    offsets = memory.array("partner_contact", len(ordered) + 1)
    for i, pair in enumerate(ordered):
        offsets[i] = len(contacts)
        contacts += units.pairs[pair]
    offsets[len(ordered)] = len(contacts)
    contacts += units.unbounded
    memory.array("paired_contact", len(contacts))[:] = contacts
