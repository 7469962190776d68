"""Pairs of convex parts of bodies with contacts, which the engine checks for overlap at the start of each step.

Contacts belong to features. Features that miss each other leave no gap, and the bodies would pass into each other.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.interfaces import ConvexPart, Shape
from nonsmooth.model.row_table import RowTable
from nonsmooth.solids.measure import numbers_of
from nonsmooth.system.contacts import Contacts

_ALLOWED = 1e-7
"""Allowed overlap beyond that of closed contacts, relative to the smaller shape: ten times the error of a gap of a body
that moves by a hundred times its size."""
_MOST_PIECES = 2048
"""Most pairs of pieces of two shapes of which one is not convex. A step evaluates the bound of each of them."""
_UNBOUNDED = float(np.finfo(np.float64).max)
"""Distance to the farthest point of a half-space [m]. It is finite, so that its product with no rotation is zero."""


class PairSide(NamedTuple):
    """A convex part of a shape on its body.

    Attributes
    ----------
    carrier : tuple of int
        Number of the body, and frame, that carries the part.
    part : ConvexPart
        The part.
    key : tuple of int
        Identity of the shape, and number of the part in the shape.
    """

    carrier: tuple[int, int]
    part: ConvexPart
    key: tuple[int, int]


class PartPair(NamedTuple):
    """Two convex parts of shapes with contacts.

    Attributes
    ----------
    group : int
        Number of the first pair of the same shapes.
    rows : list of int
        Numbers of the rows of contacts of the shapes.
    contact : int
        Number of the first of these contacts.
    sides : tuple of PairSide
        The parts. A half-space comes first, and the larger one of two discs.
    is_swapped : bool
        True if the first part belongs to the second body of the contacts.
    size : float
        Extent of the smaller shape [m].
    is_guarded : bool
        True if the separation of the shapes decides whether they meet (:func:`is_guarded`).
    clearance : float
        Separation of the parts at which contacts of the shapes may close [m]: feet may extend beyond the parts.
    """

    group: int
    rows: list[int]
    contact: int
    sides: tuple[PairSide, PairSide]
    is_swapped: bool
    size: float
    is_guarded: bool
    clearance: float


class ConvexSets(NamedTuple):
    """Convex sets of a shape.

    Attributes
    ----------
    parts : tuple of ConvexPart
        The parts whose union is the shape; none of a shape that is not convex.
    pieces : tuple of ConvexPart
        The pieces of its surface if it has no parts, such as triangles; none if there are too many.
    """

    parts: tuple[ConvexPart, ...]
    pieces: tuple[ConvexPart, ...]

    @classmethod
    def of(cls, shape: Shape) -> ConvexSets:
        """The sets of a shape. Too many pieces, or none, are left out."""
        surface = shape.solid.surface if not shape.parts and shape.solid else None
        n = 0 if surface is None else len(surface.boxes[0])
        pieces = () if surface is None or n > _MOST_PIECES else tuple(map(surface.piece, range(n)))
        return cls(shape.parts, pieces)


def chosen_sets(one: ConvexSets, two: ConvexSets) -> tuple[tuple[ConvexPart, ...], tuple[ConvexPart, ...]]:
    """The parts of both shapes, or the pieces of a shape without parts unless their pairs are too many.

    Nothing passes through a surface, so its pieces decide as parts do. Over a half-space corners have contacts of their
    own, and the gap of a ball over a feature is its distance.
    """
    if one.parts and two.parts:
        return one.parts, two.parts
    first, second = one.parts or one.pieces, two.parts or two.pieces
    has_own_gaps = any(part.is_half_space or part.is_ball for part in (*one.parts, *two.parts))
    if has_own_gaps or len(first) * len(second) > _MOST_PIECES:
        return (), ()
    return first, second


def find_part_pairs(contacts: Contacts, table: RowTable) -> list[PartPair]:
    """The pairs of convex parts of shapes with contacts that need a check for overlap.

    Each part of a shape is paired with each part of the other shape. A half-space, or the larger of two discs, becomes
    the first side, as the engine expects. ``group`` is the number of the first pair of the same two shapes.
    """
    sets_of: dict[int, ConvexSets] = {}
    found: list[PartPair] = []
    for rows in by_shapes(contacts, range(len(contacts.rows))):
        row, group, numbers = contacts.rows[rows[0]], len(found), numbers_of_rows(contacts, rows)
        for shape in row.shapes:
            # the sets of a shape are computed once
            if id(shape) not in sets_of:
                sets_of[id(shape)] = ConvexSets.of(shape)
        one_parts, two_parts = chosen_sets(*(sets_of[id(shape)] for shape in row.shapes))
        choices = [
            [PairSide((int(body), int(frame)), part, (id(shape), number)) for number, part in enumerate(parts)]
            for shape, body, frame, parts in zip(
                row.shapes, table.bodies[rows[0]], table.frames[rows[0]], (one_parts, two_parts), strict=True
            )
        ]
        clearance = sum(max((part.protrusion for part in parts), default=0.0) for parts in (one_parts, two_parts))
        guarded = is_guarded(one_parts, two_parts, len(numbers))
        for first, second in itertools.product(*choices):
            one, two = first.part, second.part
            if needs_overlap_check(one, two, len(numbers)):
                # the direction of separation is fixed to the first part; the radius of the second bounds its turning
                sizes = [part.radius if one.is_disc and two.is_disc else _reach(part) for part in (one, two)]
                is_swapped = sizes[1] > sizes[0]
                sides = (second, first) if is_swapped else (first, second)
                found.append(PartPair(group, rows, numbers[0], sides, is_swapped, row.size, guarded, clearance))
    return found


def carriers_of(pairs: Sequence[PartPair]) -> dict[tuple[int, int], float]:
    """Bodies and frames that carry parts, each with the distance from its origin to the farthest point of a part [m].

    With this distance the engine bounds how far the parts move if the frame turns.
    """
    radii: dict[tuple[int, int], float] = {}
    # the carriers of each part in the order of the pairs; a part belongs to many pairs
    parts = {(side.carrier, side.key): side.part for pair in pairs for side in pair.sides}
    for (carrier, _), part in parts.items():
        radii[carrier] = max(_reach(part), radii.get(carrier, 0.0))
    return radii


def _reach(part: ConvexPart) -> float:
    """Distance from the origin of the body's frame to the farthest point of a part [m]."""
    return _UNBOUNDED if part.is_half_space else math.hypot(*part.place) + part.radius


def needs_overlap_check(one: ConvexPart, two: ConvexPart, contacts: int) -> bool:
    """True if two parts can overlap without a negative gap of any contact, so that the engine must check them.

    ``contacts`` is the number of contacts of their shapes.
    """
    # of a half-space the engine checks the height of the other part, which must be bounded
    if one.is_half_space and two.is_half_space:
        return False
    # if balls and half-spaces have a single contact, its gap is that of the whole parts
    if contacts == 1 and all(part.is_ball or part.is_half_space for part in (one, two)):
        return False
    # circles and points have no volume, so they cannot overlap; of these only two discs may pass through each other
    return not (one.is_flat and two.is_flat) or (one.is_disc and two.is_disc)


def is_guarded(first: Sequence[ConvexPart], second: Sequence[ConvexPart], contacts: int) -> bool:
    """True if the separation of two shapes decides whether they meet: of bounded shapes with several contacts.

    The gap of a single contact is the distance itself. Half-spaces are a plane, over which each vertex has its contact.
    Points do not meet. ``first`` and ``second`` are the parts of the shapes, ``contacts`` is the number of contacts.
    """
    if contacts == 1 or any(part.is_half_space for part in (*first, *second)):
        return False
    return all(
        needs_overlap_check(one, two, contacts) or (one.is_flat and two.is_flat and not (one.is_disc or two.is_disc))
        for one, two in itertools.product(first, second)
    )


def contacts_without_parts(contacts: Contacts) -> list[int]:
    """Numbers of contacts of a shape without convex parts, whose bodies the engine cannot check for overlap.

    Their solids, if there are any, are compared in samples after the run.
    """
    # shapes are shared, and their parts are costly
    shapes = {id(shape): shape for row in contacts.rows for shape in row.shapes}
    without_parts = {key for key, shape in shapes.items() if not shape.parts}
    rows = [i for i, row in enumerate(contacts.rows) if not without_parts.isdisjoint(map(id, row.shapes))]
    return [number for i in rows for number in numbers_of_rows(contacts, [i])]


def unchecked_contacts(contacts: Contacts) -> list[str]:
    """Names of contacts of a shape without convex parts and without a surface: only their gaps show an overlap."""
    # shapes are shared, and their parts are costly
    shapes = {id(shape): shape for row in contacts.rows for shape in row.shapes}
    bare = {key for key, shape in shapes.items() if not (shape.parts or (shape.solid and shape.solid.surface))}
    rows = [row for row in contacts.rows if not bare.isdisjoint(map(id, row.shapes))]
    return [row.name(index) for row in rows for index in range(len(row))]


def by_shapes(contacts: Contacts, rows: Sequence[int]) -> list[list[int]]:
    """Those of the ``rows``, indices of rows of contacts, of the same pair of shapes, for each such pair.

    Shapes on other bodies or frames are another pair. Bodies and shapes are known by their identity.
    """
    groups: dict[tuple[int, ...], list[int]] = {}
    for index in rows:
        row = contacts.rows[index]
        groups.setdefault((*map(id, row.bodies), *row.frames, *map(id, row.shapes)), []).append(index)
    return list(groups.values())


def numbers_of_rows(contacts: Contacts, rows: Sequence[int]) -> Sequence[int]:
    """Numbers of the contacts in the rows with these indices."""
    ranges = [range(int(contacts.starts[row]), int(contacts.starts[row + 1])) for row in rows]
    return ranges[0] if len(ranges) == 1 else [*itertools.chain.from_iterable(ranges)]


def lay_part_pairs(
    memory: Memory, blocks: Heap, pairs: Sequence[PartPair], frames: Mapping[tuple[int, int], int]
) -> None:
    """Write the pairs of convex parts, the frames that carry them, and the first pair of each row of contacts.

    ``frames`` has the place of each frame in the memory, by the numbers of body and frame. A part that belongs to
    several pairs is stored once.
    """
    of_row = memory[owners.RowRecord.pair]
    of_row[:] = NO_PAIR
    carriers = carriers_of(pairs)
    numbers = {side: number for number, side in enumerate(carriers)}
    memory[owners.Carrier.frame] = [frames[side] for side in carriers]
    memory[owners.Carrier.body] = [body for body, _ in carriers]
    memory[owners.Carrier.radius] = list(carriers.values())
    starts: dict[tuple[int, int], int] = {}
    flat: dict[tuple[int, int], bool] = {}
    for number, pair in enumerate(pairs):
        for side in pair.sides:
            if side.key not in starts:
                starts[side.key], flat[side.key] = blocks.store(numbers_of(side.part)), side.part.is_flat
        # once for all pairs of the same shapes
        if number == pair.group:
            of_row[pair.rows] = number
    record = owners.Pair
    memory[record.group], memory[record.contact] = [pair.group for pair in pairs], [pair.contact for pair in pairs]
    memory[record.are_both_flat] = [all(flat[side.key] for side in pair.sides) for pair in pairs]
    memory[record.is_guarded] = [pair.is_guarded for pair in pairs]
    memory[record.is_swapped] = [pair.is_swapped for pair in pairs]
    memory[record.clearance] = [pair.clearance for pair in pairs]
    memory[record.size] = [pair.size for pair in pairs]
    memory[record.allowed] = _ALLOWED * memory[record.size]
    for i, (carrier, frame, part) in enumerate(
        ((record.carrier_a, record.frame_a, record.part_a), (record.carrier_b, record.frame_b, record.part_b))
    ):
        memory[carrier] = [numbers[pair.sides[i].carrier] for pair in pairs]
        memory[frame] = [frames[pair.sides[i].carrier] for pair in pairs]
        memory[part] = [starts[pair.sides[i].key] for pair in pairs]
