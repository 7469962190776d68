"""What an engine of one's own is made of: compiled steps, and scalars and arrays that they work with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from nonsmooth.binding.fingerprint import fingerprint
from nonsmooth.engine.memory.arrays.arrays import Arrays, fixed, per, real, whole
from nonsmooth.engine.native.kernel import add_step, own_kernel

_Function = TypeVar("_Function", bound=Callable[..., Any])

__all__ = ["Arrays", "fixed", "kernel", "per", "real", "step", "whole"]


def step(own: Arrays, signature: str = "void(ws)") -> Callable[[Callable[..., Any]], str]:
    """Compile a function ``(ws, *numbers)`` when an engine first calls it; its name becomes what ``call`` takes.

    It may call the kernels and entry points of :mod:`nonsmooth.engine`, and those of :func:`kernel`, by their names.
    What is compiled is kept in the user's cache folder, under a digest of all that it depends on.

    Parameters
    ----------
    own : Arrays
        Scalars and arrays of the engine's own, which ``S`` has besides those of all: its :attr:`Engine.own`.
    signature : str
        Types of the result and of the arguments: ``ws``, ``F`` (floats), ``I`` (integers), ``f8``, ``i8``, ``void``.
    """
    return lambda function: add_step(function, own, signature, fingerprint)


def kernel(own: Arrays, signature: str = "void(ws)") -> Callable[[_Function], _Function]:
    """Compile a function into the steps that call it; parameters as those of :func:`step`, and tuples of floats.

    Parameters
    ----------
    own : Arrays
        As of :func:`step`.
    signature : str
        Likewise; ``v2`` and ``v3`` are tuples of two and three floats.
    """
    return own_kernel(own, signature)
