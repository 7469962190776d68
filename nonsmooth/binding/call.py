"""Call the functions of bodies from Python, outside of a run, just as the engine calls them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import bind, caller
from nonsmooth.parameters import Value

Vector = NDArray[np.float64]


def body_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[float, Vector, Vector, Vector], None]:
    """Function ``call(t, q, u, out)`` that runs the evaluator of a body just as the engine runs it.

    At time t [s], coordinates q and velocities u it writes the output block of the body to ``out``
    (:class:`nonsmooth.interfaces.Body`).

    The vectors must be contiguous arrays of floats. Their lengths are not checked.

    Raises
    ------
    UnknownName
        If the function has a parameter without a value in ``values``.
    """
    address, heap = bind(function, "body", values, owner)
    return caller("body", address, np.array([*heap, 0.0]))
