"""Two discs without thickness: whether one passed through the other since the last evaluation of their pair.

Such discs never overlap by a depth, so the separation along a direction cannot show that they passed through each
other. The side on which they are can. In the axes of the first disc, the centre of the second one is taken to move on a
straight line between two evaluations. If that line meets the plane z = 0 within the first disc, the discs intersected.
Parallel discs intersect as soon as their circles overlap there, unless the second one came from a side and parts on the
same side. Discs that are not parallel meet with their rims first, which their contacts find.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import middle_of, to_part, to_world
from nonsmooth.engine.memory.blocks import PART_RINGS
from nonsmooth.engine.native.kernel import Floats, Workspace, at, kernel
from nonsmooth.engine.numerics.vectors import Vector, minus


@kernel("v3(F, i8, i8)")
def _centre(floats: Floats, frame_place: int, place: int) -> Vector:
    """Centre of the circle of the disc at ``place`` in the world [m]. Its frame is at ``frame_place``.

    Both are offsets among the floats. The centre need not be the origin of the axes of the disc.
    """
    rings, middle = at(floats, place + PART_RINGS), middle_of(floats, frame_place, place)
    x, y, z = to_world(floats, frame_place, place, (rings[0], rings[1], rings[2]))
    return middle[0] + x, middle[1] + y, middle[2] + z


@kernel("f8(v3, v3)")
def _offset_in_plane(previous: Vector, current: Vector) -> float:
    """Distance from the origin at which the segment between two points meets the plane z = 0 [m], -1 if it does not.

    For a segment within the plane it is the least distance.
    """
    # part: fraction of the way from the current to the previous point
    dx, dy = previous[0] - current[0], previous[1] - current[1]
    if previous[2] == 0.0 and current[2] == 0.0:
        square = dx * dx + dy * dy
        part = min(1.0, max(0.0, -(current[0] * dx + current[1] * dy) / square)) if square > 0.0 else 0.0
    elif current[2] == 0.0:
        part = 0.0
    elif current[2] * previous[2] < 0.0:
        part = current[2] / (current[2] - previous[2])
    else:
        # on one side, or only the previous point is in the plane
        return -1.0
    return math.hypot(current[0] + part * dx, current[1] + part * dy)


@kernel("f8(ws, i8)")
def crossing_overlap(ws: Workspace, number: int) -> float:
    """Overlap of the discs of pair ``number`` in the plane of the first, where the second passed through [m], else 0.

    The position of the second centre is stored in the pair, as ``between``, for the next evaluation. A pair without a
    margin has no stored position. Discs that are not parallel count by the centre of the second one
    only: their rims meet first. Parallel discs that lie on each other have not passed yet: the position before that
    stays stored. When they separate, it shows on which side the second one came.
    """
    pair = ws.pairs[number]
    between = minus(_centre(ws.floats, pair.frame_b, pair.part_b), _centre(ws.floats, pair.frame_a, pair.part_a))
    x, y, z = to_part(ws.floats, pair.frame_a, pair.part_a, between)
    # axis of the second disc; along the axes of the first, its two components in the plane are the sine of the tilt
    normal = to_world(ws.floats, pair.frame_b, pair.part_b, (0.0, 0.0, 1.0))
    tilt = to_part(ws.floats, pair.frame_a, pair.part_a, normal)
    radius_a, radius_b = at(ws.floats, pair.part_a + PART_RINGS)[3], at(ws.floats, pair.part_b + PART_RINGS)[3]
    # the rim of the second disc rises over the plane by no more than the allowed overlap
    parallel = math.hypot(tilt[0], tilt[1]) * radius_b <= pair.allowed
    # of parallel discs, heights up to the allowed overlap count as in the plane
    current = (x, y, 0.0 if parallel and abs(z) <= pair.allowed else z)
    reach = radius_a + (radius_b if parallel else 0.0)
    is_known, previous = pair.margin > 0.0, pair.between
    lie_on_each_other = parallel and current[2] == 0.0 and math.hypot(x, y) < reach
    came_from_side = previous[2] != 0.0 or math.hypot(previous[0], previous[1]) < reach
    if is_known and lie_on_each_other and came_from_side:
        return 0.0
    pair.between = current
    # a pair that was watched in the last step has not met, on whatever curve the centre moved
    if not is_known or ws.pairs[pair.group].is_watched:
        return 0.0
    offset = _offset_in_plane(previous, current)
    return float(max(0.0, reach - offset)) if offset >= 0.0 else 0.0
