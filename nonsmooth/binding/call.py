"""Calling from Python what the engine calls by address: functions of bodies and of contact pairs outside of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import bind, caller, vector_place
from nonsmooth.parameters import Value

Vector = NDArray[np.float64]


def body_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[float, Vector, Vector, Vector], None]:
    """Function ``call(t, q, u, out)`` that runs a function of the form "body" just as the engine runs it.

    Its vectors are contiguous arrays of floats, and nobody checks their lengths.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    """
    address, heap = bind(function, "body", values, owner)
    return caller("body", address, np.array([*heap, 0.0]))


def pair_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[Vector, Vector, Vector], None]:
    """Function ``call(a, b, out)`` that runs a function of the form "pair" just as the engine runs it.

    Its vectors are contiguous arrays of floats, and nobody checks their lengths.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    """
    return _pair_caller(function, values, owner)[0]


def candidate_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[Vector, Vector, Vector, Vector], None]:
    """Function ``call(a, b, out, candidate)`` for the evaluator of contacts whose features are searched for.

    As :func:`pair_caller`; the candidate is what :class:`nonsmooth.interfaces.CandidateSearch` says, shape [4].
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
    """Call, and the numbers of its parameters."""
    address, heap = bind(function, "pair", values, owner)
    numbers = np.array([*heap, 0.0])
    return caller("pair", address, numbers), numbers
