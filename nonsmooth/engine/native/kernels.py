"""Decorators of kernels: functions of the engine that are compiled into their callers.

Nothing is compiled when a module is imported. A kernel is compiled when an entry point that calls it is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.native.callees import KERNELS, Kernel
from nonsmooth.engine.native.compiler import kernel_dispatcher
from nonsmooth.engine.native.signatures import signature_of, workspace_with


def kernel(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Make a kernel with the given signature."""
    return _kernel(signature_of(signature))


def own_kernel(own: type[Part], signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Make a kernel of an engine that adds a part of its own to the workspace."""
    return _kernel(signature_of(signature, workspace_with(own)))


def _kernel(signature: Any) -> Callable[[Callable[..., Any]], Any]:
    def decorate(function: Callable[..., Any]) -> Any:
        dispatcher = kernel_dispatcher(function)
        KERNELS.append(Kernel(dispatcher, signature))
        return dispatcher

    return decorate
