"""Which shapes of two bodies may touch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape

Frames: TypeAlias = tuple[tuple[Shape, ...], ...]


@dataclass(frozen=True)
class Side:
    """A shape as one side of a contact.

    Attributes
    ----------
    body : Body
        Who carries it.
    frame : int
        Number of the frame that carries it.
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
    """Return the shapes chosen of either body, in the order of its frames; ``carried`` gives those of each frame.

    Raises
    ------
    InvalidInput
        If a body carries no shapes, or the choice is not, for either body, None or numbers of its shapes, each once.
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
