"""Properties of shapes; what they do in a contact is looked at with the kinematics of their pairs."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.interfaces import Shape
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.look import check_look
from nonsmooth.testing.property import Broken, Property, properties

_DIRECTIONS = 60
"""Directions along which what a shape encloses is looked at."""
_ROUND_OFF = 1e-9


def check_shape(shape: Shape) -> list[Property]:
    """Return the properties of a shape.

    Parameters
    ----------
    shape : Shape
        The shape.
    """
    rows = [
        ("length", "its length is finite and not negative", lambda: _check_length(shape)),
        ("extent", "a ball of its extent holds what is as far away as its length", lambda: _check_extent(shape)),
        ("ceiling", "no point of what it encloses is above its ceiling", lambda: _check_ceiling(shape)),
        (
            "solid",
            "no point of what it encloses is farther along a direction than that which is told, all are within its "
            "bounds and its extent, and points inside are",
            lambda: _check_solid(shape),
        ),
        ("parts", "its convex parts lie within what it encloses", lambda: _check_parts(shape)),
        ("look", "what is seen of it can be drawn", lambda: check_look("look", shape.look)),
    ]
    return properties(shape, [*component_rows(shape), *rows])


def _check_length(shape: Shape) -> None:
    if not (math.isfinite(shape.length) and shape.length >= 0.0):
        raise Broken("it must be finite and not negative [m]", "length", shape.length)


def _check_extent(shape: Shape) -> None:
    if not shape.extent >= shape.length:
        raise Broken(f"it must not be below the length {shape.length:g} m", "extent", shape.extent)


def _check_ceiling(shape: Shape) -> None:
    if math.isnan(shape.ceiling):
        raise Broken("it must be a height [m], or infinite", "ceiling", shape.ceiling)
    if shape.solid is not None:
        top = float(shape.solid.support(np.array([0.0, 0.0, 1.0]))[2])
        if top > shape.ceiling + _ROUND_OFF * shape.length:
            raise Broken(f"a point of the solid is at the height {top:g} m", "ceiling", shape.ceiling)


def _check_solid(shape: Shape) -> None:
    solid = shape.solid
    if solid is None:
        return
    directions = np.random.default_rng(0).normal(size=(_DIRECTIONS, 3))
    points = np.array([solid.support(n) for n in directions])
    if points.shape != directions.shape or not np.all(np.isfinite(points)):
        raise Broken("a point must be three finite numbers [m]", "support", points.tolist())
    none = _ROUND_OFF * (float(np.ptp(points)) + float(np.max(np.abs(points))))
    reach = directions @ points.T
    for i, n in enumerate(directions):
        far = float(np.max(reach[i]) - reach[i, i])
        if far > none * float(np.linalg.norm(n)):
            raise Broken(f"another point is farther along {n.tolist()}", "support", points[i].tolist())
        if abs(float(n @ solid.support(3.0 * n)) - reach[i, i]) > none * float(np.linalg.norm(n)):
            raise Broken("it must not depend on the length of the direction", "direction", n.tolist())
        if np.min((points[i] - solid.inner) @ n) < -none * float(np.linalg.norm(n)):
            raise Broken("a point inside must not lie beyond it", "inner", solid.inner.tolist())
    low, high = solid.bounds
    if np.any(points < low - none) or np.any(points > high + none):
        raise Broken("they must hold all its points", "bounds", (low.tolist(), high.tolist()))
    farthest = float(np.max(np.linalg.norm(points, axis=1)))
    if farthest > shape.extent + none + solid.set_back:
        raise Broken(f"a point of the solid is {farthest:g} m away", "extent", shape.extent)


def _check_parts(shape: Shape) -> None:
    """Look whether the convex parts lie within the solid, or as far beyond it as contacts may see its surface."""
    solid = shape.solid
    for part in shape.parts:
        if solid is None or part.function or part.is_half_space:
            continue
        for n in np.random.default_rng(0).normal(size=(_DIRECTIONS, 3)):
            size = float(np.linalg.norm(n))
            beyond = part.height(n) / size - float(n @ solid.support(n)) / size
            if not beyond <= _ROUND_OFF * (shape.extent + part.radius) + solid.set_back:
                raise Broken(f"a part must not reach {beyond:.3g} m out of the solid along {n.tolist()}", "parts", part)
