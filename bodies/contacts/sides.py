"""The parameters of two shapes side by side."""

from __future__ import annotations

from nonsmooth.interfaces import Shape


def by_side(first: Shape, second: Shape) -> dict[str, float]:
    """Return the parameters of both shapes, with _a behind the names of the first's and _b behind the second's."""
    one = {f"{name}_a": value for name, value in first.numbers().items()}
    return one | {f"{name}_b": value for name, value in second.numbers().items()}
