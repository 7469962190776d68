"""Warnings of bodies without contact that overlap at the start of a run or during it."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, NoDistance, NonsmoothWarning
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.notices import warn
from nonsmooth.queries.distance import BodyPair
from nonsmooth.queries.near import Ties, near_bodies, size_of
from nonsmooth.solids.measure import touching
from nonsmooth.solids.pieces import Pieces
from nonsmooth.solids.placed import Placed, overlap
from nonsmooth.system.system import System

Places = Sequence[Sequence[Place]]
"""Places of the frames of all bodies, body by body."""
_NAMED = 3
"""Largest number of pairs that a warning names; it gives only the number of further pairs."""
_MOVED = 0.25
"""Change of a coordinate between two checked samples, relative to its size in the body (:attr:`Body.scales`).

Bodies that pass through each other move farther than this while they overlap, so a check finds them.
"""


class UndeclaredOverlap(NonsmoothWarning):
    """Bodies without a contact overlap at the start of a run, or pass into each other during the run."""


class UndeclaredContact(NonsmoothWarning):
    """A movable body has no contact, joint or load, although it could meet other bodies."""


@final
@dataclass(frozen=True)
class Undeclared:
    """Undeclared pairs of bodies of a system, between which contacts may have been forgotten.

    Left out are pairs of driven bodies, pairs of one mechanism, pairs with a declared contact (even of some shapes
    only), and pairs that the user excluded.  A system without any contact has no undeclared pairs: nothing in it is
    meant to touch.

    Attributes
    ----------
    system : System
        The system.
    ties : Ties
        Its declared, joined and excluded pairs.
    """

    system: System
    ties: Ties

    @classmethod
    def of(cls, system: System) -> Undeclared:
        """Undeclared pairs of bodies of a system, as the class describes them."""
        return cls(system, Ties.of(system))

    @functools.cached_property
    def any(self) -> bool:
        """True if two bodies of the system could meet and have no declared contact, however far apart they are."""
        if not self.system.declarations:
            return False
        shaped = [i for i, body in enumerate(self.system.bodies) if any(body.frames)]
        return any(self._is_one(i, j) for i, j in itertools.combinations(shaped, 2))

    def _is_one(self, i: int, j: int) -> bool:
        moves = self.system.bodies[i].n_u + self.system.bodies[j].n_u > 0
        said = (i, j) in self.ties.declared or (i, j) in self.ties.excluded
        return moves and not said and not self.ties.same_mechanism(i, j)

    def warn_of_lone(self) -> None:
        """Warn of movable bodies that have no declared contact but could meet another body.

        The warning leaves out bodies with a joint or a load, because the joint or load may keep them from other bodies.
        """
        bodies, names = self.system.bodies, self.system.names.bodies
        tied = ((tie.first, tie.second) for tie in (*self.system.joints, *self.system.loads))
        held = {id(body) for pair in (*tied, *(row.bodies for row in self.system.contacts.rows)) for body in pair}
        shaped = [i for i, body in enumerate(bodies) if any(body.frames)]
        lone = [i for i in shaped if bodies[i].n_u > 0 and id(bodies[i]) not in held]
        met = [(i, j) for i in lone for j in shaped if i != j and self._is_one(min(i, j), max(i, j))]
        if not met:
            return
        named = [f"{names[i]!r} through {names[j]!r}" for i, j in dict(reversed(met)).items()][::-1]
        more = f", and {len(named) - _NAMED} more bodies" if len(named) > _NAMED else ""
        warn(
            f"Bodies without any contact pass through others: {', '.join(named[:_NAMED])}{more}. Declare a contact by "
            "system.contact(...), or say by system.exclude(first, second) that they do not touch.",
            UndeclaredContact,
        )

    def near(self, places: Places) -> list[tuple[int, int]]:
        """Undeclared pairs whose boxes overlap, with the frames at given places."""
        bodies = self.system.bodies
        met = near_bodies(bodies, places, np.zeros(len(bodies))) if self.any else iter(())
        return [(i, j) for i, j in met if self._is_one(i, j)]

    def warn_of_start(self, places: Places) -> None:
        """Warn of bodies that overlap at the start. Planes are left out: a body may start behind one on purpose."""
        bodies = self.system.bodies
        found = [
            (i, j, depth)
            for i, j in self.near(places)
            if (depth := _overlap(bodies[i], places[i], bodies[j], places[j])) > 0.0
        ]
        self._warn(found, "overlap at the start, and will pass through each other")

    @functools.cached_property
    def least_move(self) -> Vector:
        """Change of each coordinate after which a sample is checked for overlaps: a quarter of its size in the body."""
        return _MOVED * np.concatenate([body.scales[0] for body in self.system.bodies])

    @functools.cached_property
    def _radii(self) -> list[list[float]]:
        """Radius about the origin of each frame of each body that holds its shapes [m]; 0 without shapes."""
        # the extent of a polyhedron takes 20 us
        return [
            [max((shape.extent for shape in shapes), default=0.0) for shapes in body.frames]
            for body in self.system.bodies
        ]

    @functools.cached_property
    def _spheres(self) -> tuple[NDArray[np.int64], NDArray[np.int64], Vector, list[tuple[int, int]]]:
        """Frames of undeclared pairs by number, sums of the radii of their shapes [m], and numbers of the bodies."""
        bodies, radii = self.system.bodies, self._radii
        first = np.concatenate([[0], np.cumsum([len(body.frames) for body in bodies])]).tolist()
        found = [
            (first[i] + m, first[j] + n, one + two, (i, j))
            for i, j in itertools.combinations([k for k, body in enumerate(bodies) if any(body.frames)], 2)
            if self._is_one(i, j)
            for (m, one), (n, two) in itertools.product(enumerate(radii[i]), enumerate(radii[j]))
        ]
        a, b, reach, pairs = zip(*found, strict=True) if found else ((), (), (), ())
        return np.array(a, np.int64), np.array(b, np.int64), np.array(reach, float), [*pairs]

    def _met(self, places: Places) -> list[tuple[int, int]]:
        """Undeclared pairs whose bounding spheres overlap, with the frames at given places."""
        a, b, reach, pairs = self._spheres
        origins = np.array([position for frames in places for position, _ in frames]).reshape(-1, 3)
        apart = np.linalg.norm(origins[a] - origins[b], axis=1)
        return sorted({pairs[k] for k in np.flatnonzero(apart < reach).tolist()})

    def warn_of_run(self, before: Places, samples: Iterable[tuple[float, Places]]) -> None:
        """Warn of pairs of bodies, planes too, that overlap at a sample of a run but did not overlap at its start.

        The gap of a pair changes by no more than its bodies move.  So a pair is not measured again until they have
        moved by as much as its last gap.

        Parameters
        ----------
        before : Places
            Places of the frames at the start.
        samples : iterable
            Times [s], and places of the frames at these times.
        """
        measured: dict[tuple[int, int], tuple[float, Places]] = {}
        found: list[tuple[int, int, float]] = []
        times: list[float] = []
        for t, places in samples:
            for i, j in self._met(places):
                gap, then = measured.get((i, j)) or (self._gap(i, j, before), before)
                # a pair that overlaps at the start, or was found, has a gap of minus infinity from then on
                if 0.0 <= gap < sum(self._moved(k, then, places) for k in (i, j)):
                    gap, then = self._gap(i, j, places), places
                    if gap < 0.0:
                        found.append((i, j, -gap))
                        times.append(t)
                measured[i, j] = (gap if gap >= 0.0 else -math.inf), then
        self._warn(found, f"pass into each other, the first at t = {min(times, default=0.0):.6g} s")

    def _moved(self, number: int, before: Places, after: Places) -> float:
        """Upper bound of the displacement of the points of the bounded shapes of a body [m]; inf of a turning plane."""
        most = 0.0
        for (one, axes), (two, turned), radius in zip(before[number], after[number], self._radii[number], strict=True):
            turn = math.sqrt(0.5 * float(np.sum((turned - axes) ** 2)))
            most = max(most, float(np.linalg.norm(two - one)) + (radius * turn if turn > 0.0 else 0.0))
        return most

    def _gap(self, i: int, j: int, places: Places) -> float:
        """Gap of two bodies [m], negative if they overlap; 0 if they touch or no method gives their distance."""
        bodies = self.system.bodies
        sizes = [size for size in (size_of(bodies[i]), size_of(bodies[j])) if math.isfinite(size)]
        try:
            gap = BodyPair(bodies[i].frames, bodies[j].frames).at(places[i], places[j]).gap
        except (InvalidInput, NoDistance):
            # no method gives the distance of two unbounded or of unsupported shapes: with 0 the pair gets no warning
            return 0.0
        return gap if abs(gap) > touching(min(sizes, default=0.0)) else 0.0

    def _warn(self, found: list[tuple[int, int, float]], what: str) -> None:
        if not found:
            return
        names = self.system.names.bodies
        named = [f"{names[i]!r} and {names[j]!r} by at least {depth:.2g} m" for i, j, depth in found[:_NAMED]]
        more = [f"and {len(found) - _NAMED} more pairs"] if len(found) > _NAMED else []
        warn(
            f"Bodies without a contact {what}: {'; '.join(named + more)}. Declare their contact by "
            "system.contact(...), or say by system.exclude(first, second) that they do not touch. "
            "nonsmooth.proximity(system) lists the pairs that are near each other at the start.",
            UndeclaredOverlap,
        )


def _overlap(one: Body, places: Sequence[Place], two: Body, others: Sequence[Place]) -> float:
    """Lower bound of the depth to which bounded shapes of two bodies overlap [m]; 0 if they are apart or merely touch.

    An overlap within the tolerance is treated as touching.
    """
    for (a, size), (b, other) in itertools.product(_placed(one, places), _placed(two, others)):
        (low, high), (below, above) = a.bounds, b.bounds
        if np.any(low > above) or np.any(below > high):
            continue
        found = overlap(a, b, float(touching(min(size, other))))
        if found > 0.0:
            return found
    return 0.0


def _placed(body: Body, places: Sequence[Place]) -> list[tuple[Placed, float]]:
    """Bounded shapes of a body, with its frames at given places, and their extents [m]."""
    return [
        (Placed(pieces, *place), shape.extent)
        for place, shapes in zip(places, body.frames, strict=True)
        for shape in shapes
        if math.isfinite(shape.extent) and (pieces := Pieces.of(shape)) is not None
    ]
