"""Conformance checks of a library for distances: points, order of the solids, and touching planes."""

from __future__ import annotations

import inspect
import itertools
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.errors import DoubtfulDistance
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from nonsmooth.parameters import UnusualValue
from nonsmooth.plugins import registry
from nonsmooth.rotations import rotation
from nonsmooth.testing.claims import claim, rows
from nonsmooth.testing.component import component_rows, make
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties

_POSES = 6
_SAME = 1e-5
"""Allowed error of points and distances, relative to the extents of both shapes, and of the squared length of the
normal."""


def check_distance_backend(backend: DistanceBackend) -> list[Property]:
    """Return the properties of a library for distances, of the installed shapes that it knows.

    Parameters
    ----------
    backend : DistanceBackend
        The library.
    """
    return properties(backend, _rows)


def _rows(backend: DistanceBackend) -> list[Row]:
    return [*component_rows(backend), *rows([_points, _order, _planes], lambda: [backend], 1)]


class _Answer(NamedTuple):
    """The library's answer for two solids that do not overlap; ``size`` is the sum of their extents [m]."""

    shapes: tuple[Shape, Shape]
    solids: tuple[Any, Any]
    places: tuple[Place, Place]
    found: Separation
    size: float

    def broken(self, reason: str, parameter: str, value: object) -> Broken:
        return Broken(f"of {self.shapes[0]} and {self.shapes[1]} {reason}", parameter, value)


def _known(backend: DistanceBackend) -> list[tuple[Shape, Any]]:
    if not backend.installed:
        raise NotChecked("its packages are not installed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        kinds = registry.load_all("shapes").items()
        shapes = [make(owner, name, {}) for name, owner in kinds if not inspect.isabstract(owner)]
    known = [(shape, solid) for shape in shapes if (solid := backend.solid(shape)) is not None]
    if not known:
        raise Broken("it knows none of the installed shapes")
    return known


def _answers(backend: DistanceBackend) -> Iterator[_Answer]:
    rng = np.random.default_rng(0)
    for one, two in itertools.combinations_with_replacement(_known(backend), 2):
        size = one[0].extent + two[0].extent
        for _ in range(_POSES):
            places = _place(rng, size), _place(rng, size)
            try:
                found = backend.separation(one[1], places[0], two[1], places[1])
            except DoubtfulDistance:
                continue
            if not found.overlap:
                yield _Answer((one[0], two[0]), (one[1], two[1]), places, found, size)


def _place(rng: np.random.Generator, size: float) -> Place:
    q = rng.normal(size=4)
    return rng.uniform(-size, size, 3), rotation(q / np.linalg.norm(q))


@claim()
def _points(backend: DistanceBackend) -> None:
    """The vector between the nearest points is the distance times the normal."""
    for one in _answers(backend):
        found = one.found
        off = found.second - found.first - found.distance * found.normal
        if not (np.max(np.abs(off)) <= _SAME * one.size and abs(float(found.normal @ found.normal) - 1.0) <= _SAME):
            raise one.broken("they are not", "separation", found)


@claim()
def _order(backend: DistanceBackend) -> None:
    """The distance is the same in the other order of two solids."""
    for one in _answers(backend):
        try:
            back = backend.separation(one.solids[1], one.places[1], one.solids[0], one.places[0])
        except DoubtfulDistance:
            continue
        allowed = one.found.error + back.error + _SAME * one.size
        if back.overlap or not abs(back.distance - one.found.distance) <= allowed:
            raise one.broken("it is not", "separation", (one.found, back))


@claim()
def _planes(backend: DistanceBackend) -> None:
    """The two planes perpendicular to the normal that touch the convex solids are as far apart as the solids."""
    for one in _answers(backend):
        first, second = one.shapes[0].solid, one.shapes[1].solid
        if first is None or second is None or first.surface or second.surface:
            continue
        n, (place, axes), (other, turned) = one.found.normal, *one.places
        low = other + turned @ second.support(-turned.T @ n)
        between = float(n @ (low - place - axes @ first.support(axes.T @ n)))
        if not abs(between - one.found.distance) <= one.found.error + 1e-3 * one.size:
            raise one.broken(f"they leave {between:.9g} m", "distance", one.found.distance)
