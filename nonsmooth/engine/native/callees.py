"""The kernels that a function calls, directly or not, in the order in which they are compiled."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, final


@final
@dataclass
class Kernel:
    """A kernel with the signature that it declares.

    Attributes
    ----------
    dispatcher : numba dispatcher
        The kernel as its callers know it.
    signature : numba signature
        Types of its arguments and result.
    is_compiled : bool
        Whether :meth:`compile` was called.
    """

    dispatcher: Any
    signature: Any
    is_compiled: bool = False

    def compile(self) -> None:
        """Compile the kernel for its signature, if it is not compiled yet.

        A call with other types then converts its arguments. Else numba would compile a copy for each set of types.
        """
        if not self.is_compiled:
            self.dispatcher.compile(self.signature)
            # from now on a call with other types does not compile
            self.dispatcher.disable_compile()
            self.is_compiled = True


KERNELS: list[Kernel] = []
"""All kernels, in the order of their definition."""


def callees_of(function: Callable[..., Any]) -> list[Kernel]:
    """The kernels that a function calls, and those that these call, each before its callers, so as to be compiled.

    A kernel is found by the global name under which it is called: ``module.kernel(ws)`` would not be found.
    """
    by_dispatcher = {id(kernel.dispatcher): kernel for kernel in KERNELS}

    def visit(caller: Callable[..., Any]) -> Iterator[Kernel]:
        """Kernels that ``caller`` calls and that were not visited yet. A visited kernel is removed from the mapping."""
        # all names in the code that are not local. Most are no kernels, or kernels that were visited
        for name in caller.__code__.co_names:
            kernel = by_dispatcher.pop(id(caller.__globals__.get(name)), None)
            if kernel is not None:
                yield from visit(kernel.dispatcher.py_func)
                yield kernel

    return list(visit(function))
