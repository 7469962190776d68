"""The numba types of a kernel's arguments and result, from the text of its signature.

``"f8(ws, ContactRecord)"`` takes the workspace and a contact, and returns a float. All names are listed in
:mod:`nonsmooth.engine.native.kernel`. No name stands for an array: kernels reach arrays through the workspace.

The module also adds ``_replace`` of named tuples to the compiled code of kernels, because numba does not support it.
"""

from __future__ import annotations

import inspect
from enum import IntEnum
from typing import Any, get_type_hints

from numba import types
from numba.extending import lower_builtin

from nonsmooth.engine.memory.declare import Singleton
from nonsmooth.engine.memory.modes import ENUMERATIONS
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.native.numba_names import AbstractTemplate, AttributeTemplate, infer_getattr, signature
from nonsmooth.engine.native.types import FLOATS, INTEGERS, type_of_number
from nonsmooth.engine.native.views import WORKSPACE, WorkspaceType, types_of


def type_of_result(kind: Any) -> Any:
    """Numba type of what a kernel may return: a member of the enumeration ``kind``, or a named tuple of that class.

    The fields of a named tuple are numbers, whose types are those of its type hints.
    """
    if issubclass(kind, IntEnum):
        return type_of_number(kind)
    return types.BaseTuple.from_types([type_of_number(hint) for hint in get_type_hints(kind).values()], kind)


_TYPES: dict[str, Any] = {
    "ws": WORKSPACE,
    "F": FLOATS,
    "I": INTEGERS,
    "f8": types.float64,
    "i8": types.int64,
    "b1": types.boolean,
    **{kind.__name__: type_of_result(kind) for kind in (*ENUMERATIONS, Solver)},
    **types_of,
    "v2": types.UniTuple(types.float64, 2),
    "v3": types.UniTuple(types.float64, 3),
    "void": types.void,
}


def result(kind: Any) -> Any:
    """Let signatures of kernels use the name of a class: a named tuple of numbers, or an enumeration.

    It decorates the class, which stays as it is.
    """
    _TYPES[kind.__name__] = type_of_result(kind)
    return kind


def signature_of(text: str, workspace: Any = WORKSPACE) -> Any:
    """Numba signature of a kernel from a text as ``"f8(ws, ContactRecord)"``: result, then arguments in parentheses.

    ``workspace`` is the numba type of ``ws``. An engine that adds a part to the workspace gives its own type, made by
    :func:`workspace_with`.
    """
    returned, _, arguments = text.partition("(")
    # a kernel without arguments has an empty text between the parentheses
    names = [name.strip() for name in arguments.rstrip(")").split(",") if name.strip()]
    known = {**_TYPES, "ws": workspace}
    return known[returned.strip()](*[known[name] for name in names])


def workspace_with(own: type[Singleton]) -> Any:
    """Numba type of the workspace of an engine that adds a part ``own``: numbers that the other engines do not have."""
    return WorkspaceType({own.key: own})


class _Replace(AbstractTemplate):
    """Typing of ``_replace`` of a named tuple: all fields are parameters, and those that are not passed are omitted."""

    key = "result._replace"

    def generic(self, args: Any, keywords: Any) -> Any:
        """Signature of a call, by the names in ``keywords``. Numba needs it if a kernel calls ``_replace``.

        ``this`` is the type of the named tuple: that of the result, and of the receiver of the call. Each value that is
        passed is converted to the type of its field. ``pysig`` lets numba put keywords in the order of the fields.
        """
        fields = self.this.fields
        numbers = zip(fields, self.this, strict=True)
        given = [kind if name in keywords else types.Omitted(None) for name, kind in numbers]
        parameters = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=None) for name in fields]
        found = signature(self.this, *given, recvr=self.this)
        return found.replace(pysig=inspect.Signature(parameters))


@infer_getattr
class _Methods(AttributeTemplate):
    """Methods of named tuples in kernels, beyond those of numba."""

    key = types.BaseNamedTuple

    def resolve__replace(self, result: Any) -> Any:
        """Type of the attribute ``_replace``. Numba finds this method by its name, ``resolve_`` and the attribute."""
        return types.BoundFunction(_Replace, result)


@lower_builtin("result._replace", types.BaseTuple, types.VarArg(types.Any))
def _replace(context: Any, builder: Any, called: Any, args: Any) -> Any:
    """Code of ``old._replace(...)``: the old tuple with the values that are passed in their places.

    Numba calls this where the call is compiled. ``called`` is its signature: the tuple, then all fields in order, with
    the type `Omitted` for those that keep their value.
    """
    old, *new = args
    for i, kind in enumerate(called.args[1:]):
        if not isinstance(kind, types.Omitted):
            old = builder.insert_value(old, new[i], i)
    return old
