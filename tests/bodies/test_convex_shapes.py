"""Convex shapes: support, bounds, mass properties and drawing hold together."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bodies import (
    Box,
    Capsule,
    Cone,
    ConvexHull,
    Cylinder,
    Disc,
    Ellipsoid,
    Sphere,
    Superellipsoid,
)
from bodies.shapes.drawing import solid_of
from nonsmooth import InvalidInput
from nonsmooth.interfaces import ConvexShape

PLACE = {"x": 0.1, "y": -0.05, "z": 0.07}
AXIS = {"axis_x": 0.48, "axis_y": -0.6, "axis_z": 0.64}
AXES = {"orientation_w": 0.8, "orientation_x": 0.36, "orientation_y": -0.48}
POINTS = ((0.0, 0.0, 0.5), (0.4, 0.0, -0.2), (-0.3, 0.4, -0.2), (-0.3, -0.4, -0.1), (0.0, -0.1, -0.4))
SHAPES: dict[str, ConvexShape] = {
    "sphere": Sphere(0.2, **PLACE),
    "box": Box(0.3, 0.2, 0.4, **PLACE, **AXES),
    "rounded box": Box(0.3, 0.2, 0.4, **PLACE, **AXES, rounding=0.1),
    "rounded hull": ConvexHull(POINTS, **PLACE, **AXES, rounding=0.1),
    "capsule": Capsule(0.15, 0.4, **PLACE, **AXIS),
    "cylinder": Cylinder(0.3, 0.25, **PLACE, **AXIS),
    "cone": Cone(0.3, 0.45, **PLACE, **AXIS),
    "rounded cylinder": Cylinder(0.3, 0.25, **PLACE, **AXIS, rounding=0.1),
    "rounded cone": Cone(0.3, 0.45, **PLACE, **AXIS, rounding=0.08),
    "rounded disc": Disc(0.4, **PLACE, **AXIS, rounding=0.05),
    "ellipsoid": Ellipsoid(0.2, 0.35, 0.5, **PLACE, **AXES),
    "superellipsoid": Superellipsoid(0.2, 0.35, 0.5, 1.5, 1.2, **PLACE, **AXES),
    "boxy superellipsoid": Superellipsoid(0.2, 0.35, 0.5, 0.6, 0.8, **PLACE, **AXES),
    "mixed superellipsoid": Superellipsoid(0.2, 0.35, 0.5, 0.6, 1.3, **PLACE, **AXES),
    "superellipsoid mixed the other way": Superellipsoid(0.2, 0.35, 0.5, 1.3, 0.6, **PLACE, **AXES),
    "rounded superellipsoid": Superellipsoid(0.2, 0.35, 0.3, 1.4, 1.3, 0.1, **PLACE, **AXES),
    "rounded boxy superellipsoid": Superellipsoid(0.2, 0.35, 0.3, 0.5, 0.8, 0.1, **PLACE, **AXES),
    "rounded mixed superellipsoid": Superellipsoid(0.2, 0.35, 0.3, 0.5, 1.3, 0.1, **PLACE, **AXES),
    "rounded ellipsoid": Superellipsoid(0.2, 0.35, 0.3, rounding=0.1, **PLACE, **AXES),
}
EXACT = ("box",)
"""Their drawing is the shape."""
SHARP = ("rounded superellipsoid", "rounded mixed superellipsoid")
"""Their drawing has few vertices where the core bends most."""


@functools.cache
def _dense(name: str) -> np.ndarray:
    return SHAPES[name].drawing(400)[0]


def _directions(n: int) -> np.ndarray:
    directions = np.random.default_rng(2).normal(size=(n, 3))
    return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("name", SHAPES)
def test_support_is_that_of_a_dense_drawing(name: str) -> None:
    """No vertex of the mesh, which are on the surface, is farther; the mesh comes as near as its edges are short."""
    shape = SHAPES[name]
    vertices = _dense(name)
    for n in _directions(300):
        reach, farthest = float(shape.support(3.0 * n) @ n), np.max(vertices @ n)
        assert farthest <= reach + 1e-15
        assert farthest >= reach - (1e-3 if name in SHARP else 1e-4) * shape.length


@pytest.mark.parametrize("name", SHAPES)
def test_bounds_hold_the_drawing_tightly(name: str) -> None:
    shape = SHAPES[name]
    low, high = shape.bounds
    vertices = _dense(name)
    np.testing.assert_allclose(np.min(vertices, axis=0), low, rtol=0, atol=1e-4)
    np.testing.assert_allclose(np.max(vertices, axis=0), high, rtol=0, atol=1e-4)
    assert np.all(vertices >= low - 1e-15)
    assert np.all(vertices <= high + 1e-15)


@pytest.mark.parametrize("name", SHAPES)
def test_mass_properties_are_those_of_the_drawing(name: str) -> None:
    """Errors of the mesh fall with the square of its fineness, so two meshes give the limit to its fourth power."""
    shape = SHAPES[name]
    coarse, fine = (solid_of(*shape.drawing(n)) for n in (100, 200))
    limits = [(4.0 * np.asarray(f) - np.asarray(c)) / 3.0 for c, f in zip(coarse, fine, strict=True)]
    tolerance = 1e-14 if name in EXACT else 1e-4 if name in SHARP else 1e-5
    assert limits[0] == pytest.approx(shape.volume, rel=tolerance)
    # the mesh is as symmetric as the shape, if that is
    middle = {"rounded hull": 1e-8, "rounded cone": 1e-6}.get(name, 1e-13)
    np.testing.assert_allclose(limits[1], shape.centroid, rtol=0, atol=middle)
    np.testing.assert_allclose(limits[2], shape.inertia, rtol=0, atol=tolerance * np.trace(shape.inertia))


@pytest.mark.fast_cases(56)
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("fineness", [3, 4, 25])
def test_drawing_is_closed_and_looks_outward(name: str, fineness: int) -> None:
    """Every edge belongs to two triangles that run along it in opposite ways; every vertex is on a triangle."""
    vertices, faces = SHAPES[name].drawing(fineness)
    edges = {(int(a), int(b)) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)}
    assert len(edges) == 3 * len(faces)
    assert all((b, a) in edges for a, b in edges)
    assert set(faces.ravel().tolist()) == set(range(len(vertices)))
    assert solid_of(vertices, faces)[0] > 0.0


@pytest.mark.parametrize("name", [name for name in SHAPES if name not in EXACT])
def test_a_drawing_without_area_is_refused(name: str) -> None:
    with pytest.raises(InvalidInput, match="fineness"):
        SHAPES[name].drawing(2)


@settings(max_examples=50, deadline=None)
@given(st.floats(0.0, 1e6))
def test_mass_properties_far_from_the_origin_lose_only_what_the_vertices_lost(away: float) -> None:
    """A unit cube, whose corners are rounded to the numbers near its place."""
    vertices, faces = Box(0.5, 0.5, 0.5, x=away, y=-away, z=away).drawing()
    volume, centroid, inertia = solid_of(vertices, faces)
    loss = 1e-14 * (1.0 + away)
    assert volume == pytest.approx(1.0, abs=10.0 * loss)
    np.testing.assert_allclose(centroid, [away, -away, away], rtol=0, atol=loss)
    np.testing.assert_allclose(inertia, np.eye(3) / 6.0, rtol=0, atol=10.0 * loss)


def test_a_disc_is_a_convex_shape_without_volume() -> None:
    """Two faces of one rim: support, bounds and a closed drawing, but no mass properties."""
    disc = Disc(0.4, **PLACE, **AXIS)
    vertices, faces = disc.drawing(400)
    for n in _directions(100):
        reach = float(disc.support(2.0 * n) @ n)
        assert reach - 1e-4 <= np.max(vertices @ n) <= reach + 1e-15
    normals = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    np.testing.assert_allclose(np.sum(normals, axis=0), 0.0, rtol=0, atol=1e-15)
    assert 0.5 * np.sum(np.linalg.norm(normals, axis=1)) == pytest.approx(2.0 * np.pi * 0.4**2, rel=1e-4)
    axis = np.array(list(AXIS.values()))
    half = 0.4 * np.sqrt(1.0 - axis**2)
    np.testing.assert_allclose(disc.bounds, disc.centroid + np.array([-half, half]), rtol=0, atol=1e-15)
    assert disc.volume == 0.0
    assert not np.any(disc.inertia)
