"""Distance of two convex parts at any places, or the depth of their overlap, by the compiled search of the engine.

The engine reads parts and frames from its workspace. Each thread has one workspace with a single pair of parts, into
which a call writes its two parts (:mod:`nonsmooth.engine.pairs.measure`).
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME, PART_RINGS, RING
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.memory import allocate
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import call_alone
from nonsmooth.interfaces.convex_part import ConvexPart
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector

_TOUCHING = 1e-6
"""Gap or overlap of bodies that touch, relative to the smaller one."""
_OF_POINT = 1e-9
"""The same of a point [m], which has no size."""
_POSE = 12
"""Length of position and rotation matrix of a frame, with which its numbers begin."""


def touching(size: Any) -> Any:
    """Largest gap or overlap of two bodies that touch [m]: 1e-6 of the ``size`` [m] of the smaller one.

    It is 1e-9 m for a point, which has no size.
    """
    return np.where(np.asarray(size) > 0.0, _TOUCHING * size, _OF_POINT)


def numbers_of(part: ConvexPart) -> list[float]:
    """Numbers of a convex part as the engine reads them (:mod:`nonsmooth.engine.memory.blocks`).

    After the head come the circles, then the support function (address and parameters) of a shape that has one.
    """
    # -1 marks a half-space, and place 0 a part without a support function
    n_rings = -1 if part.is_half_space else len(part.rings)
    function_place = PART_RINGS + RING * len(part.rings) if part.function else 0
    head = *part.place, *np.ravel(part.axes), *part.semi, *part.powers, part.ball, part.radius, function_place, n_rings
    return [float(number) for number in (*head, *np.ravel(part.rings), *part.function)]


@final
@dataclass(frozen=True, eq=False)
class PartNumbers:
    """A convex part as the engine reads it.

    Attributes
    ----------
    numbers : Vector
        Numbers of the part (:func:`numbers_of`).
    radius : float
        Radius of a ball about the origin of the part that holds it [m]; infinite for a half-space.
    """

    numbers: Vector
    radius: float

    @classmethod
    def of(cls, part: ConvexPart) -> PartNumbers:
        """Numbers of a part."""
        return cls(np.array(numbers_of(part)), part.radius)

    @property
    def middle(self) -> Vector:
        """Origin of the part in the frame of the body [m], shape [3]."""
        return self.numbers[:3]


@final
@dataclass(frozen=True, eq=False)
class Measured:
    """Distance of two convex parts, or the depth of their overlap.

    Attributes
    ----------
    separation : float
        Distance of two parallel planes normal to ``normal`` that touch the parts from outside [m]: the distance of the
        parts, and a lower bound of it. If the parts overlap, it is negative, and a translation of this length along
        ``normal`` separates them.
    upper : float
        Upper bound of the separation [m]; negative only if a polytope proves the overlap.
    normal : Vector
        Unit vector from the first to the second part, shape [3].
    first, second : Vector
        Nearest point of each part, or deepest in the other one [m], shape [3].
    """

    separation: float
    upper: float
    normal: Vector
    first: Vector
    second: Vector

    def exchanged(self) -> Measured:
        """The same with the first and the second part exchanged."""
        return Measured(self.separation, self.upper, -self.normal, self.second, self.first)


@final
class _Bench:
    """A workspace with one pair of parts, of at most ``room`` numbers each."""

    def __init__(self, room: int) -> None:
        self.room = room
        memory = allocate({**dict.fromkeys(COUNTS, 0), "n_pairs": 1, "n_carriers": 2})
        blocks = Heap(memory)
        self._starts = [blocks.block(size) for size in (FRAME, FRAME, room, room)]
        self._memory = memory = blocks.close()
        pair = owners.Pair
        for field, start in zip((pair.frame_a, pair.frame_b, pair.part_a, pair.part_b), self._starts, strict=True):
            memory[field][0] = start
        self._size, self._direction = memory[pair.size], memory[pair.measured][0]
        self._separation, self._shallowest = memory[pair.separation], memory[pair.shallowest]
        self._first, self._second = memory[pair.first][0], memory[pair.second][0]

    def measure(self, first: PartNumbers, one: Place, second: PartNumbers, two: Place) -> Measured:
        """Measure two parts, of which only the first may be a half-space."""
        floats, (frame_a, frame_b, part_a, part_b) = self._memory.floats, self._starts
        origin = one[0]
        # about the origin of the first frame, so that no digits are lost far from that of the world
        for start, (place, axes) in ((frame_a, one), (frame_b, two)):
            floats[start : start + 3] = place - origin
            floats[start + 3 : start + _POSE] = axes.ravel()
        floats[part_a : part_a + len(first.numbers)] = first.numbers
        floats[part_b : part_b + len(second.numbers)] = second.numbers
        # a point has no size
        small, large = sorted((first.radius, second.radius))
        self._size[0] = small if small > 0.0 or np.isinf(large) else large
        self._direction[:] = 0.0
        call_alone("measure_pair", self._memory, 0)
        return Measured(
            float(self._separation[0]),
            float(self._shallowest[0]),
            self._direction.copy(),
            self._first + origin,
            self._second + origin,
        )


class _Benches(threading.local):
    """The workspace of each thread, which grows with the parts."""

    bench: _Bench | None = None

    def of(self, room: int) -> _Bench:
        """The workspace of this thread, for parts of at most ``room`` numbers."""
        if self.bench is None or self.bench.room < room:
            self.bench = _Bench(2 * room)
        return self.bench


_benches = _Benches()


def measure(first: PartNumbers, one: Place, second: PartNumbers, two: Place) -> Measured:
    """Distance of two convex parts, or the depth of their overlap, with bounds and nearest points.

    Parameters
    ----------
    first, second : PartNumbers
        The parts. One of them may be a half-space.
    one, two : Place
        Places of the frames of their bodies.
    """
    if np.isinf(second.radius):
        return measure(second, two, first, one).exchanged()
    return _benches.of(max(len(first.numbers), len(second.numbers))).measure(first, one, second, two)
