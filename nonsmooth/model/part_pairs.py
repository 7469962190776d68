"""Pairs of convex parts of bodies with contacts, which the engine checks for overlap at the start of each step.

Contacts belong to features. Features that miss each other leave no gap, and the bodies would pass into each other.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import PART_RINGS, RING
from nonsmooth.engine.memory.memory import Heap, Memory
from nonsmooth.engine.pairs.overlaps import NO_PAIR
from nonsmooth.interfaces import ConvexPart
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.laying import write_record
from nonsmooth.system.contact import Contact

_ALLOWED = 1e-7
"""Allowed overlap beyond that of closed contacts, relative to the smaller shape: ten times the error of a gap of a body
that moves by a hundred times its size."""
_UNBOUNDED = float(np.finfo(np.float64).max)
"""Distance to the farthest point of a half-space [m]. It is finite, so that its product with no rotation is zero."""


@dataclass(frozen=True, eq=False)
class PartPair:
    """Two convex parts of shapes with contacts.

    Attributes
    ----------
    group : int
        Number of the first pair of the same shapes.
    contacts : tuple of int
        Numbers of the contacts of the shapes.
    sides : tuple
        Number of the body, and frame, of each part.
    parts : tuple of ConvexPart
        The parts. A half-space comes first, and the larger one of two discs.
    shapes : tuple of int
        Identity of the shape of each part, and number of the part in the shape.
    size : float
        Extent of the smaller shape [m].
    """

    group: int
    contacts: tuple[int, ...]
    sides: tuple[tuple[int, int], tuple[int, int]]
    parts: tuple[ConvexPart, ConvexPart]
    shapes: tuple[tuple[int, int], tuple[int, int]]
    size: float


def find_part_pairs(contacts: Sequence[Contact], table: ContactTable) -> list[PartPair]:
    """The pairs of parts that need a check for overlap."""
    parts_of: dict[int, tuple[ConvexPart, ...]] = {}
    found: list[PartPair] = []
    for numbers in _groups(contacts):
        contact = contacts[numbers[0]]
        sides = [(int(table.bodies[numbers[0], i]), int(table.frames[numbers[0], i])) for i in (0, 1)]
        for shape in contact.shapes:
            if id(shape) not in parts_of:
                parts_of[id(shape)] = shape.parts
        group = len(found)
        choices = [list(enumerate(parts_of[id(shape)])) for shape in contact.shapes]
        for one, two in itertools.product(*choices):
            if needs_overlap_check(one[1], two[1], len(numbers)):
                both = ((one, sides[0], id(contact.shapes[0])), (two, sides[1], id(contact.shapes[1])))
                larger = one[1].is_disc and two[1].is_disc and two[1].radius > one[1].radius
                first, second = both[::-1] if two[1].is_half_space or larger else both
                found.append(
                    PartPair(
                        group,
                        tuple(numbers),
                        (first[1], second[1]),
                        (first[0][1], second[0][1]),
                        ((first[2], first[0][0]), (second[2], second[0][0])),
                        contact.size,
                    )
                )
    return found


def carriers_of(pairs: Sequence[PartPair]) -> dict[tuple[int, int], float]:
    """Bodies and frames that carry parts, each with the distance to its farthest point [m]."""
    radii: dict[tuple[int, int], float] = {}
    for pair in pairs:
        for side, part in zip(pair.sides, pair.parts, strict=True):
            reach = _UNBOUNDED if part.is_half_space else math.hypot(*part.place) + part.radius
            radii[side] = max(reach, radii.get(side, 0.0))
    return radii


def needs_overlap_check(one: ConvexPart, two: ConvexPart, contacts: int) -> bool:
    """True if two parts can overlap without a negative gap of a contact."""
    if one.is_half_space and two.is_half_space:
        return False
    simple = all(part.is_ball or part.is_half_space for part in (one, two))
    flat = one.is_flat and two.is_flat
    return not (simple and contacts == 1) and (not flat or (one.is_disc and two.is_disc))


def contacts_without_parts(contacts: Sequence[Contact]) -> list[int]:
    """Numbers of contacts of a shape without convex parts, whose bodies the engine cannot check for overlap."""
    shapes = {id(shape): shape for contact in contacts for shape in contact.shapes}
    without_parts = {key for key, shape in shapes.items() if not shape.parts}
    if not without_parts:
        return []
    return [i for i, contact in enumerate(contacts) if not without_parts.isdisjoint(map(id, contact.shapes))]


def unchecked_contacts(contacts: Sequence[Contact]) -> list[str]:
    """Names of contacts of a shape without convex parts and without a solid: only their gaps show an overlap."""
    parts = {id(shape): shape.parts for contact in contacts for shape in contact.shapes}
    bare = {id(shape) for contact in contacts for shape in contact.shapes if not parts[id(shape)] and not shape.solid}
    return [contact.name for contact in contacts if not bare.isdisjoint(map(id, contact.shapes))]


def _groups(contacts: Sequence[Contact]) -> list[list[int]]:
    """Numbers of the contacts of each pair of shapes."""
    groups: dict[tuple[int, ...], list[int]] = {}
    names = "first", "second"
    sides = [list(map(id, map(attrgetter(name), contacts))) for name in names]
    for number, (contact, first, second) in enumerate(zip(contacts, *sides, strict=True)):
        key = first, second, *contact.frames, *map(id, contact.shapes)
        groups.setdefault(key, []).append(number)
    return list(groups.values())


def numbers_of(part: ConvexPart) -> list[float]:
    """Numbers of a part as the engine reads them (:mod:`nonsmooth.engine.memory.blocks`)."""
    n_rings = -1 if part.is_half_space else len(part.rings)
    function_place = PART_RINGS + RING * len(part.rings) if part.function else 0
    head = [
        *part.place,
        *np.ravel(part.axes),
        *part.semi,
        *part.powers,
        part.ball,
        part.radius,
        function_place,
        n_rings,
    ]
    return [float(number) for number in (*head, *np.ravel(part.rings), *part.function)]


def lay_part_pairs(
    memory: Memory, blocks: Heap, pairs: Sequence[PartPair], frames: Mapping[tuple[int, int], int]
) -> None:
    """Write the pairs, and the first pair of each contact; ``frames`` has the place of each frame in the memory."""
    of_contact = memory.declared(owners.Contact.pair)
    of_contact[:] = NO_PAIR
    carriers = carriers_of(pairs)
    numbers = {side: number for number, side in enumerate(carriers)}
    memory[owners.Carrier.frame] = [frames[side] for side in carriers]
    memory[owners.Carrier.radius] = list(carriers.values())
    starts: dict[tuple[int, int], int] = {}
    for number, pair in enumerate(pairs):
        for key, part in zip(pair.shapes, pair.parts, strict=True):
            if key not in starts:
                starts[key] = blocks.store(numbers_of(part))
        fields: dict[str, float] = {
            "group": pair.group,
            "contact": pair.contacts[0],
            "are_both_flat": all(part.is_flat for part in pair.parts),
            "allowed": _ALLOWED * pair.size,
            "size": pair.size,
        }
        for name, side, key in zip("ab", pair.sides, pair.shapes, strict=True):
            fields |= {f"carrier_{name}": numbers[side], f"frame_{name}": frames[side], f"part_{name}": starts[key]}
        write_record(memory, owners.Pair, number, fields)
        if number == pair.group:
            of_contact[np.array(pair.contacts)] = number
