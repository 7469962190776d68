"""Properties of a library for distances."""

from __future__ import annotations

import inspect
import itertools
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

from nonsmooth.errors import DoubtfulDistance
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from nonsmooth.parameters import UnusualValue
from nonsmooth.plugins import registry
from nonsmooth.rotations import rotation
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.make import make
from nonsmooth.testing.property import Broken, NotChecked, Property, properties

_POSES = 6
_SAME = 1e-5
"""Differences that count as none, relative to distance and size."""


def check_distance_backend(backend: DistanceBackend) -> list[Property]:
    """Return the properties of a library for distances, of the installed shapes that it knows.

    Parameters
    ----------
    backend : DistanceBackend
        The library.
    """
    rows = [
        ("points", "nearest points are the distance apart, along the normal", lambda: _check_points(backend)),
        ("order", "in the other order of two solids the answer is the same", lambda: _check_order(backend)),
        ("planes", "no plane across the normal leaves more between convex solids", lambda: _check_planes(backend)),
    ]
    return properties(backend, [*component_rows(backend), *rows])


def _shapes() -> list[Shape]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        kinds = registry.load_all("shapes").items()
        return [make(owner, name, {}) for name, owner in kinds if not inspect.isabstract(owner)]


def _known(backend: DistanceBackend) -> list[tuple[Shape, Any]]:
    if not backend.installed:
        raise NotChecked("its packages are not installed")
    known = [(shape, solid) for shape in _shapes() if (solid := backend.solid(shape)) is not None]
    if not known:
        raise Broken("it knows none of the installed shapes")
    return known


def _answers(backend: DistanceBackend) -> Iterator[tuple[tuple[Any, ...], tuple[Place, Place], Separation, float]]:
    """Yield shapes and solids, places, the answer, and the size, of solids that do not overlap."""
    rng = np.random.default_rng(0)
    for one, two in itertools.combinations_with_replacement(_known(backend), 2):
        size = one[0].extent + two[0].extent
        for _ in range(_POSES):
            places = tuple(_place(rng, size) for _ in range(2))
            try:
                found = backend.separation(one[1], places[0], two[1], places[1])
            except DoubtfulDistance:
                continue
            if not found.overlap:
                yield (*one, *two), (places[0], places[1]), found, size


def _place(rng: np.random.Generator, size: float) -> Place:
    q = rng.normal(size=4)
    return rng.uniform(-size, size, 3), rotation(q / np.linalg.norm(q))


def _check_points(backend: DistanceBackend) -> None:
    for (one, _, two, _), _, found, size in _answers(backend):
        off = found.second - found.first - found.distance * found.normal
        if not (np.max(np.abs(off)) <= _SAME * size and abs(float(found.normal @ found.normal) - 1.0) <= _SAME):
            raise Broken(f"of {one} and {two} they are not", "separation", found)


def _check_order(backend: DistanceBackend) -> None:
    for (one, first, two, second), places, found, size in _answers(backend):
        try:
            back = backend.separation(second, places[1], first, places[0])
        except DoubtfulDistance:
            continue
        if back.overlap or not abs(back.distance - found.distance) <= found.error + back.error + _SAME * size:
            raise Broken(f"of {one} and {two} it is not", "separation", (found, back))


def _check_planes(backend: DistanceBackend) -> None:
    for (one, _, two, _), places, found, size in _answers(backend):
        solids = one.solid, two.solid
        if any(solid is None or solid.hollow for solid in solids):
            continue
        n = found.normal
        (place, axes), (other, turned) = places
        low = other + turned @ solids[1].support(-turned.T @ n)
        between = float(n @ (low - place - axes @ solids[0].support(axes.T @ n)))
        if not abs(between - found.distance) <= found.error + 1e-3 * size:
            raise Broken(f"of {one} and {two} they leave {between:.9g} m", "distance", found.distance)
