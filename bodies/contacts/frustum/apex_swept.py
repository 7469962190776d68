"""Contact of the apex of a cone with a polyhedron or a capsule, if one of the two is rounded."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, SIN, SWEEP
from ...vectors import dot, opposite
from ..features.frames import point_in_body, vector_in_world
from ..features.polytope_tables import N_FACES, edges_of
from ..features.swept_vertex import END, write_vertex_over
from ..features.vertex_face import nearest_of_core
from .frustum import axis_in_world, on_axis_in_world


@compiled
def past_apex(frustum: Floats, distance: float, axial: float, size: float) -> float:
    """Return the distance of the other body's nearest point past the apex [m], less the tolerance ``2 END size``.

    It is the coordinate of this point along a straight line on the cone's side, from the apex downwards.  If the result
    is positive, the side is nearer to the point than the apex.  The point lies at ``distance`` [m] from the apex;
    ``axial`` is the component, along the cone's axis, of the unit vector from the apex to the point.  ``size`` is the
    size of the bodies [m].
    """
    radial = math.sqrt(max(1.0 - axial * axial, 0.0))
    return float(max(distance * (frustum[SIN] * radial - frustum[COS] * axial), -size) - 2.0 * END * size)


def evaluate_apex_over_core(
    a: Floats, b: Floats, out: Floats, first: Floats, core: Floats, sweep: float, size: float
) -> None:
    """Write the geometry block of a cone's apex and the nearest face or edge of a core, rounded by ``sweep`` [m].

    ``first`` is the cone, ``core`` the core of the second body, ``size`` the size of the bodies [m].
    """
    axis, p = axis_in_world(a, first), on_axis_in_world(a, first, first[HIGH])
    found = nearest_of_core(core, point_in_body(b, p))
    n = vector_in_world(b, (found[2], found[3], found[4]))
    past = past_apex(first, found[1], dot(opposite(n), axis), size)
    write_vertex_over(a, b, out, 1.0, p, first[SWEEP], found, past, core[N_FACES], *edges_of(core), sweep, size)
