"""Distance of two shapes at any places: by their convex pieces, or by an installed library."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.errors import InvalidInput, MissingPackagesError, NoDistance, UnknownName
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from nonsmooth.plugins import registry
from nonsmooth.queries.by_pieces import distance_by_pieces
from nonsmooth.queries.result import PAIR, DistanceResult
from nonsmooth.solids.pieces import Pieces
from nonsmooth.solids.placed import Placed


@final
@dataclass(frozen=True)
class LibraryPair:
    """Two shapes as objects of a library.

    Attributes
    ----------
    name : str
        Name of the library.
    backend : DistanceBackend
        The library.
    solids : tuple
        The two shapes as objects of the library.
    """

    name: str
    backend: DistanceBackend
    solids: tuple[Any, Any]

    def result(self, told: Separation) -> DistanceResult:
        """Distance of two shapes with its bounds, nearest points and normal, as a result for the user.

        ``told`` is the separation that the library computed for the shapes; they must not overlap.
        """
        gap, error = told.distance, told.error
        return DistanceResult(gap, gap - error, gap + error, told.first, told.second, told.normal, self.name)


@functools.cache
def _backends() -> dict[str, DistanceBackend]:
    made = {name: owner() for name, owner in registry.load_all("distances").items()}
    return dict(sorted(made.items(), key=lambda item: item[1].rank))


def library_pair(first: Shape, second: Shape) -> LibraryPair | None:
    """Two shapes as objects of the first installed library that knows both, None if no library does."""
    for name, backend in _backends().items():
        if backend.installed:
            solids = backend.solid(first), backend.solid(second)
            if solids[0] is not None and solids[1] is not None:
                return LibraryPair(name, backend, (solids[0], solids[1]))
    return None


def named_pair(name: str, first: Shape, second: Shape) -> LibraryPair:
    """Two shapes as objects of the library with a given name.

    Raises
    ------
    MissingPackagesError
        If the library is not installed.
    InvalidInput
        If the library does not support one of the shapes.
    """
    backend = _backends()[name]
    if not backend.installed:
        raise MissingPackagesError(f'Distances by {name} need its package: pip install "nonsmooth[{name}]"')
    solids = backend.solid(first), backend.solid(second)
    for solid, shape in zip(solids, (first, second), strict=True):
        if solid is None:
            raise InvalidInput(
                f"distance by {name!r}",
                "must be asked of shapes that it has a kind for",
                type(shape).__name__,
                "Leave `by` out: then the way is chosen.",
            )
    return LibraryPair(name, backend, solids)


def library_names() -> tuple[str, ...]:
    """Names of the geometry libraries that can compute distances, in the order in which they are tried for a pair."""
    return tuple(_backends())


@final
class ShapePair:
    """Two shapes, prepared once, whose distance can be computed at any places.

    Parameters
    ----------
    first, second : Shape
        The shapes.
    by : str, optional
        Method: "pair" or the name of a library.  By default "pair"; if a shape has neither convex parts nor a surface,
        the first installed library that knows both shapes.

    Raises
    ------
    InvalidInput
        If ``by`` is the name of no method, or if the method ``by`` does not support the shapes.  Without ``by``: if no
        method supports them.
    MissingPackagesError
        If the library is not installed.
    """

    def __init__(self, first: Shape, second: Shape, by: str | None = None) -> None:
        if by is not None and by not in (ways := (PAIR, *library_names())):
            raise UnknownName("way to find a distance", str(by), ways)
        self._names = f"{type(first).__name__} and {type(second).__name__}"
        self._library = None if by in (None, PAIR) else named_pair(by, first, second)
        self._pieces: tuple[Pieces, Pieces] | None = None
        if self._library is not None:
            return
        one, two = Pieces.of(first), Pieces.of(second)
        if one is not None and two is not None:
            self._pieces = one, two
            self._check_bounded(one, two)
            return
        self._library = None if by == PAIR else library_pair(first, second)
        if self._library is None:
            bare = " and ".join(type(shape).__name__ for shape, found in ((first, one), (second, two)) if found is None)
            raise InvalidInput(
                f"distance of {self._names}",
                "must be asked of shapes with convex parts or a surface",
                bare,
                "Define the property `parts` of the shape.",
            )

    def _check_bounded(self, one: Pieces, two: Pieces) -> None:
        if not (one.is_bounded or two.is_bounded):
            raise InvalidInput(
                f"distance of {self._names}",
                "must be asked of shapes of which at least one is bounded",
                self._names,
                "Two planes have no nearest points.",
            )

    def at(self, one: Place, two: Place) -> DistanceResult:
        """Distance of the shapes with their frames at two places.

        Raises
        ------
        NoDistance
            If a library computes the distance, and the shapes overlap, or it contradicts support functions.
        """
        if self._pieces is not None:
            return distance_by_pieces(Placed(self._pieces[0], *one), Placed(self._pieces[1], *two))
        library = self._library
        assert library is not None
        told = library.backend.separation(library.solids[0], one, library.solids[1], two)
        if told.overlap:
            why = "they overlap, and it tells no depth"
            raise NoDistance(f"The distance of {self._names} cannot be told by {library.name!r}: {why}.")
        return library.result(told)


def shape_pair(first: Shape, second: Shape, by: str | None) -> ShapePair:
    """Prepared pair of two shapes. The last 32 pairs are cached, if the shapes are hashable.

    Raises
    ------
    InvalidInput, MissingPackagesError
        As :class:`ShapePair`.
    """
    try:
        hash((first, second))
    except TypeError:
        return ShapePair(first, second, by)
    return _ready(first, second, by)


@functools.lru_cache(maxsize=32)
def _ready(first: Shape, second: Shape, by: str | None) -> ShapePair:
    return ShapePair(first, second, by)
