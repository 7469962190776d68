"""The numba types of a kernel's arguments and result, from the text of its signature.

``"f8(ws, Contact)"`` takes the workspace and a contact, and returns a float. All names are listed in
:mod:`nonsmooth.engine.native.kernel`. No name stands for an array: kernels reach arrays through the workspace.
"""

from __future__ import annotations

from typing import Any

from numba import types

from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.memory.modes import ENUMERATIONS
from nonsmooth.engine.native.results import type_of_result
from nonsmooth.engine.native.types import FLOATS, INTEGERS
from nonsmooth.engine.native.views import WORKSPACE, Workspace, types_of

_TYPES: dict[str, Any] = {
    "ws": WORKSPACE,
    "F": FLOATS,
    "I": INTEGERS,
    "f8": types.float64,
    "i8": types.int64,
    "b1": types.boolean,
    **{kind.__name__: type_of_result(kind) for kind in ENUMERATIONS},
    **types_of,
    "v2": types.UniTuple(types.float64, 2),
    "v3": types.UniTuple(types.float64, 3),
    "void": types.void,
}


def result(kind: Any) -> Any:
    """Let a kernel return a named tuple of numbers, or an enumeration. Signatures use the name of its class."""
    _TYPES[kind.__name__] = type_of_result(kind)
    return kind


def signature_of(text: str, workspace: Any = WORKSPACE) -> Any:
    """Numba signature of a text. ``workspace`` is the type of ``ws``."""
    returned, _, arguments = text.partition("(")
    names = [name.strip() for name in arguments.rstrip(")").split(",") if name.strip()]
    known = {**_TYPES, "ws": workspace}
    return known[returned.strip()](*[known[name] for name in names])


def workspace_with(own: type[Part]) -> Any:
    """Type of the workspace of an engine that adds a part of its own."""
    return Workspace({own.key: own})
