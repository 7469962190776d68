"""Support points of convex parts, and the separation of two parts along a direction.

A part is the sum of three convex sets: the hull of circles about its third axis (points have radius 0), an ellipsoid, a
norm ball of other powers or the set of a plug-in, and a ball. The support point of a sum is the sum of the support
points. So the shapes need no meshes.

The separation s(n) = min over b of n . b - max over a of n . a is the distance by which all of the second part is
beyond all of the first part along the unit vector n. It is a lower bound of the signed distance for every n.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import PART_RINGS, RING
from nonsmooth.engine.native.kernel import Floats, Pair, Workspace, at, call_support, frame_at, kernel, part_at
from nonsmooth.engine.numerics.vectors import Vector, are_alike, dot, minus, opposite


@kernel("v3(F, v3)")
def turned(axes: Floats, v: Vector) -> Vector:
    """R v for a rotation matrix R, row by row: components along the outer axes from those along a body's or part's."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


@kernel("v3(F, v3)")
def turned_back(axes: Floats, v: Vector) -> Vector:
    """R^T v for a rotation matrix R: components along the axes of a body or part from those along the outer axes."""
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )


@kernel("v3(F, i8, v3)")
def _farthest_on_circles(floats: Floats, place: int, n: Vector) -> Vector:
    """Point of the hull of a part's circles that is farthest along ``n`` [m], in the axes of the part.

    The circles are about its third axis. The point is the origin if there are no circles.
    """
    rings = at(floats, place + PART_RINGS)
    x, y, z = n
    # component of n in the planes of the circles
    across = math.sqrt(x * x + y * y)
    best, found = -math.inf, 0
    for i in range(0, RING * int(part_at(floats, place).rings), RING):
        # n times the centre of a circle, and its radius times the component in its plane
        height = rings[i] * x + rings[i + 1] * y + rings[i + 2] * z + rings[i + 3] * across
        if height > best:
            best, found = height, i
    if best == -math.inf:
        return 0.0, 0.0, 0.0
    # along the axis all points of the circle are as far: take its centre
    part = rings[found + 3] / across if across > 0.0 else 0.0
    return rings[found] + part * x, rings[found + 1] + part * y, rings[found + 2]


@kernel("v3(F, i8, v3)")
def _gradient_of_norm(floats: Floats, place: int, n: Vector) -> Vector:
    """Gradient of ((|a n_x|^q + |b n_y|^q)^(p/q) + |c n_z|^p)^(1/p) at ``n``: support of a superellipsoid [m].

    Sums of powers are scaled by their largest term, so that large powers do not overflow. a, b, c are the semi-axes.
    """
    part = part_at(floats, place)
    a, b, c = part.semi
    p, q = part.powers[0], part.powers[1]
    ax, by, cz = abs(a * n[0]), abs(b * n[1]), abs(c * n[2])
    # wide becomes the norm of the first two components, high that of all three
    wide = max(ax, by)
    if wide > 0.0:
        wide *= ((ax / wide) ** q + (by / wide) ** q) ** (1.0 / q)
    high = max(wide, cz)
    # only along axes without extent: the set does not reach beyond its centre there
    if high == 0.0:
        return 0.0, 0.0, 0.0
    high *= ((wide / high) ** p + (cz / high) ** p) ** (1.0 / p)
    round_axis = (wide / high) ** (p - 1.0)
    x = (ax / wide) ** (q - 1.0) * round_axis if wide > 0.0 else 0.0
    y = (by / wide) ** (q - 1.0) * round_axis if wide > 0.0 else 0.0
    return math.copysign(a * x, n[0]), math.copysign(b * y, n[1]), math.copysign(c * (cz / high) ** (p - 1.0), n[2])


@kernel("v3(F, i8, v3)")
def _farthest_of_summands(floats: Floats, place: int, n: Vector) -> Vector:
    """Support point along the unit vector ``n`` of what is added to a part's circles [m], in the axes of the part.

    It is a set of a plug-in, an ellipsoid (powers of 2) or another norm ball, and a ball. What a part does not have is
    0: the address ``function`` of the plug-in, the semi-axes, or the radius of the ball.
    """
    part = part_at(floats, place)
    x, y, z = 0.0, 0.0, 0.0
    if part.function > 0.0:
        x, y, z = call_support(at(floats, place), int(part.function), n[0], n[1], n[2])
    elif part.semi[0] > 0.0:
        # an ellipsoid needs no powers
        if part.powers[0] == 2.0 and part.powers[1] == 2.0:
            ax, by, cz = part.semi[0] * n[0], part.semi[1] * n[1], part.semi[2] * n[2]
            size = math.sqrt(ax * ax + by * by + cz * cz)
            x, y, z = part.semi[0] * ax / size, part.semi[1] * by / size, part.semi[2] * cz / size
        else:
            x, y, z = _gradient_of_norm(floats, place, n)
    return x + part.ball * n[0], y + part.ball * n[1], z + part.ball * n[2]


@kernel("v3(F, i8, i8, v3)")
def to_world(floats: Floats, frame_place: int, place: int, v: Vector) -> Vector:
    """World components of a vector ``v`` that is given along the axes of the part at offset ``place``."""
    return turned(frame_at(floats, frame_place).rotation, turned(part_at(floats, place).axes, v))


@kernel("v3(F, i8, i8, v3)")
def to_part(floats: Floats, frame_place: int, place: int, v: Vector) -> Vector:
    """Components of a world vector ``v`` along the axes of the part at offset ``place``."""
    return turned_back(part_at(floats, place).axes, turned_back(frame_at(floats, frame_place).rotation, v))


@kernel("v3(F, i8, i8)")
def middle_of(floats: Floats, frame_place: int, place: int) -> Vector:
    """Origin of the axes of the part at offset ``place``, in the world [m]. Its frame is at ``frame_place``."""
    frame = frame_at(floats, frame_place)
    x, y, z = turned(frame.rotation, part_at(floats, place).place)
    return frame.origin[0] + x, frame.origin[1] + y, frame.origin[2] + z


@kernel("v3(F, i8, i8, v3)")
def _farthest(floats: Floats, frame_place: int, place: int, n: Vector) -> Vector:
    """Support point of a part along the unit vector ``n`` [m], both in the world."""
    # a part is the sum of a hull of circles and of other convex sets, and so are their support points
    along = to_part(floats, frame_place, place, n)
    rx, ry, rz = _farthest_on_circles(floats, place, along)
    ax, ay, az = _farthest_of_summands(floats, place, along)
    x, y, z = to_world(floats, frame_place, place, (rx + ax, ry + ay, rz + az))
    mx, my, mz = middle_of(floats, frame_place, place)
    return mx + x, my + y, mz + z


@kernel("v3(ws, Pair)")
def known_direction(ws: Workspace, pair: Pair) -> Vector:
    """Direction of a pair in the world: the stored one turns with the first part. Zero if none is known."""
    return turned(frame_at(ws.floats, pair.frame_a).rotation, pair.direction)


@kernel("void(ws, Pair, v3)")
def store_direction(ws: Workspace, pair: Pair, n: Vector) -> None:
    """Store a unit vector ``n`` of the world as the direction of a pair, in the axes of both frames."""
    pair.direction = turned_back(frame_at(ws.floats, pair.frame_a).rotation, n)
    pair.facing = turned_back(frame_at(ws.floats, pair.frame_b).rotation, n)


@kernel("v3(ws, i8, v3)")
def farthest_of_first(ws: Workspace, number: int, n: Vector) -> Vector:
    """Support point of the first part of pair ``number`` along the unit vector ``n`` [m], both in the world."""
    pair = ws.pairs[number]
    return _farthest(ws.floats, pair.frame_a, pair.part_a, n)


@kernel("v3(ws, i8, v3)")
def farthest_of_second(ws: Workspace, number: int, n: Vector) -> Vector:
    """Support point of the second part of pair ``number`` along the unit vector ``n`` [m], both in the world."""
    pair = ws.pairs[number]
    return _farthest(ws.floats, pair.frame_b, pair.part_b, n)


@kernel("v3(ws, i8, v3)")
def closest_difference(ws: Workspace, number: int, n: Vector) -> Vector:
    """Vector from the support point of the first part of a pair along ``n`` to that of the second along -``n`` [m].

    The separation s(n) is its component along ``n``.
    """
    return minus(farthest_of_second(ws, number, opposite(n)), farthest_of_first(ws, number, n))


@kernel("v3(ws, Pair, b1, v3)")
def support_offset(ws: Workspace, pair: Pair, is_second: bool, n: Vector) -> Vector:
    """Support point of the second or the first part of a pair along the unit vector ``n``, from its origin [m]."""
    frame, part = (pair.frame_b, pair.part_b) if is_second else (pair.frame_a, pair.part_a)
    return minus(_farthest(ws.floats, frame, part, n), frame_at(ws.floats, frame).origin)


@kernel("f8(ws, i8, v3)")
def separation_along(ws: Workspace, number: int, n: Vector) -> float:
    """Separation s(n) of pair ``number`` of bounded parts along the unit vector ``n`` [m], negative if they overlap."""
    return dot(n, closest_difference(ws, number, n))


@kernel("b1(ws, i8)")
def is_of_one_part_each(ws: Workspace, number: int) -> bool:
    """True if pair ``number`` is guarded, and if each of its two shapes is convex: a single part."""
    has_others = number + 1 < ws.model.n_pairs and ws.pairs[number + 1].group == number
    return ws.pairs[number].is_guarded and not has_others


@kernel("v3(Pair, v3)")
def along_pair(pair: Pair, n: Vector) -> Vector:
    """Direction from the first to the second part of a pair, for a contact normal ``n`` from body to body."""
    return opposite(n) if pair.is_swapped else n


@kernel("v3(ws, Pair, b1)")
def normal_of_either(ws: Workspace, pair: Pair, of_second: bool) -> Vector:
    """Stored direction of a pair in the world, a unit vector; zero if none is known.

    The direction is often the normal of a face, which turns with its part. So it turns with the second part if
    ``of_second``, else with the first part.
    """
    if of_second:
        return turned(frame_at(ws.floats, pair.frame_b).rotation, pair.facing)
    return known_direction(ws, pair)


@kernel("f8(ws, Pair)")
def separation_along_held(ws: Workspace, pair: Pair) -> float:
    """Separation of a pair along its stored direction, turned with the first or the second part: the larger one [m]."""
    of_first = separation_along(ws, pair.index, normal_of_either(ws, pair, False))
    return float(max(of_first, separation_along(ws, pair.index, normal_of_either(ws, pair, True))))


@kernel("b1(ws, i8, v3, f8)")
def separates(ws: Workspace, number: int, n: Vector, near: float) -> bool:
    """True if the normal ``n`` of a near contact separates two convex shapes as well as the direction of their pair.

    The normal of a contact that touches does: along any other direction the shapes overlap. ``n`` points from the first
    body of the contact to the second. ``near`` is the largest gap of surfaces next to each other [m]. The result is
    False if the shapes are farther apart than ``near``, and the clearance of their feet, along the direction of the
    pair. It is also False if ``n`` is opposite to that direction: discs without thickness in one plane touch along
    both, but they came from one side.

    The result is True, and the contacts decide, in four cases: shapes with several parts, a pair that is not guarded, a
    pair without a stored direction, and shapes that overlap by more than ``near`` and the clearance, as on springs.
    """
    pair = ws.pairs[number]
    first, second = normal_of_either(ws, pair, False), normal_of_either(ws, pair, True)
    if not is_of_one_part_each(ws, number) or dot(first, first) == 0.0:
        return True
    largest, of_second = separation_along(ws, number, first), separation_along(ws, number, second)
    known = second if of_second > largest else first
    largest = max(largest, of_second)
    along = along_pair(pair, n)
    if are_alike(opposite(along), known):
        return False
    # feet may extend beyond the parts by the clearance
    allowed = near + pair.clearance
    if largest < -allowed:
        return True
    # one gap tolerance suffices, except in two cases: the normals of flush faces differ by round-off, which changes the
    # separation by more than that; and feet protrude from the parts
    is_exact = pair.clearance == 0.0 and not are_alike(along, known)
    least = largest - ws.tolerance.gap if is_exact else -2.0 * allowed
    return largest <= allowed and separation_along(ws, number, along) >= least


@kernel("b1(ws, i8)")
def has_half_space(ws: Workspace, number: int) -> bool:
    """True if the first part of pair ``number`` is a half-space."""
    # its number of circles is -1
    return bool(part_at(ws.floats, ws.pairs[number].part_a).rings < 0.0)


@kernel("v3(ws, i8)")
def normal_of_plane(ws: Workspace, number: int) -> Vector:
    """Unit normal of the half-space that is the first part of pair ``number``: the third axis of its frame."""
    frame = frame_at(ws.floats, ws.pairs[number].frame_a)
    return frame.rotation[2], frame.rotation[5], frame.rotation[8]


@kernel("f8(ws, i8)")
def height_above_plane(ws: Workspace, number: int) -> float:
    """Separation of pair ``number``, whose first part is a half-space [m], by the lowest point of the second part.

    The half-space is below the plane through the origin of that part, normal to the third axis of its frame.
    """
    pair, up = ws.pairs[number], normal_of_plane(ws, number)
    lowest = farthest_of_second(ws, number, opposite(up))
    return dot(up, minus(lowest, middle_of(ws.floats, pair.frame_a, pair.part_a)))
