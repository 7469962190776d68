"""What an engine of your own is made of: compiled steps, and the numbers that they work with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from nonsmooth.binding.fingerprint import fingerprint
from nonsmooth.engine.memory.declare import FloatRow, IntegerRow, Life, Part, array, question, real, whole
from nonsmooth.engine.memory.sizes import fixed, per
from nonsmooth.engine.native.kernel import add_step, own_kernel

_Function = TypeVar("_Function", bound=Callable[..., Any])

__all__ = [
    "FloatRow",
    "IntegerRow",
    "Life",
    "Part",
    "array",
    "fixed",
    "kernel",
    "per",
    "question",
    "real",
    "step",
    "whole",
]


def step(own: type[Part], signature: str = "void(ws)") -> Callable[[Callable[..., Any]], str]:
    """Compile a function ``(ws, *numbers)`` when an engine first calls it; its name becomes what ``call`` takes.

    It may call the kernels and entry points of :mod:`nonsmooth.engine`, and those of :func:`kernel`, by their names.
    What is compiled is kept in the user's cache folder, under a digest of all that it depends on.

    Parameters
    ----------
    own : type of Part
        Numbers of the engine's own, :attr:`Engine.own`: ``ws.NAME`` with the key of the class for its name.
    signature : str
        Types of the result and of the arguments: ``ws``, ``f8``, ``i8``, ``b1``, ``void``.
    """
    return lambda function: add_step(function, own, signature, fingerprint)


def kernel(own: type[Part], signature: str = "void(ws)") -> Callable[[_Function], _Function]:
    """Compile a function into the steps that call it; parameters as those of :func:`step`.

    Parameters
    ----------
    own : type of Part
        As of :func:`step`.
    signature : str
        Likewise; also ``v2`` and ``v3``, tuples of two and three floats, and owners of records, as ``Contact``.
    """
    return own_kernel(own, signature)
