"""Contacts of a vertex with a patch of a triangle mesh; the vertex may belong to the first or the second body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from nonsmooth.compiled import block_at
from nonsmooth.interfaces import FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...vectors import vector_at
from .surface_search import FAR
from .surface_tables import Numbers, surface_numbers
from .surface_vertex import write_sharp_corner

Corner = tuple[tuple[float, float, float], Numbers, str]
"""Place of a vertex [m], unit vectors along its edges, one after the other, and its name."""


def evaluate_vertex_over_surface(
    a: Floats, b: Floats, out: Floats, swap: float, surface: Floats, patch: float, vertex: Floats, radius: float
) -> None:
    """Write the geometry block of a vertex: place [m], number of its edges, and the unit vectors along them.

    The other arguments are those of :func:`bodies.contacts.surface.surface_vertex.write_sharp_corner`.
    """
    write_sharp_corner(
        a, b, out, swap, surface, patch, vector_at(vertex, 0), vertex[3], block_at(vertex, 4), FAR, radius
    )


def vertices_over_surface(
    swap: float, vertices: Iterable[Corner], surface: Features, radius: float
) -> Iterator[FeaturePair]:
    """Yield the contacts of vertices, rounded by a radius [m], with all patches of the other body's surface.

    The vertices belong to the first body if ``swap`` is 1, else to the second.
    """
    patches = patches_for_ball(surface, radius)
    values: dict[str, Value] = {"swap": swap, "surface": surface_numbers(surface, patches, 0.0), "radius": radius}
    for place, star, name in vertices:
        names = tuple(f"face {i} and {name}" for i in range(len(surface.planes)))
        vertex = *place, float(len(star) // 3), *star
        for patch in range(patches.count):
            numbers = {**values, "patch": float(patch), "vertex": vertex}
            yield FeaturePair(evaluate_vertex_over_surface, numbers, names)
