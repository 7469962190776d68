"""Two discs without thickness: whether one went through the other since they were looked at last.

They overlap by no depth, so that no separation tells it.  Sides tell it: the centre of the second disc was on one side
of the first one's plane, is on the other side or in the plane, and went through the plane where the discs overlap.
Parallel discs overlap there if their circles do; of others only the centre is known to be there, and their rims meet
before, which contacts see.  All is seen from the first disc: what moves with both is no motion.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import PART_RINGS
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, frame_at, kernel, pair_at, part_at
from nonsmooth.engine.numerics.vectors import Vector, minus
from nonsmooth.engine.pairs.support import middle_of, turned, turned_back


@kernel("v3(F, i8, i8)")
def _centre(w: Floats, frame_place: int, place: int) -> Vector:
    """Return the centre of the circle of a part in the world."""
    rings, middle = at(w, place + PART_RINGS), middle_of(w, frame_place, place)
    x, y, z = turned(frame_at(w, frame_place).rotation, turned(part_at(w, place).axes, (rings[0], rings[1], rings[2])))
    return middle[0] + x, middle[1] + y, middle[2] + z


@kernel("v3(F, i8, i8, v3)")
def _seen_from(w: Floats, frame_place: int, place: int, v: Vector) -> Vector:
    """Return a vector of the world in the axes of a part."""
    return turned_back(part_at(w, place).axes, turned_back(frame_at(w, frame_place).rotation, v))


@kernel("f8(v3, v3, f8)")
def _aside(last: Vector, here: Vector, thin: float) -> float:
    """Return how far from the first centre the second one met the plane on its way [m], -1 if it did not."""
    dx, dy = last[0] - here[0], last[1] - here[1]
    if max(abs(here[2]), abs(last[2])) <= thin:
        way = dx * dx + dy * dy
        back = min(1.0, max(0.0, -(here[0] * dx + here[1] * dy) / way)) if way > 0.0 else 0.0
    elif abs(here[2]) <= thin:
        back = 0.0
    elif here[2] * last[2] < 0.0:
        back = here[2] / (here[2] - last[2])
    else:
        return -1.0
    return math.hypot(here[0] + back * dx, here[1] + back * dy)


@kernel("f8(S, F, I, i8)")
def crossed(S: Scalars, w: Floats, k: Integers, number: int) -> float:
    """Return by how much the discs of a pair overlapped within the plane in which they met [m], 0 if they did not."""
    pair = pair_at(S, w, k, number)
    between = minus(_centre(w, pair.frame_b, pair.part_b), _centre(w, pair.frame_a, pair.part_a))
    here = _seen_from(w, pair.frame_a, pair.part_a, between)
    last = pair.between if pair.room > 0.0 else here
    pair.between = here
    aside = _aside(last, here, pair.allowed)
    if aside < 0.0:
        return 0.0
    normal = turned(frame_at(w, pair.frame_b).rotation, turned(part_at(w, pair.part_b).axes, (0.0, 0.0, 1.0)))
    tilt = _seen_from(w, pair.frame_a, pair.part_a, normal)
    radius_a, radius_b = at(w, pair.part_a + PART_RINGS)[3], at(w, pair.part_b + PART_RINGS)[3]
    parallel = math.hypot(tilt[0], tilt[1]) * radius_b <= pair.allowed
    return float(max(0.0, radius_a + (radius_b if parallel else 0.0) - aside))
