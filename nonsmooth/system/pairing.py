"""Pairs of shapes of two bodies: the choice of the shapes, and the contact kinematics of each pair."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, ContactKinematics, FeaturePair, Shape
from nonsmooth.plugins import registry

Frames: TypeAlias = tuple[tuple[Shape, ...], ...]


@dataclass(frozen=True)
class Side:
    """A shape as one side of a contact.

    Attributes
    ----------
    body : Body
        Body that carries the shape.
    frame : int
        Number of the frame that carries the shape.
    number : int
        Number of the shape, counted through all frames of the body.
    shape : Shape
        The shape.
    """

    body: Body
    frame: int
    number: int
    shape: Shape


def select(
    where: str, bodies: tuple[Body, Body], shapes: Any, carried: Callable[[Body], Frames]
) -> tuple[list[Side], list[Side]]:
    """Chosen shapes of each body, in the order of its frames; ``carried`` gives the shapes of a body by frame.

    Raises
    ------
    InvalidInput
        If a body carries no shapes, the choice is not a pair, or a number of a shape is unknown or given twice.
    """
    sides = tuple(_carried(where, body, carried(body)) for body in bodies)
    if not isinstance(shapes, (tuple, list)) or len(shapes) != 2:
        raise InvalidInput(
            f"{where}: shapes", "must be a pair, one entry for either body", shapes, "For example ((0, 1), None)."
        )
    return _chosen(where, sides[0], shapes[0]), _chosen(where, sides[1], shapes[1])


def _carried(where: str, body: Body, frames: Frames) -> list[Side]:
    pairs = [(frame, shape) for frame, shapes in enumerate(frames) for shape in shapes]
    if not pairs:
        raise InvalidInput(where, "needs bodies that carry shapes", body, "Without a shape nothing can touch it.")
    return [Side(body, frame, number, shape) for number, (frame, shape) in enumerate(pairs)]


def _chosen(where: str, sides: list[Side], numbers: Sequence[int] | None) -> list[Side]:
    if numbers is None:
        return sides
    name, known = type(sides[0].body).__name__, range(len(sides))
    if not isinstance(numbers, (tuple, list, range)) or not numbers:
        raise InvalidInput(
            f"{where}: shapes of {name}",
            "must be None or a sequence of at least one number",
            numbers,
            "None stands for all shapes.",
        )
    for number in numbers:
        if isinstance(number, bool) or not isinstance(number, int) or number not in known:
            carried = ", ".join(f"{side.number}: {type(side.shape).__name__}" for side in sides)
            raise InvalidInput(
                f"{where}: shapes of {name}",
                f"must be whole numbers from 0, below {len(sides)}",
                number,
                f"Shapes are counted through all frames: {carried}.",
            )
    if len(set(numbers)) < len(numbers):
        raise InvalidInput(
            f"{where}: shapes of {name}", "must name every shape once", tuple(numbers), "Take the double one out."
        )
    return [sides[number] for number in sorted(numbers)]


Found = tuple[type[ContactKinematics], bool]


class ContactGeometries:
    """Geometries of the contacts of one system. They are made once for equal shapes."""

    def __init__(self) -> None:
        self._frames: dict[int, tuple[tuple[Shape, ...], ...]] = {}
        self._shapes: dict[Shape, Shape] = {}
        self._kinds: dict[tuple[type[Shape], type[Shape]], Found] = {}
        self._made: dict[tuple[int, int], tuple[FeaturePair, ...]] = {}
        self._reaches: dict[int, tuple[float, float]] = {}

    def shapes(self, body: Body) -> tuple[tuple[Shape, ...], ...]:
        """Shapes of each frame of a body of the system. Equal shapes are one object."""
        if id(body) not in self._frames:
            self._frames[id(body)] = tuple(tuple(map(self._first_of, shapes)) for shapes in body.frames)
        return self._frames[id(body)]

    def _first_of(self, shape: Shape) -> Shape:
        try:
            return self._shapes.setdefault(shape, shape)
        except TypeError:  # a shape with fields that cannot be hashed is not shared
            return shape

    def reach(self, shape: Shape) -> tuple[float, float]:
        """Extent and lever of a shape from :meth:`shapes` [m]. They are computed once for equal shapes."""
        if id(shape) not in self._reaches:
            self._reaches[id(shape)] = shape.extent, shape.lever
        return self._reaches[id(shape)]

    def between(self, first: Shape, second: Shape) -> tuple[Sequence[FeaturePair], bool]:
        """Contact geometries of two shapes from :meth:`shapes`; True if the geometries have the shapes in this order.

        Raises
        ------
        InvalidInput
            If no kinematics is installed for the two shapes.
        """
        kinds = type(first), type(second)
        if kinds not in self._kinds:
            self._kinds[kinds] = _kinematics_of(first, second)
        kinematics, in_order = self._kinds[kinds]
        one, two = (first, second) if in_order else (second, first)
        key = id(one), id(two)
        if key not in self._made:
            self._made[key] = tuple(kinematics.between(one, two))
        return self._made[key], in_order


def _kinematics_of(first: Shape, second: Shape) -> Found:
    """Installed kinematics of two shapes, and True if it takes the shapes in this order.

    Raises
    ------
    InvalidInput
        If no kinematics is installed for the two shapes.
    """
    found = installed_pair(first, second)
    if found is None:
        known = registry.load_all("kinematics").values()
        pairs = sorted(f"{k.pair[0].__name__}-{k.pair[1].__name__}" for k in known)
        raise InvalidInput(
            "System.contact",
            "needs shapes whose contact kinematics is known",
            f"{type(first).__name__}-{type(second).__name__}",
            " ".join(filter(None, (first.advice, second.advice, f"Known pairs: {', '.join(pairs)}."))),
        )
    return found


def installed_pair(first: Shape, second: Shape) -> Found | None:
    """Installed kinematics of two shapes, and True if it takes the shapes in this order; None without kinematics."""
    return nearest_pair(registry.load_all("kinematics", _named_after(first, second)).values(), first, second)


def _named_after(first: Shape, second: Shape) -> list[str]:
    """Names of the installed kinematics that may fit two shapes.

    The caller imports only the kinematics with these names. The name "ground-triangle_mesh" belongs to the classes
    Ground and TriangleMesh. A name without a hyphen may belong to any classes.
    """
    kinds = [{_UPPER.sub("_", kind.__name__).lower() for kind in type(shape).__mro__} for shape in (first, second)]
    found = []
    for name in registry.names("kinematics"):
        one, hyphen, two = name.partition("-")
        if not hyphen or any(one in a and two in b for a, b in (kinds, kinds[::-1])):
            found.append(name)
    return found


_UPPER = re.compile(r"(?<!^)(?=[A-Z])")
"""Matches the place before each upper-case letter of a class name except the first: words of the name begin there."""


def nearest_pair(known: Iterable[type[ContactKinematics]], first: Shape, second: Shape) -> Found | None:
    """Kinematics in ``known`` that fits two shapes, and True if it takes the shapes in this order; None if none fits.

    Kinematics of base classes also fit shapes of derived classes. If several fit, the one whose classes are nearest to
    those of the shapes in the class hierarchy is taken.
    """
    best: Found | None = None
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
