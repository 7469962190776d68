"""From a method of a shape to an address that the engine calls: its declared numbers stand for the shape."""

from __future__ import annotations

import functools
from collections import namedtuple
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.binding.compile import bind, bind_in_python, refused
from nonsmooth.engine.native.kernel import PLAIN, shared
from nonsmooth.interfaces import ConvexShape

_BY_NUMBERS = """def support(direction, out, middle_x, middle_y, middle_z{names}):
 point = method(Numbers({values}), array((direction[0], direction[1], direction[2])))
 x, y, z = (point[0], point[1], point[2]) if len(point) == 3 else (nan, nan, nan)
 out[0], out[1], out[2] = x - middle_x, y - middle_y, z - middle_z
"""


def bind_support(shape: ConvexShape, middle: tuple[float, float, float]) -> tuple[int, tuple[float, ...]]:
    """Compile the method ``support`` of a shape, which may use of ``self`` the declared numbers.

    If it uses more, or what numba does not know, it runs in Python; that makes a warning, with the reason.

    Parameters
    ----------
    shape : ConvexShape
        The shape.
    middle : tuple of float
        From where the points are told [m].

    Returns
    -------
    tuple of int and tuple of float
        As of :func:`nonsmooth.binding.compile.bind`, for ``support(direction, out)``.
    """
    owner = type(shape)
    numbers = shape.numbers()
    by_numbers = _by_numbers(owner, tuple(numbers))
    why = None if PLAIN else refused(by_numbers, "support")
    if PLAIN or why is not None:

        def support(direction: Any, out: Any) -> None:
            point = shape.support(np.array([direction[0], direction[1], direction[2]]))
            for i in range(3):
                out[i] = point[i] - middle[i]

        if why is None:
            return bind(support, "support", {}, owner.__name__)
        return bind_in_python(support, "support", owner.__name__, owner.support, why)
    places = dict(zip(("middle_x", "middle_y", "middle_z"), middle, strict=True))
    return bind(
        by_numbers, "support", {**places, **{f"{name}_": value for name, value in numbers.items()}}, owner.__name__
    )


@functools.cache
def _by_numbers(owner: type[ConvexShape], names: tuple[str, ...]) -> Callable[..., Any]:
    scope: dict[str, Any] = {
        "__name__": __name__,
        "array": np.array,
        "nan": np.nan,
        "method": shared(owner.support),
        "Numbers": namedtuple("Numbers", names),
    }
    values = ", ".join(f"{name}_" for name in names)
    exec(_BY_NUMBERS.format(names="".join(f", {name}_" for name in names), values=values), scope)
    function: Callable[..., Any] = scope["support"]
    return function
