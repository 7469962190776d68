"""Tools to write an engine plug-in: add compiled steps, and declare the numbers of the workspace that they use."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from nonsmooth.binding.fingerprint import fingerprint
from nonsmooth.engine.memory.declare import FloatRow, IntegerRow, Life, Singleton, array, question, real, whole
from nonsmooth.engine.memory.sizes import fixed, per
from nonsmooth.engine.native.kernel import add_step, own_kernel

_Function = TypeVar("_Function", bound=Callable[..., Any])

__all__ = [
    "FloatRow",
    "IntegerRow",
    "Life",
    "Singleton",
    "array",
    "fixed",
    "kernel",
    "per",
    "question",
    "real",
    "step",
    "whole",
]


def step(own: type[Singleton], signature: str = "void(ws)") -> Callable[[Callable[..., Any]], str]:
    """Decorator of a step of an engine, a function ``(ws, *numbers)``, which is compiled at its first call.

    The decorated function becomes a name: ``call(name, *numbers)`` in :meth:`Engine.advance` runs the step. A step may
    call the kernels and entry points of :mod:`nonsmooth.engine`, and functions with the decorator :func:`kernel`. The
    machine code is stored in the user's cache folder, under a digest of everything that it depends on.

    Parameters
    ----------
    own : type of Singleton
        Numbers that the engine adds, :attr:`Engine.own`: ``ws.NAME``, where NAME is the key of the class.
    signature : str
        Types of the result and of the arguments: ``ws``, ``f8``, ``i8``, ``b1``, ``void``.
    """
    return lambda function: add_step(function, own, signature, fingerprint)


def kernel(own: type[Singleton], signature: str = "void(ws)") -> Callable[[_Function], _Function]:
    """Decorator of a function that is compiled into the steps that call it. Parameters as for :func:`step`.

    Parameters
    ----------
    own : type of Singleton
        Class that declares the numbers which the engine adds, as for :func:`step`.
    signature : str
        Types of the result and of the arguments, as for :func:`step`. Also allowed are ``v2`` and ``v3``, tuples of two
        and three floats, and records such as ``Contact``.
    """
    return own_kernel(own, signature)
