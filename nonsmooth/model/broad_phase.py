"""BroadPhase: bounding spheres of frames, and the pairs of spheres that have contacts with each other.

Of many declared contacts few belong to bodies near each other. The engine compares bounding spheres and half-spaces,
and evaluates the contacts of near pairs only.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.interfaces import Body
from nonsmooth.model.feature_searches import FeatureSearch, find_searches
from nonsmooth.model.laying import write_record
from nonsmooth.model.row_table import RowTable
from nonsmooth.system.contacts import ContactRow, Contacts
from nonsmooth.types import Array

SMALL = 64
"""Largest number of declared contacts that need no broad phase. To evaluate so many costs less than it does."""
CONTACTS_PER_SPHERE = 16
"""Number of active contacts per sphere that the memory has slots for at first: a sphere has up to 12 neighbours."""
LEAST_SLOTS = 1024
"""Number of active contacts that any memory has slots for at first, if so many are declared. They take 4 MB."""
_MARGIN = 0.5
"""Margin of the neighbour list, in least radii of spheres. The list lasts while bodies move by about so far."""


@dataclass(frozen=True)
class BroadPhaseHalfSpace:
    """An unbounded shape with contacts.

    Attributes
    ----------
    row : int
        Number of the row of its contacts.
    side : tuple of int
        Number of the body that carries it, and its frame.
    sphere : int
        Number of the sphere that it may touch. Without one it is 0, and `is_steady` is False.
    ceiling : float
        Height over the frame's origin above which it has no point [m].
    is_steady : bool
        True if its body does not change its motion, so that the height of the sphere shows when it is far away.
    """

    row: int
    side: tuple[int, int]
    sphere: int
    ceiling: float
    is_steady: bool


@dataclass(frozen=True, eq=False)
class BroadPhase:
    """The bounding spheres and half-spaces of a system, and their contacts.

    Attributes
    ----------
    frames : dict
        Number of the sphere of a frame, by number of the body and frame.
    radii : array
        Radius of each sphere about the origin of its frame [m].
    pairs : array
        The pairs of spheres with contacts, in order, with the lower number first, shape [n, 2].
    counts : array
        Number of rows of contacts of each pair.
    rows : array
        Numbers of the rows of pairs, pair by pair.
    half_spaces : list of BroadPhaseHalfSpace
        The unbounded shapes, row by row.
    searches : list of FeatureSearch
        Searches for candidate features.
    n_slots : int
        Number of active contacts, those of bodies near each other, that the memory has slots for at first. It grows.
    """

    frames: dict[tuple[int, int], int]
    radii: Array
    pairs: NDArray[np.int64]
    counts: NDArray[np.int64]
    rows: NDArray[np.int64]
    half_spaces: list[BroadPhaseHalfSpace]
    searches: list[FeatureSearch]
    n_slots: int

    @property
    def lengths(self) -> dict[str, int]:
        """Counts of the memory for spheres, their pairs and contacts, half-spaces and searches."""
        n_spheres = len(self.radii)
        return {
            "n_spheres": n_spheres,
            "n_partners": len(self.pairs),
            "n_paired": len(self.rows),
            # without spheres all contacts are active
            "n_half_spaces": len(self.half_spaces) if n_spheres > 0 else 0,
            "n_searches": len(self.searches),
        }


def find_broad_phase(contacts: Contacts, table: RowTable, bodies: Sequence[Body]) -> BroadPhase:
    """Bounding spheres, pairs of spheres with their contacts, and half-spaces of a system with these bodies.

    A frame with contacts of two bounded shapes gets a sphere about its origin that holds its bounded shapes. Such a
    contact belongs to the pair of their spheres, any other contact to a half-space. Up to :data:`SMALL` contacts need
    no broad phase: they all go to the half-spaces and are always active. Searches for candidate features need spheres
    in any case.
    """
    searches = find_searches(contacts)
    is_bounded = np.all(np.isfinite(table.extents), axis=1)
    if len(contacts) <= SMALL and not searches:
        is_bounded[:] = False
    # the rows of two bounded shapes; none in a small system
    numbers = np.flatnonzero(is_bounded)
    # the numbers of body and frame make one integer, the key of a sphere; sides has the sphere of each side of a row
    n_frames = int(table.frames.max(initial=0)) + 1
    known, sides = np.unique(n_frames * table.bodies[numbers] + table.frames[numbers], return_inverse=True)
    frames = {divmod(key, n_frames): sphere for sphere, key in enumerate(known.tolist())}
    # the largest extent of the shapes at each frame
    radii = np.zeros(len(frames))
    np.maximum.at(radii, sides.ravel(), table.extents[numbers].ravel())
    # rows of the same two spheres, of which the lower number comes first, are listed together
    one, two = np.sort(sides.reshape(-1, 2), axis=1).T
    keys = one * len(frames) + two
    order = np.argsort(keys, kind="stable")
    # of each pair its first row, and the number of its rows
    _, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    pairs = np.column_stack([one, two])[order[first]]
    unbounded = np.flatnonzero(~is_bounded).tolist()
    half_spaces = [_half_space(contacts.rows[i], i, table, bodies, frames, radii) for i in unbounded]
    # contacts with a half-space are always active, unless it is steady; without spheres all are
    always = sum(len(contacts.rows[one.row]) for one in half_spaces if not one.is_steady)
    n_slots = min(len(contacts), always + max(LEAST_SLOTS, CONTACTS_PER_SPHERE * len(frames)))
    return BroadPhase(frames, radii, pairs, counts, numbers[order], half_spaces, searches, n_slots)


def _half_space(
    row: ContactRow,
    number: int,
    table: RowTable,
    bodies: Sequence[Body],
    frames: Mapping[tuple[int, int], int],
    radii: Array,
) -> BroadPhaseHalfSpace:
    """The unbounded shape of row ``number``, and the bounding sphere of the other shape, if there is one.

    That sphere was made for other contacts of its frame. Its radius in ``radii`` grows in place to hold this shape,
    too. If the half-space is steady, the contact is active only while the sphere is near its ceiling, else always.
    """
    # a small system may have two bounded shapes here: then the second takes the place of the unbounded one
    unbounded, other = (0, 1) if not math.isfinite(row.extents[0]) else (1, 0)
    sides = [(int(table.bodies[number, i]), int(table.frames[number, i])) for i in (unbounded, other)]
    sphere, ceiling = frames.get(sides[1]), row.shapes[unbounded].ceiling
    # steady: below a plane, on a driven body whose prescribed motion does not change
    body = bodies[sides[0][0]]
    is_steady = sphere is not None and math.isfinite(ceiling) and body.n_u == 0 and math.isinf(body.time_scale)
    if sphere is not None and math.isfinite(row.extents[other]):
        radii[sphere] = max(radii[sphere], row.extents[other])
    # sphere and ceiling are read only if it is steady; else any valid numbers serve
    return BroadPhaseHalfSpace(number, sides[0], sphere or 0, ceiling if is_steady else 0.0, is_steady)


def lay_broad_phase(memory: Memory, broad_phase: BroadPhase, frames: dict[tuple[int, int], int]) -> None:
    """Write spheres, their pairs and rows of contacts, and half-spaces. ``frames`` has the offset of each frame.

    Without spheres nothing is written: the engine then takes all contacts as active.
    """
    n = len(broad_phase.radii)
    if n == 0:
        return
    for side, sphere in broad_phase.frames.items():
        memory[owners.BoundingSphere.frame][sphere] = frames[side]
    memory[owners.BoundingSphere.radius] = broad_phase.radii
    # any order serves: the engine sorts it along an axis when it makes the neighbour list
    memory[owners.Island.sphere_order] = range(n)
    # the neighbour list begins with its widest margin
    memory[owners.Island.list_margin] = memory[owners.Options.widest_margin] = _MARGIN * float(broad_phase.radii.min())
    # starts of ranges, each with the end of the last range behind: pairs of each sphere, rows of each pair
    one, two = broad_phase.pairs.T
    memory[owners.BoundingSphere.first_partner][1:] = np.cumsum(np.bincount(one, minlength=n))
    memory[owners.ModelNumbers.partner] = two
    memory[owners.ModelNumbers.partner_row][1:] = np.cumsum(broad_phase.counts)
    memory[owners.ModelNumbers.paired_row] = broad_phase.rows
    for i, half_space in enumerate(broad_phase.half_spaces):
        fields = {name: getattr(half_space, name) for name in ("row", "sphere", "ceiling", "is_steady")}
        write_record(memory, owners.HalfSpaceRecord, i, {**fields, "frame": frames[half_space.side]})
