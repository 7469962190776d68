"""Nearest feature of a surface, convex or not, to a point, by a tree of bounding boxes."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import block_at, compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, plus, plus_scaled, scaled, vector_at
from ..features.edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..features.ends import REACH
from .surface_tables import (
    BITS,
    BORDERS,
    CONCAVE,
    CORNER,
    CORNER_PATCH,
    CORNERS,
    EDGE,
    EDGE_PATCH,
    EDGE_PLANES,
    EDGES,
    EXTENSIONS,
    FACE,
    FACE_NUMBER,
    FACE_PATCH,
    FACES,
    FIRST_MEMBER,
    INSIDE,
    MEMBERS,
    N_EDGES,
    N_MEMBERS,
    N_NODES,
    N_PATCHES,
    N_STAR,
    N_TRIANGLES,
    NODE,
    NODES,
    OFFSET,
    PATCH_BITS,
    SIZE,
    SKIP,
    STAR,
    STARS,
    TRIANGLE,
    TRIANGLES,
)

_SAME = 1e-14
"""Largest relative difference of squared distances that are treated as equal: round-off."""
FAR = 1e150
"""Distance for a search without limit [m]."""
ON_FACE, ON_EDGE, ON_CORNER = 0, 1, 2
"""Kinds of features of a surface."""

Found: TypeAlias = tuple[float, float, int, int, float, float, float]
"""Signed distance [m], distance past the end of the feature [m], kind and number of the feature, its nearest point."""


@compiled
def node_at(surface: Floats, node: int) -> int:
    """Return the index at which the row of a node of the tree begins."""
    return int(surface[NODES]) + NODE * node


@compiled
def member_of(surface: Floats, at: int, i: int) -> int:
    """Return the number of member ``i`` of the leaf at index ``at``: a triangle, else a convex edge, else a corner."""
    return int(surface[int(surface[MEMBERS]) + int(surface[at + FIRST_MEMBER]) + i])


@compiled
def face_at(surface: Floats, face: int) -> int:
    """Return the index at which the row of a face begins."""
    return int(surface[FACES]) + FACE * face


@compiled
def edge_at(surface: Floats, edge: int) -> int:
    """Return the index at which the row of a convex edge begins."""
    return int(surface[EDGES]) + EDGE * edge


@compiled
def beyond_ends(surface: Floats, edge: int) -> tuple[float, float]:
    """Return by how much the body extends past the ends of the edge whose row begins at the index ``edge`` [m]."""
    return surface[edge + EXTENSIONS], surface[edge + EXTENSIONS + 1]


@compiled
def feature_of(surface: Floats, member: int) -> tuple[int, int, int]:
    """Return kind and number of the feature of a member, and the index of its row, on a face that of the triangle."""
    edge = member - int(surface[N_TRIANGLES])
    if edge < 0:
        t = int(surface[TRIANGLES]) + TRIANGLE * member
        return ON_FACE, int(surface[t + FACE_NUMBER]), t
    corner = edge - int(surface[N_EDGES])
    if corner < 0:
        return ON_EDGE, edge, edge_at(surface, edge)
    return ON_CORNER, corner, corner_row(surface, corner)


@compiled
def patch_of(surface: Floats, member: int) -> float:
    """Return the number of the patch to which a member belongs."""
    kind, number, at = feature_of(surface, member)
    if kind == ON_FACE:
        return float(surface[face_at(surface, number) + FACE_PATCH])
    return float(surface[at + (EDGE_PATCH if kind == ON_EDGE else CORNER_PATCH)])


@compiled
def corner_row(surface: Floats, corner: int) -> int:
    """Return the index at which the row of a corner begins."""
    return int(surface[CORNERS]) + CORNER * corner


@compiled
def corner_at(surface: Floats, corner: int) -> tuple[Vector3, float, Floats]:
    """Return the place of a corner [m], the number of its edges, and the unit vectors along them."""
    c = corner_row(surface, corner)
    return vector_at(surface, c), surface[c + N_STAR], block_at(surface, int(surface[STARS]) + int(surface[c + STAR]))


@compiled
def box_square(surface: Floats, at: int, point: Vector3) -> float:
    """Return the square of the distance of a point from the box of the node at index ``at`` [m^2]."""
    x, y, z = point
    dx = max(max(surface[at] - x, x - surface[at + 3]), 0.0)
    dy = max(max(surface[at + 1] - y, y - surface[at + 4]), 0.0)
    dz = max(max(surface[at + 2] - z, z - surface[at + 5]), 0.0)
    return float(dx * dx + dy * dy + dz * dz)


@compiled
def face_height(surface: Floats, face: int, point: Vector3) -> float:
    """Return the height of a point over the plane of the face whose row begins at index ``face`` [m]."""
    return float(dot(vector_at(surface, face), point) - surface[face + OFFSET])


@compiled
def past_edges(surface: Floats, triangle: int, height: float, point: Vector3) -> tuple[float, float]:
    """Return two distances of a point past edges of a triangle [m]; negative if the point is inside of all of them.

    The first is the largest distance past any of the three edges.  The second is the largest one past the edges on the
    border of the triangle's face.  Both are measured in the plane of the triangle, and are -inf if no edge counts.
    Below the plane a face does not end at a concave edge: a point inside of the body near an inner corner is below both
    faces.

    ``height`` is the height of the point over the plane [m], ``point`` is in the axes of the surface [m].  The row of
    the triangle begins at index ``triangle``.
    """
    past_any, past_border = -math.inf, -math.inf
    for i in range(3):
        border = surface[triangle + BORDERS + i]
        if height < 0.0 and border == CONCAVE:
            continue
        plane = triangle + EDGE_PLANES + 4 * i
        past = dot(vector_at(surface, plane), point) - surface[plane + 3]
        past_any = max(past_any, past)
        if border != INSIDE:
            past_border = max(past_border, past)
    return past_any, past_border


@compiled
def in_triangle(surface: Floats, triangle: int, point: Vector3) -> tuple[float, float, float, int]:
    """Return a triangle's point nearest to ``point``, and 0 if it is inside, 1 to 3 on an edge, 4 to 6 at a vertex.

    By the regions of C. Ericson, "Real-Time Collision Detection" (Morgan Kaufmann, 2005), section 5.1.5.
    """
    a = vector_at(surface, triangle)
    b, c = minus(vector_at(surface, triangle + 3), a), minus(vector_at(surface, triangle + 6), a)
    p = minus(point, a)
    d1, d2 = dot(b, p), dot(c, p)
    if d1 <= 0.0 and d2 <= 0.0:
        return *a, 4
    bb, bc, cc = dot(b, b), dot(b, c), dot(c, c)
    d3, d4 = d1 - bb, d2 - bc
    if d3 >= 0.0 and d4 <= d3:
        return *plus(a, b), 5
    d5, d6 = d1 - bc, d2 - cc
    if d6 >= 0.0 and d5 <= d6:
        return *plus(a, c), 6
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return *plus_scaled(a, d1 / (d1 - d3), b), 1
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return *plus_scaled(a, d2 / (d2 - d6), c), 3
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return *plus_scaled(plus(a, b), w, minus(c, b)), 2
    return *plus_scaled(plus_scaled(a, vb / (va + vb + vc), b), vc / (va + vb + vc), c), 0


@compiled
def has_patch(surface: Floats, at: int, patch: float) -> bool:
    """Return whether the tree node at index ``at`` may hold features of a patch, of any patch if ``patch`` < 0."""
    return patch < 0.0 or surface[N_PATCHES] > BITS or (int(surface[at + PATCH_BITS]) >> int(patch)) & 1 == 1


@compiled
def first_leaf(surface: Floats, patch: float, point: Vector3) -> int:
    """Return the number of the tree node in which the search for a patch's nearest feature starts: a leaf.

    The leaf may hold features of ``patch`` (of any patch if it is negative).  Its box is near the ``point``, so that
    the distance found there excludes most other leaves.
    """
    node = 0
    while surface[node_at(surface, node) + N_MEMBERS] == 0.0:
        # the left subtree follows its parent, the right one follows the left
        left = node + 1
        right = int(surface[node_at(surface, left) + SKIP])
        row_left, row_right = node_at(surface, left), node_at(surface, right)
        is_nearer = box_square(surface, row_left, point) <= box_square(surface, row_right, point)
        takes_left = has_patch(surface, row_left, patch) and (is_nearer or not has_patch(surface, row_right, patch))
        node = left if takes_left else right
    return node


@compiled
def outward_of(surface: Floats, face: int, triangle: int, point: Vector3) -> tuple[float, float]:
    """Return the squared distance of a point from a triangle [m^2], and a number that is negative inside of the body.

    The sign is that of the body if the triangle is the nearest one.  It comes from the normal at the nearest point; on
    edges and at vertices, from normals weighted by angles: J. A. Baerentzen, H. Aanaes, "Signed distance computation
    using the angle weighted pseudonormal", IEEE Transactions on Visualization and Computer Graphics 11 (2005) 243-253.
    The row of the triangle begins at the index ``triangle``.
    """
    qx, qy, qz, region = in_triangle(surface, triangle, point)
    apart = minus(point, (qx, qy, qz))
    n = triangle + BORDERS + 3 * region if region > 0 else face_at(surface, face)
    return dot(apart, apart), dot(apart, vector_at(surface, n))


@compiled
def signed_distance(surface: Floats, point: Vector3) -> float:
    """Return the distance of a point, in the axes of the surface, from the surface [m]; negative inside of the body."""
    # first the leaf next to the point, whose squared distance excludes most of the others, then the whole tree
    least, side = math.inf, 0.0
    first = first_leaf(surface, -1.0, point)
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        if node >= 0 and box_square(surface, at, point) > least:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            what, face, t = feature_of(surface, member_of(surface, at, i))
            if what == ON_FACE:
                square, outward = outward_of(surface, face, t, point)
                if square < least:
                    least, side = square, outward
        node += 1
    return float(-(least**0.5) if side < 0.0 else least**0.5)


@compiled
def depth_inside(surface: Floats, point: Vector3) -> float:
    """Return how far a point is inside of the body [m], 0 outside."""
    if box_square(surface, node_at(surface, 0), point) > 0.0:
        return 0.0
    return max(-signed_distance(surface, point), 0.0)


@compiled
def past_edge(surface: Floats, edge: int, point: Vector3) -> tuple[float, Vector3]:
    """Return how far a point is past the points and normals of an edge [m], and the edge's point nearest to it."""
    w, along = minus(point, vector_at(surface, edge)), vector_at(surface, edge + ALONG)
    s = dot(w, along)
    past = max(-s, s - surface[edge + LENGTH])
    w = minus(w, scaled(min(max(s, 0.0), surface[edge + LENGTH]), along))
    past = max(past, max(dot(w, vector_at(surface, edge + INTO_FIRST)), dot(w, vector_at(surface, edge + INTO_SECOND))))
    return past, minus(point, w)


@compiled
def past_corner(surface: Floats, corner: int, point: Vector3) -> float:
    """Return how far a point is past the normals of a corner [m]."""
    return float(steepest(surface, corner, minus(point, vector_at(surface, corner))))


@compiled
def steepest(surface: Floats, corner: int, n: Vector3) -> float:
    """Return the largest component of n along an edge of a corner, in the axes of the surface."""
    most, star = -math.inf, int(surface[STARS]) + int(surface[corner + STAR])
    for i in range(int(surface[corner + N_STAR])):
        most = max(most, dot(n, vector_at(surface, star + 3 * i)))
    return most


@compiled
def nearest_in_patch(surface: Floats, patch: float, point: Vector3, reach: float) -> Found:
    """Return the nearest feature of a patch that a ball about a ``point``, in the axes of the surface, may touch.

    A ball may touch a feature if no neighbouring point of the surface is nearer: the distance past the feature's end is
    then not positive.  If the ball may touch no feature, the result is the feature with the least sum of two squares,
    of the distance and of the distance past the end.  Within the margin at the border of a face and its edge, or of an
    edge and its corner, the ball may touch both; the face is preferred to the edge, the edge to the corner.  If no
    feature is nearer than ``reach`` [m], distance and distance past the end are ``reach``.
    """
    x, y, z = point
    # the only patch has no end
    margin = REACH * surface[SIZE] if surface[N_PATCHES] > 1.0 else 0.0
    # difference of squared distances that are equal within the margins of two features
    same = 4.0 * margin * margin
    best, distance, past, kind, number = reach * reach, reach, reach, ON_FACE, 0
    nearest = x, y, z - reach
    # the least deep face above the point, if the point is inside of the body
    depth, depth_past, depth_face = math.inf, 0.0, -1
    first = first_leaf(surface, patch, point)
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        tie = same + _SAME * best
        if node >= 0 and (not has_patch(surface, at, patch) or box_square(surface, at, point) > best + tie):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            member, tie = member_of(surface, at, i), same + _SAME * best
            what, which, row = feature_of(surface, member)
            if patch_of(surface, member) != patch:
                continue
            if what == ON_FACE:
                f = face_at(surface, which)
                height = face_height(surface, f, point)
                if height * height > best + tie:
                    continue
                past_any, past_border = past_edges(surface, row, height, point)
                if past_any <= margin and height < 0.0 and -height < depth:
                    depth, depth_past, depth_face = -height, past_border - margin, which
                if past_any <= margin and height >= 0.0:
                    foot = minus(point, scaled(height, vector_at(surface, f)))
                    past_end, p = max(past_border, -surface[SIZE]), foot
                else:
                    px, py, pz, _ = in_triangle(surface, row, point)
                    past_end, p = max(past_any, -height + 2.0 * margin), (px, py, pz)
            elif what == ON_EDGE:
                past_end, p = past_edge(surface, row, point)
            else:
                past_end, p = past_corner(surface, row, point), vector_at(surface, row)
            past_end -= margin
            apart = minus(point, p)
            square = dot(apart, apart)
            key = square + max(past_end, 0.0) * max(past_end, 0.0)
            is_tie = key < best + tie and past_end <= 0.0
            if key < best - tie or (is_tie and (past > 0.0 or what < kind)):
                best, distance, past, kind, number, nearest = key, square**0.5, past_end, what, which, p
        node += 1
    if depth_face >= 0 and depth * depth < best and depth_inside(surface, point) > 0.0:
        normal = vector_at(surface, face_at(surface, depth_face))
        return -depth, depth_past, ON_FACE, depth_face, *plus_scaled(point, depth, normal)
    return distance, past, kind, number, *nearest


@compiled
def distance_from_ends(surface: Floats, found: Found) -> float:
    """Return the distance of a nearest point from the nearer end of its edge [m]: 0 at a corner, infinite on a face."""
    _, _, kind, number, x, y, z = found
    if kind == ON_CORNER:
        return 0.0
    if kind != ON_EDGE:
        return math.inf
    row = edge_at(surface, number)
    along = dot(minus((x, y, z), vector_at(surface, row)), vector_at(surface, row + ALONG))
    return float(min(along, surface[row + LENGTH] - along))
