"""Distance of two shapes at any places: by their contacts, by planes, or by an installed library."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Any, final

from nonsmooth.errors import DoubtfulDistance, InvalidInput, MissingPackagesError, NoDistance, UnknownName
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from nonsmooth.plugins import registry
from nonsmooth.queries.exact import Contacts
from nonsmooth.queries.result import EXACT, PLANES, DistanceResult
from nonsmooth.queries.solids import TooManyPieces, by_planes, proved
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

    def separation(self, one: Place, two: Place) -> Separation | None:
        """Separation of the two shapes as the library computes it, None if the library cannot be sure of it."""
        try:
            return self.backend.separation(self.solids[0], one, self.solids[1], two)
        except DoubtfulDistance:
            return None

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


_ROUND_OFF, _LEAST = 1e-9, 1e-12
"""Round-off allowed between the gap by contacts and the bounds by another method: relative to the gap, and absolute
[m]; the sum of both is allowed."""

_MOST_PIECES = 2000
"""Largest number of pieces of a surface whose distance is computed by contacts, unless the user chooses "exact".  To
prepare the contacts takes about a second for 2000 pieces, and many minutes for 100 000.  For more pieces, the distance
is computed by a library or by planes."""


@final
class ShapePair:
    """Two shapes, prepared once, whose distance can be computed at any places.

    Parameters
    ----------
    first, second : Shape
        The shapes.
    by : str, optional
        Method: "exact", "planes" or the name of a library.  By default the gap is computed by contacts, and its bounds
        by planes or, for surfaces that are not convex, by a library.  If the gap is outside these bounds, the result of
        the planes or the library is returned.
    quick : bool
        True to use solids in place of contacts, if both shapes have one: contacts of a mesh take seconds to prepare.

    Raises
    ------
    InvalidInput
        If ``by`` is the name of no method, or if the method ``by`` does not support the shapes.  Without ``by``: if no
        method supports them.
    MissingPackagesError
        If the library is not installed.
    """

    def __init__(self, first: Shape, second: Shape, by: str | None = None, quick: bool = False) -> None:
        if by is not None and by not in (ways := (EXACT, PLANES, *library_names())):
            raise UnknownName("way to find a distance", str(by), ways)
        self._names = f"{type(first).__name__} and {type(second).__name__}"
        self._by, self._solids = by, (first.solid, second.solid)
        bounded = first.solid is not None and second.solid is not None
        self._hollow = any(solid is not None and solid.hollow for solid in self._solids)
        self._contacts: Contacts | None = None
        self._library: LibraryPair | None = None
        if by == EXACT or (by is None and not (bounded and (quick or self._many))):
            self._contacts = self._made(first, second)
        if by not in (None, EXACT, PLANES):
            self._library = named_pair(by, first, second)
        elif by is None and self._hollow and bounded:
            self._library = library_pair(first, second)
        if (by == PLANES and not bounded) or (by is None and not bounded and self._contacts is None):
            raise InvalidInput(
                f"distance of {self._names}",
                "must be asked of shapes of which at least one is bounded, and of solids where no contacts are known",
                self._names,
                "Two planes have no nearest points.",
            )

    @property
    def _many(self) -> bool:
        """True if a shape is a surface of more than 2000 pieces, whose contacts would take too long to prepare."""
        surfaces = [solid for solid in self._solids if solid is not None and solid.hollow]
        return any(len(solid.pieces(*solid.bounds)) > _MOST_PIECES for solid in surfaces)

    def _made(self, first: Shape, second: Shape) -> Contacts | None:
        try:
            return Contacts(first, second)
        except (LookupError, InvalidInput) as error:
            if self._by is None:
                return None
            why = str(error) if isinstance(error, InvalidInput) else "No contact kinematics is installed for them."
            raise InvalidInput(
                f"distance of {self._names} by 'exact'", "needs their contacts", self._names, why
            ) from None

    def at(self, one: Place, two: Place) -> DistanceResult:
        """Distance of the shapes with their frames at two places.

        Raises
        ------
        NoDistance
            If no method, or not the method ``by``, gives a distance there.
        """
        if self._by == EXACT:
            return self._told(self._least(one, two), "no features of theirs face each other")
        if self._by not in (None, PLANES):
            return self._by_library(one, two)
        if any(solid is None for solid in self._solids):
            return self._told(self._least(one, two), "no features of theirs face each other")
        placed = self._placed(one, two)
        if self._by == PLANES:
            return self._by_planes(*placed)
        found = self._least(one, two)
        if not self._hollow:
            return (found and proved(found, *placed)) or by_planes(*placed)
        return self._of_surfaces(found, one, two)

    def _of_surfaces(self, found: DistanceResult | None, one: Place, two: Place) -> DistanceResult:
        """Distance of surfaces that are not convex.

        The gap by contacts is checked by the bounds that the library gives.  If the library gives no bounds, or wrong
        ones, the bounds by planes are used.  The gap by contacts is returned if it is within the bounds.  Otherwise the
        distance by the method that gave the bounds is returned.
        """
        told = None if self._library is None else self._library.separation(one, two)
        if told is not None and not told.overlap:
            assert self._library is not None
            bound = self._library.result(told)
            # contact points are points of the two shapes, so the distance of the shapes is at most the gap by contacts.
            # If this gap is below the lower bound of the library, the bound is wrong, and planes are used instead
            if found is None or found.gap >= bound.lower:
                return self._within(found, bound)
        return self._within(found, self._by_planes(*self._placed(one, two)))

    def _within(self, found: DistanceResult | None, bound: DistanceResult) -> DistanceResult:
        """Return ``found``, the distance by contacts, with the bounds of ``bound``, the distance by another method.

        If the gap of ``found`` is outside the bounds, or ``found`` is None, ``bound`` is returned.
        """
        if found is None:
            return bound
        # margin for round-off, since the two bounds may be equal, and for solids whose contacts use a surface that is
        # inside of the solid's boundary, by the distance `set_back`
        slack = _ROUND_OFF * abs(bound.gap) + _LEAST
        slack += sum(solid.set_back for solid in self._solids if solid is not None)
        if not bound.lower - slack <= found.gap <= bound.upper + slack:
            return bound
        return replace(found, lower=min(bound.lower, found.gap), upper=max(bound.upper, found.gap))

    def _least(self, one: Place, two: Place) -> DistanceResult | None:
        return None if self._contacts is None else self._contacts.least(one, two)

    def _placed(self, one: Place, two: Place) -> tuple[Placed, Placed]:
        first, second = self._solids
        assert first is not None
        assert second is not None
        return Placed(first, *one), Placed(second, *two)

    def _by_planes(self, one: Placed, two: Placed) -> DistanceResult:
        try:
            return by_planes(one, two)
        except TooManyPieces as many:
            raise NoDistance(
                f"The distance of {self._names} cannot be told: no library answers, and there are {many.args[0]} pairs "
                "of pieces to look at. Take a coarser mesh."
            ) from None

    def _by_library(self, one: Place, two: Place) -> DistanceResult:
        assert self._library is not None
        told = self._library.backend.separation(self._library.solids[0], one, self._library.solids[1], two)
        return self._told(None if told.overlap else self._library.result(told), "they overlap, and it tells no depth")

    def _told(self, found: DistanceResult | None, why: str) -> DistanceResult:
        if found is None:
            raise NoDistance(f"The distance of {self._names} cannot be told by {self._by or EXACT!r}: {why}.")
        return found


def shape_pair(first: Shape, second: Shape, by: str | None, quick: bool) -> ShapePair:
    """Prepared pair of two shapes. The last 32 pairs are cached, if the shapes are hashable.

    Raises
    ------
    InvalidInput, MissingPackagesError
        As :class:`ShapePair`.
    """
    try:
        hash((first, second))
    except TypeError:
        return ShapePair(first, second, by, quick)
    return _ready(first, second, by, quick)


@functools.lru_cache(maxsize=32)
def _ready(first: Shape, second: Shape, by: str | None, quick: bool) -> ShapePair:
    return ShapePair(first, second, by, quick)
