"""Which contact kinematics knows a pair of shapes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, ContactKinematics, Shape
from nonsmooth.plugins import registry

Found = tuple[type[ContactKinematics], bool]


class Geometries:
    """The geometries of the contacts of one system, made once for equal shapes."""

    def __init__(self) -> None:
        self._frames: dict[int, tuple[tuple[Shape, ...], ...]] = {}
        self._shapes: dict[Shape, Shape] = {}
        self._kinds: dict[tuple[type[Shape], type[Shape]], Found] = {}
        self._made: dict[tuple[int, int], tuple[ContactKinematics, ...]] = {}

    def shapes(self, body: Body) -> tuple[tuple[Shape, ...], ...]:
        """Return the shapes that each frame of a body of the system carries; equal ones are one object."""
        if id(body) not in self._frames:
            self._frames[id(body)] = tuple(tuple(map(self._first_of, shapes)) for shapes in body.frames)
        return self._frames[id(body)]

    def _first_of(self, shape: Shape) -> Shape:
        try:
            return self._shapes.setdefault(shape, shape)
        except TypeError:  # one with fields that cannot be hashed
            return shape

    def between(self, first: Shape, second: Shape) -> tuple[Sequence[ContactKinematics], bool]:
        """Return the geometries of two shapes that :meth:`shapes` gave, and whether the first comes first in them.

        Raises
        ------
        InvalidInput
            If no kinematics knows the two.
        """
        kinds = type(first), type(second)
        if kinds not in self._kinds:
            self._kinds[kinds] = _kinematics_of(first, second)
        kinematics, in_order = self._kinds[kinds]
        one, two = (first, second) if in_order else (second, first)
        key = id(one), id(two)
        if key not in self._made:
            made = kinematics.between(one, two)
            if any(geometry.candidates is not None for geometry in made):
                # features are searched for between two bodies
                return made, in_order
            self._made[key] = tuple(made)
        return self._made[key], in_order


def _kinematics_of(first: Shape, second: Shape) -> Found:
    known = registry.load_all("kinematics").values()
    found = nearest_pair(known, first, second)
    if found is None:
        pairs = sorted(f"{k.pair[0].__name__}-{k.pair[1].__name__}" for k in known)
        raise InvalidInput(
            "System.contact",
            "needs shapes whose contact kinematics is known",
            f"{type(first).__name__}-{type(second).__name__}",
            " ".join(filter(None, (first.advice, second.advice, f"Known pairs: {', '.join(pairs)}."))),
        )
    return found


def nearest_pair(
    known: Iterable[type[ContactKinematics]], first: Shape, second: Shape
) -> tuple[type[ContactKinematics], bool] | None:
    """Return the kinematics of two shapes, and whether they stand in its order; None if there is none.

    A pair of base classes knows all shapes that derive from them; of several that fit, the one is taken whose classes
    are nearest to the shapes'.
    """
    best: tuple[type[ContactKinematics], bool] | None = None
    least = math.inf
    for kinematics in known:
        for in_order, one, two in ((True, first, second), (False, second, first)):
            steps = _steps(one, kinematics.pair[0]) + _steps(two, kinematics.pair[1])
            if steps < least:
                best, least = (kinematics, in_order), steps
    return best


def _steps(shape: Shape, kind: type[Shape]) -> float:
    line = type(shape).__mro__
    return line.index(kind) if kind in line else math.inf
