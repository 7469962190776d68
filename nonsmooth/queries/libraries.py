"""Which installed library tells the distance of two shapes."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.errors import DoubtfulDistance, InvalidInput, MissingPackagesError
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation
from nonsmooth.plugins import registry
from nonsmooth.queries.result import DistanceResult


@final
@dataclass(frozen=True)
class LibraryPair:
    """Two shapes as a library has them.

    Attributes
    ----------
    name : str
        The library's.
    backend : DistanceBackend
        The library.
    solids : tuple
        Its objects.
    """

    name: str
    backend: DistanceBackend
    solids: tuple[Any, Any]

    def separation(self, one: Place, two: Place) -> Separation | None:
        """Return what the library says, None if that is in doubt."""
        try:
            return self.backend.separation(self.solids[0], one, self.solids[1], two)
        except DoubtfulDistance:
            return None

    def result(self, told: Separation) -> DistanceResult:
        """Return what it says of shapes that do not overlap as an answer."""
        gap, error = told.distance, told.error
        return DistanceResult(gap, gap - error, gap + error, told.first, told.second, told.normal, self.name)


@functools.cache
def _backends() -> dict[str, DistanceBackend]:
    made = {name: owner() for name, owner in registry.load_all("distances").items()}
    return dict(sorted(made.items(), key=lambda item: item[1].rank))


def library_pair(first: Shape, second: Shape) -> LibraryPair | None:
    """Return two shapes as the first installed library that knows both has them; None if none does."""
    for name, backend in _backends().items():
        if backend.installed:
            solids = backend.solid(first), backend.solid(second)
            if solids[0] is not None and solids[1] is not None:
                return LibraryPair(name, backend, (solids[0], solids[1]))
    return None


def named_pair(name: str, first: Shape, second: Shape) -> LibraryPair:
    """Return two shapes as a library of that name has them.

    Raises
    ------
    MissingPackagesError
        If its packages are not installed.
    InvalidInput
        If it has no such kinds of shapes.
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
    """Return the names of all libraries, the first to be asked first."""
    return tuple(_backends())
