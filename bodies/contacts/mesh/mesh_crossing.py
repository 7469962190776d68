"""Contact of a convex edge of a mesh that crosses the side or a rim of a cylinder, a cone or a disc.

The crossing of side or rim and edge alone is that of a polyhedron's edge.  Here the rest of the mesh decides whether
the overlap is real and whether a face is nearer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B
from nonsmooth.interfaces import FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_body
from ...shapes.frustum import SIDE, SWEEP
from ...vectors import Vector3, minus, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import sine_off_cone
from ..features.frames import across, point_in_body
from ..features.vertex_face import CLOSED
from ..frustum.flank_edge import write_edge_across_side
from ..frustum.frustum import RIM_NAMES, center_in_world, nearest_part, rims_of
from ..frustum.rim_edge import write_edge_across_rim
from ..smooth.smooth_core import Axes, axes_in_world
from ..surface.surface_search import depth_inside
from ..surface.surface_tables import Numbers, edge_row, surface_numbers

_CONE_MARGIN = 1e-6
"""Sine of the largest angle between a contact normal and the edge's normal cone; if it is larger, a face is nearer."""


@compiled
def _is_apart(b: Floats, out: Floats, frustum: Floats, axes: Axes, center: Vector3, surface: Floats) -> bool:
    """Return whether both contact points of a crossing, in the geometry block ``out``, are outside of the other body.

    ``center`` [m] and ``axes`` are those of the frustum in the world; the surface belongs to the body with the frame
    ``b``.
    """
    if depth_inside(surface, point_in_body(b, vector_at(out, POINT_A))) > 0.0:
        return False
    along, away, _ = across(minus(vector_at(out, POINT_B), center), (axes[2], axes[5], axes[8]))
    outside, _, _, _ = nearest_part(frustum, along, away)
    return bool(outside >= frustum[SWEEP])


@compiled
def _open_if_invalid(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Change the geometry block of a frustum and an edge of a mesh to an open contact in two cases.

    - The bodies are apart or overlap by less than the margin ``CLOSED``, and the contact normal is outside of the
      edge's normal cone: a face is nearer, and has its own contact with the frustum.
    - The bodies overlap by more, but neither contact point is inside of the other body: they do not overlap there.

    ``edge`` is the row of the edge, ``size`` the size of the bodies [m].
    """
    gap, past = out[GAP], 0.0
    if out[PAST_END] > 0.0:
        return
    if gap >= -CLOSED * size:
        off_cone = sine_off_cone(b, edge, 0, -1.0, vector_at(out, NORMAL))
        past = size * (off_cone - _CONE_MARGIN)
    elif _is_apart(b, out, frustum, axes_in_world(a, frustum), center_in_world(a, frustum), surface):
        past = -gap
    if past > 0.0:
        out[GAP], out[PAST_END] = math.hypot(gap, past), past
        write_vector(out, POINT_B, plus_scaled(vector_at(out, POINT_A), out[GAP], vector_at(out, NORMAL)))


def evaluate_mesh_edge_across_side(
    a: Floats, b: Floats, out: Floats, frustum: Floats, edge: Floats, surface: Floats, size: float
) -> None:
    """Write the geometry block of an edge of a surface, by its row ``edge``, that crosses the side of a frustum."""
    # a sharp edge of a body that need not be convex: no radius, and no convex core
    write_edge_across_side(a, b, out, frustum, edge, 0.0, edge, False, size)
    _open_if_invalid(a, b, out, frustum, edge, surface, size)


def evaluate_mesh_edge_across_rim(
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
    write_edge_across_rim(a, b, out, frustum, rim, half, edge, 0.0, edge, False, size)
    _open_if_invalid(a, b, out, frustum, edge, surface, size)


write_across_side, write_across_rim = compiled(evaluate_mesh_edge_across_side), compiled(evaluate_mesh_edge_across_rim)
"""Compiled functions that write the geometry block of a crossing edge; other contacts call them, too."""


def crossings_of(numbers: Numbers, second: Features, size: float) -> Iterator[FeaturePair]:
    """Yield the contacts of each convex edge of a mesh with the side and with both halves of each rim of a frustum.

    ``numbers`` are those of the frustum, ``size`` is the size of the larger body [m].
    """
    surface = surface_numbers(second, patches_for_body(second, 0.0), 0.0)
    edges = [(i, edge_row(second, i)) for i in range(len(second.edges))]
    values: dict[str, Value] = {"frustum": numbers, "surface": surface, "size": size}
    for i, row in edges if numbers[SIDE] > 0.0 else ():
        yield FeaturePair(evaluate_mesh_edge_across_side, {**values, "edge": row}, (f"side and edge {i}",))
    for i, row in edges:
        for rim in rims_of(numbers):
            for half in (1.0, -1.0):
                of_rim = {**values, "edge": row, "rim": float(rim), "half": half}
                names = (f"{RIM_NAMES[rim]} and edge {i}",)
                yield FeaturePair(evaluate_mesh_edge_across_rim, of_rim, names)
