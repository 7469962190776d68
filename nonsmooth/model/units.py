"""Units of the broad phase: frames that carry bounded shapes, and which of them have contacts with each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.interfaces import Body
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.pools import Pool, find_pools
from nonsmooth.system.contact import Contact
from nonsmooth.types import Array

SMALL = 64
"""Systems with up to this many declared contacts keep all of them in slots."""
_SLOTS = 16
"""Slots for each unit, at least."""
_NEIGHBOURS = 6
"""Pairs with all their contacts for which each unit has slots."""
_MARGIN = 0.5
"""Margin of the list, in units of the smallest radius."""


@dataclass(frozen=True)
class Wall:
    """An unbounded shape in a contact.

    Attributes
    ----------
    contact : int
        Number of the contact.
    side : tuple of int
        Number of the body that carries it, and its frame.
    unit : int
        The unit that it may touch, 0 if there is none.
    ceiling : float
        Height over the frame's origin above which it has no point [m].
    steady : bool
        Whether its distance tells when it is far from the unit: its body does not change how it moves.
    """

    contact: int
    side: tuple[int, int]
    unit: int
    ceiling: float
    steady: bool


@dataclass(frozen=True, eq=False)
class Units:
    """The units of a system.

    Attributes
    ----------
    frames : dict
        (number of the body, frame) -> number of the unit.
    radii : array
        Radius of every unit about its frame's origin [m].
    pairs : array
        Unit and later unit of all pairs with contacts, in order, shape [n, 2].
    counts : array
        How many contacts each pair has.
    contacts : array
        Numbers of the contacts of pairs, pair by pair.
    walls : list of Wall
        The unbounded shapes, contact by contact.
    pools : list of Pool
        Contacts whose features are searched for.
    """

    frames: dict[tuple[int, int], int]
    radii: Array
    pairs: NDArray[np.int64]
    counts: NDArray[np.int64]
    contacts: NDArray[np.int64]
    walls: list[Wall]
    pools: list[Pool]

    @property
    def n_slots(self) -> int:
        """Contacts that may be near each other at once."""
        each = max(_SLOTS, _NEIGHBOURS * int(self.counts.max(initial=0)))
        return len(self.walls) + min(len(self.contacts), each * len(self.frames))


def find_units(contacts: Sequence[Contact], table: ContactTable, bodies: Sequence[Body]) -> Units:
    """Return the units of many contacts; none for few, which need no list."""
    pools = find_pools(contacts)
    bounded = np.all(np.isfinite(table.extents), axis=1)
    if len(contacts) <= SMALL and not pools:
        bounded[:] = False
    numbers = np.flatnonzero(bounded)
    many = int(table.frames.max(initial=0)) + 1
    known, sides = np.unique(many * table.bodies[numbers] + table.frames[numbers], return_inverse=True)
    frames = {divmod(key, many): unit for unit, key in enumerate(known.tolist())}
    radii = np.zeros(len(frames))
    np.maximum.at(radii, sides.ravel(), table.extents[numbers].ravel())
    one, two = np.sort(sides.reshape(-1, 2), axis=1).T
    places = one * len(frames) + two
    order = np.argsort(places, kind="stable")
    _, first, counts = np.unique(places[order], return_index=True, return_counts=True)
    pairs = np.column_stack([one, two])[order[first]]
    walls = [_wall(contacts[i], i, table, bodies, frames, radii) for i in np.flatnonzero(~bounded).tolist()]
    return Units(frames, radii, pairs, counts, numbers[order], walls, pools)


def _wall(
    contact: Contact,
    number: int,
    table: ContactTable,
    bodies: Sequence[Body],
    frames: Mapping[tuple[int, int], int],
    radii: Array,
) -> Wall:
    """Return the unbounded shape of a contact; the unit beside it gets a radius that holds the other shape."""
    one, other = (0, 1) if not math.isfinite(contact.extents[0]) else (1, 0)
    sides = [(int(table.bodies[number, i]), int(table.frames[number, i])) for i in (one, other)]
    unit, ceiling = frames.get(sides[1]), contact.shapes[one].ceiling
    body = bodies[sides[0][0]]
    steady = unit is not None and math.isfinite(ceiling) and body.n_u == 0 and math.isinf(body.time_scale)
    if unit is not None and math.isfinite(contact.extents[other]):
        radii[unit] = max(radii[unit], contact.extents[other])
    return Wall(number, sides[0], unit or 0, ceiling if steady else 0.0, steady)


def lay_units(memory: Memory, units: Units, places: dict[tuple[int, int], int]) -> None:
    """Lay the units; ``places`` says where each frame stands on the heap."""
    n = len(units.radii)
    if n == 0:
        return
    for side, unit in units.frames.items():
        memory[owners.Sphere.frame][:n][unit] = places[side]
    memory[owners.Sphere.radius][:n] = units.radii
    memory[owners.Island.sphere_order][:n] = range(n)
    memory[owners.Island.list_margin] = memory[owners.Options.widest_margin] = _MARGIN * float(units.radii.min())
    one, two = units.pairs.T
    memory[owners.Sphere.first_partner][: n + 1][1:] = np.cumsum(np.bincount(one, minlength=n))
    memory[owners.Model.partner][: len(two)] = two
    memory[owners.Model.partner_contact][: len(two) + 1][1:] = np.cumsum(units.counts)
    memory[owners.Model.paired_contact][: len(units.contacts)] = units.contacts
    for i, wall in enumerate(units.walls):
        memory[owners.HalfSpace.contact][i] = wall.contact
        memory[owners.HalfSpace.sphere][i] = wall.unit
        memory[owners.HalfSpace.frame][i] = places[wall.side]
        memory[owners.HalfSpace.ceiling][i] = wall.ceiling
        memory[owners.HalfSpace.is_steady][i] = wall.steady
