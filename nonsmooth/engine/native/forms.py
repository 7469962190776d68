"""The forms of the functions that the engine calls by address: their arguments, results and what is recorded of them.

Signatures, C prototypes and shims are all made from here.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, final

C_TYPES: Mapping[str, Any] = {
    "f8": ctypes.c_double,
    "i8": ctypes.c_int64,
    "b1": ctypes.c_bool,
    "F": ctypes.c_void_p,
    "void": None,
}
"""C types of arguments and results. ``F`` is a pointer to floats."""


@final
@dataclass(frozen=True)
class Form:
    """The arguments and the result of a function that the engine calls by address.

    Attributes
    ----------
    given : mapping of str to str
        Names and types of the arguments before the parameters of the function.
    returns : bool
        Whether it returns a number. Otherwise it writes to ``out``.
    recorded : mapping of str to int
        Arguments that are recorded for a message if the result is not finite, and how many numbers of each.
    watched : int
        How many numbers of ``out``, from the first, must be finite.
    """

    given: Mapping[str, str]
    returns: bool = False
    recorded: Mapping[str, int] = field(default_factory=dict)
    watched: int = 0

    @cached_property
    def roles(self) -> tuple[str, ...]:
        """Names of the arguments with which a plug-in's function begins. Its own parameters follow, one by one."""
        return (*self.given, *(() if self.returns else ("out",)))

    @cached_property
    def arguments(self) -> Mapping[str, str]:
        """Names and types of the arguments of the C function, in order. ``p`` points to the function's parameters."""
        return {**self.given, "p": "F", **({} if self.returns else {"out": "F"})}

    @cached_property
    def signature(self) -> str:
        """Types of the C function, written like those of a kernel: ``"f8(f8, F)"``."""
        return f"{self._result}({', '.join(self.arguments.values())})"

    @cached_property
    def n_recorded(self) -> int:
        """Total number of floats that are recorded for a message. They come before the parameters of the function."""
        return sum(self.recorded.values())

    @property
    def _result(self) -> str:
        """Type of the result, as signatures write it."""
        return "f8" if self.returns else "void"

    def prototype(self, pointer: Any = ctypes.c_void_p) -> Any:
        """Type of the C function for :mod:`ctypes`. ``pointer`` is that of the arguments F, which point to floats.

        By default it is an address. With a pointer to doubles Python functions can read the floats.
        """
        types = {**C_TYPES, "F": pointer}
        return ctypes.CFUNCTYPE(types[self._result], *[types[kind] for kind in self.arguments.values()])


FORMS: Mapping[str, Form] = {
    "scalar": Form({"x": "f8"}, returns=True, recorded={"x": 1}),
    "compliance": Form(
        {"indentation": "f8", "rate": "f8", "closing_rate": "f8"},
        returns=True,
        recorded={"indentation": 1, "rate": 1, "closing_rate": 1},
    ),
    "traction": Form(
        {"normal_force": "f8", "motion": "F", "state": "F"}, recorded={"normal_force": 1, "motion": 5}, watched=5
    ),
    "rates": Form({"speed": "f8", "state": "F"}, recorded={"speed": 1}, watched=1),
    "guard": Form({"t": "f8", "q": "F", "u": "F"}, returns=True),
    "body": Form({"t": "f8", "q": "F", "u": "F"}),
    "load": Form({"t": "f8", "a": "F", "b": "F"}),
    "pair": Form({"a": "F", "b": "F"}),
    "map": Form({"n": "i8", "delassus": "F", "rates": "F"}),
    "support": Form({"direction": "F"}),
}
"""All forms by name."""
