"""Contact of a convex edge of a surface that crosses the side or a rim of a cylinder, a cone or a disc.

The crossing depends on the edge alone (:mod:`bodies.contacts.frustum.flank_edge`,
:mod:`bodies.contacts.frustum.rim_edge`).  The rest of the surface decides whether the overlap is real and whether a
face is nearer.
"""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, minus, norm, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import sine_off_cone
from ..features.ends import CLOSED, gap_past_end
from ..features.frames import across, point_in_body
from ..surface.overlap_corners import FLUSH
from ..surface.surface_search import edge_at, past_edge, signed_distance
from ..surface.surface_tables import IS_CONVEX, N_TRIANGLES, SWEEP
from .flank_edge import write_edge_across_side
from .frustum import axis_in_world, center_in_world, nearest_part
from .rim_edge import write_edge_across_rim
from .rim_face import frustum_in_surface, past_faces

_CONE_MARGIN = 1e-6
"""Sine of the largest angle between a contact normal and the edge's normal cone; if it is larger, a face is nearer."""


@compiled
def _outside(surface: Floats, point: Vector3) -> float:
    """Return the distance of a point, in the axes of the surface, from the body [m]; negative inside of it."""
    if surface[N_TRIANGLES] == 0.0:
        _, nearest = past_edge(surface, edge_at(surface, 0), point)
        return norm(minus(point, nearest)) - surface[SWEEP]
    return float(signed_distance(surface, point) - surface[SWEEP])


@compiled
def _past_bodies(a: Floats, b: Floats, out: Floats, frustum: Floats, surface: Floats, size: float) -> float:
    """Return by how far both contact points of a crossing are outside of the other body [m]; positive: no overlap.

    The frustum belongs to the first body, the surface to the second one; ``out`` is the geometry block.  If flush
    faces are pressed into each other, the points lie on the surface of the other body: the margin is that of round-off,
    ``CLOSED``, and of the angle ``FLUSH`` of such faces.
    """
    margin = CLOSED * size - FLUSH * out[GAP]
    outside = _outside(surface, point_in_body(b, vector_at(out, POINT_A)))
    if outside > margin:
        along, away, _ = across(minus(vector_at(out, POINT_B), center_in_world(a, frustum)), axis_in_world(a, frustum))
        outside = min(outside, nearest_part(frustum, along, away)[0] - frustum[FRUSTUM_SWEEP])
    return float(outside - margin)


@compiled
def _open_if_invalid(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Change the geometry block of a frustum and an edge of a surface to an open contact in two cases.

    - The cores are apart or overlap by less than the margin ``CLOSED``, and the contact normal is outside of the edge's
      normal cone: a face is nearer, and has its own contact with the frustum.
    - The cores overlap by more, but neither contact point is inside of the other body, so that they do not overlap
      there, or a face is less deep (:func:`bodies.contacts.frustum.rim_face.past_faces`).

    ``edge`` is the row of the edge, ``size`` the size of the bodies [m].
    """
    gap, past = out[GAP], 0.0
    if out[PAST_END] > 0.0:
        return
    if gap + frustum[FRUSTUM_SWEEP] + surface[SWEEP] >= -CLOSED * size:
        off_cone = sine_off_cone(b, edge, 0, -1.0, vector_at(out, NORMAL))
        past = size * (off_cone - _CONE_MARGIN)
    else:
        pose, point = frustum_in_surface(a, b, frustum), point_in_body(b, vector_at(out, POINT_A))
        past = _past_bodies(a, b, out, frustum, surface, size)
        past = max(past, past_faces(surface, frustum, pose, -gap, point))
    if past > 0.0:
        out[GAP], out[PAST_END] = gap_past_end(gap, past, surface[IS_CONVEX] == 1.0), past
        write_vector(out, POINT_B, plus_scaled(vector_at(out, POINT_A), out[GAP], vector_at(out, NORMAL)))


@compiled
def write_across_side(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Write the geometry block of an edge of a surface, by its row ``edge``, that crosses the side of a frustum."""
    write_edge_across_side(a, b, out, frustum, edge, surface[SWEEP], surface[IS_CONVEX] == 1.0, size)
    _open_if_invalid(a, b, out, frustum, edge, surface, size)


@compiled
def write_across_rim(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    rim: float,
    half: float,
    edge: Floats,
    surface: Floats,
    size: float,
) -> None:
    """Write the geometry block of an edge of a surface, by its row ``edge``, that crosses one half of a rim.

    ``rim`` and ``half`` are those of :func:`bodies.contacts.frustum.rim_edge.write_edge_across_rim`.
    """
    write_edge_across_rim(a, b, out, frustum, rim, half, edge, surface[SWEEP], surface[IS_CONVEX] == 1.0, size)
    _open_if_invalid(a, b, out, frustum, edge, surface, size)
