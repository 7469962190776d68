"""The parameters of two shapes side by side."""

from __future__ import annotations

from nonsmooth.interfaces import Shape

UNSEEN = ("foot_height",)
"""What a shape says of itself that its contacts with others than planes do not see."""


def by_side(first: Shape, second: Shape) -> dict[str, float]:
    """Return the parameters of both shapes, with _a behind the names of the first's and _b behind the second's."""
    sides = ("a", first.numbers()), ("b", second.numbers())
    return {f"{name}_{side}": value for side, numbers in sides for name, value in numbers.items() if name not in UNSEEN}
