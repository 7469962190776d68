"""Call the functions of contact pairs from Python, outside of a run, just as the engine calls them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from nonsmooth.binding.compile import bind, caller, vector_place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value


def pair_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[Vector, Vector, Vector], None]:
    """Function ``call(a, b, out)`` that runs the evaluator of a contact pair just as the engine runs it.

    From the frame blocks a and b of two bodies it writes the geometry block of the contact to ``out``
    (:class:`nonsmooth.interfaces.ContactKinematics`).

    The vectors must be contiguous arrays of floats. Their lengths are not checked.

    Raises
    ------
    UnknownName
        If the function has a parameter without a value in ``values``.
    """
    return _pair_caller(function, values, owner)[0]


def candidate_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[Vector, Vector, Vector, Vector], None]:
    """Function ``call(a, b, out, candidate)`` for the evaluator of contacts whose features are searched for.

    ``candidate`` is one pair of features that the search has found, shape [4]
    (:class:`nonsmooth.interfaces.CandidateSearch`). Vectors and errors are those of :func:`pair_caller`.
    """
    call, numbers = _pair_caller(function, values, owner)
    place = vector_place(function, "pair", numbers.tolist(), "candidate")

    def call_with(a: Vector, b: Vector, out: Vector, candidate: Vector) -> None:
        numbers[place : place + len(candidate)] = candidate
        call(a, b, out)

    return call_with


def _pair_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> tuple[Callable[[Vector, Vector, Vector], None], Vector]:
    """Function ``call(a, b, out)`` of :func:`pair_caller`, and the block of the evaluator's parameters.

    The block may be changed between calls.
    """
    address, heap = bind(function, "pair", values, owner)
    numbers = np.array([*heap, 0.0])
    return caller("pair", address, numbers), numbers
