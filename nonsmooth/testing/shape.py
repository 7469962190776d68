"""Conformance checks of shapes, and of all that can be drawn. Contacts of shapes are checked by ``kinematics``."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.solid import Vector
from nonsmooth.testing.claims import Claims, rows
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.outcome import Broken, Row
from nonsmooth.testing.property import Property, properties

_DIRECTIONS = np.random.default_rng(0).normal(size=(60, 3))
"""Directions along which a solid is checked."""
_ROUND_OFF = 1e-9
_SHAPE = Claims()


def check_shape(shape: Shape) -> list[Property]:
    """Return the properties of a shape.

    Parameters
    ----------
    shape : Shape
        The shape.
    """
    return properties(shape, _rows)


def _rows(shape: Shape) -> list[Row]:
    return [*component_rows(shape), *rows(_SHAPE, lambda: [shape], 1)]


@_SHAPE.claim()
def _length(shape: Shape) -> None:
    """The length is finite and not negative."""
    if not (math.isfinite(shape.length) and shape.length >= 0.0):
        raise Broken("it must be finite and not negative [m]", "length", shape.length)


@_SHAPE.claim()
def _extent(shape: Shape) -> None:
    """The extent is not below the length."""
    if not shape.extent >= shape.length:
        raise Broken(f"it must not be below the length {shape.length:g} m", "extent", shape.extent)


@_SHAPE.claim()
def _ceiling(shape: Shape) -> None:
    """No point of the solid is above the height that the shape gives as its `ceiling`."""
    if math.isnan(shape.ceiling):
        raise Broken("it must be a height [m], or infinite", "ceiling", shape.ceiling)
    if shape.solid is not None:
        top = float(shape.solid.support(np.array([0.0, 0.0, 1.0]))[2])
        if top > shape.ceiling + _ROUND_OFF * shape.length:
            raise Broken(f"a point of the solid is at the height {top:g} m", "ceiling", shape.ceiling)


@_SHAPE.claim()
def _solid(shape: Shape) -> None:
    """Each support point of the solid is the farthest point of the solid along its direction.

    All support points are within the solid's bounds and the shape's extent, and the solid's inner point is inside.
    """
    solid = shape.solid
    if solid is None:
        return
    points = np.array([solid.support(n) for n in _DIRECTIONS])
    if points.shape != _DIRECTIONS.shape or not np.all(np.isfinite(points)):
        raise Broken("a point must be three finite numbers [m]", "support", points.tolist())
    none = _ROUND_OFF * (float(np.ptp(points)) + float(np.max(np.abs(points))))
    reach = _DIRECTIONS @ points.T
    for i, n in enumerate(_DIRECTIONS):
        size = float(np.linalg.norm(n))
        if float(np.max(reach[i]) - reach[i, i]) > none * size:
            raise Broken(f"another point is farther along {n.tolist()}", "support", points[i].tolist())
        if abs(float(n @ solid.support(3.0 * n)) - reach[i, i]) > none * size:
            raise Broken("it must not depend on the length of the direction", "direction", n.tolist())
        if solid.surface is not None and np.min((points[i] - solid.surface.inner) @ n) < -none * size:
            raise Broken("a point inside must not lie beyond it", "inner", solid.surface.inner.tolist())
    low, high = solid.bounds
    if np.any(points < low - none) or np.any(points > high + none):
        raise Broken("they must hold all its points", "bounds", (low.tolist(), high.tolist()))
    farthest = float(np.max(np.linalg.norm(points, axis=1)))
    if farthest > shape.extent + none + solid.set_back:
        raise Broken(f"a point of the solid is {farthest:g} m away", "extent", shape.extent)


@_SHAPE.claim()
def _parts(shape: Shape) -> None:
    """Convex parts extend beyond the solid by at most its ``set_back``."""
    solid = shape.solid
    for part in shape.parts:
        if solid is None or part.function or part.is_half_space:
            continue
        for n in _DIRECTIONS:
            size = float(np.linalg.norm(n))
            beyond = part.height(n) / size - float(n @ solid.support(n)) / size
            if not beyond <= _ROUND_OFF * (shape.extent + part.radius) + solid.set_back:
                raise Broken(f"a part must not reach {beyond:.3g} m out of the solid along {n.tolist()}", "parts", part)


@_SHAPE.claim()
def _look(shape: Shape) -> None:
    """The shape can be drawn."""
    require_look("look", shape.look)


def require_look(name: str, look: Look) -> None:
    """Raise Broken if the vertices, triangles or lines that show a component in pictures are invalid."""
    if not isinstance(look, Look):
        raise Broken("it must be a nonsmooth.interfaces.look.Look", name, look)
    if np.ndim(look.vertices) != 2 or np.shape(look.vertices)[1] != 3 or not np.all(np.isfinite(look.vertices)):
        raise Broken("its vertices must be finite numbers, three in a row [m]", name, look.vertices)
    if look.sheet and len(look.vertices) != 1:
        raise Broken("a sheet must have one vertex", name, len(look.vertices))
    for part, lines, width in (("triangles", look.triangles, 3), ("lines", look.lines, 2)):
        is_whole = np.issubdtype(np.asarray(lines).dtype, np.integer)
        if np.ndim(lines) != 2 or np.shape(lines)[1] != width or not is_whole:
            raise Broken(f"its {part} must be integers, {width} in a row", name, lines)
        if np.any((lines < 0) | (lines >= len(look.vertices))):
            raise Broken(f"its {part} must be numbers of its {len(look.vertices)} vertices", name, lines)


def require_ends(ends: Vector) -> None:
    """Raise Broken unless the points that show a load or a joint in pictures are two finite points [m]."""
    if np.shape(ends) != (2, 3) or not np.all(np.isfinite(ends)):
        raise Broken("it must be two points, shape [2, 3] [m]", "ends", ends)
