"""The numba types of floats and of integers, and what the optimiser may know of the numbers of the workspace.

The workspace is reached by pointers. Each access names the type of the number, because llvmlite is about to drop the
types of pointers. Loads and stores carry alias metadata:

* a store to floats changes neither integers nor scalars;
* a store to a scalar changes no other scalar;
* offsets and counts never change while the engine runs.

Without it, the compiler would load each offset again after each store.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Any

from numba import types
from numba.extending import models, register_model

from nonsmooth.engine.memory.tables import CONSTANT_SCALARS
from nonsmooth.engine.native.numba_names import ir

WORD = ir.IntType(64)
"""The llvmlite type of integers, booleans and members of enumerations in memory."""
_TYPES = {bool: types.boolean, int: types.int64, float: types.float64}


def type_of_number(kind: type) -> Any:
    """Numba type of a number of a Python type: bool, int, float, or a class of integer enumeration."""
    return types.IntEnumMember(kind, types.int64) if issubclass(kind, IntEnum) else _TYPES[kind]


def stored_type(kind: type) -> Any:
    """The llvmlite type of a number of a Python type in memory: floats, and integers for all else, 64 bits each."""
    return ir.DoubleType() if kind is float else WORD


class Pointer(types.Type):
    """A pointer to floats or integers.

    Parameters
    ----------
    name : str
        Name of the memory, for :func:`tag`.
    kind : type
        float or int.
    """

    def __init__(self, name: str, kind: type) -> None:
        """Set the types of the numbers, in Python and in numba. Numba compares types by their names."""
        self.kind, self.dtype = kind, _TYPES[kind]
        super().__init__(name=name)


FLOATS, INTEGERS, SCALARS = Pointer("Floats", float), Pointer("Integers", int), Pointer("Scalars", int)


@register_model(Pointer)
class _PointerModel(models.PrimitiveModel):
    """Storage of a :class:`Pointer`, which numba needs of each type: one LLVM pointer."""

    def __init__(self, manager: Any, pointer: Pointer) -> None:
        """Give numba the llvmlite type of the pointer."""
        super().__init__(manager, pointer, stored_type(pointer.kind).as_pointer())


def pointer_to(kind: type) -> Pointer:
    """Type of a pointer to numbers of a Python type. Booleans and members of enumerations are among the integers."""
    return FLOATS if kind is float else INTEGERS


def moved(builder: Any, kind: type, pointer: Any, offset: Any) -> Any:
    """Write code that moves a pointer by ``offset`` numbers of a Python type, all of 64 bits. The new pointer."""
    return builder.gep(pointer, [offset], source_etype=stored_type(kind))


def load(builder: Any, kind: type, place: Any, memory: str = "") -> Any:
    """Write code that loads the number of a Python type at the pointer ``place``. The number.

    ``memory`` is the name of a scalar, or empty for the floats or integers. The compiler may assume that stores to
    other memories do not change the number (:func:`tag`).
    """
    number = builder.load(place, typ=stored_type(kind))
    tag(number, memory or pointer_to(kind).name)
    # offsets and counts never change while the engine runs: no store at all makes the compiler load them again
    if memory in CONSTANT_SCALARS:
        number.set_metadata("invariant.load", builder.module.add_metadata([]))
    # a boolean is an integer in memory, any but 0 for True, and a single bit in a register
    return builder.icmp_signed("!=", number, WORD(0)) if kind is bool else number


def store(builder: Any, kind: type, place: Any, number: Any, memory: str = "") -> None:
    """Write code that stores a number of a Python type at the pointer ``place``.

    ``memory`` is the name of a scalar, or empty for the floats or integers. The compiler may assume that numbers of
    other memories do not change (:func:`tag`).
    """
    # a boolean is a single bit in a register, and an integer in memory
    stored = builder.zext(number, WORD) if kind is bool else number
    tag(builder.store(stored, place), memory or pointer_to(kind).name)


def tag(access: Any, memory: str) -> None:
    """Mark a load or store as one of the memory of that name: the compiler may assume that others do not overlap it.

    Without the mark each store would make it load all offsets again.
    """
    module = access.function.module
    # metadata of type-based alias analysis: the name is a type under a common root, and the access one of this type.
    # Each zero is an offset within the type, as a number has no members
    root = module.add_metadata(["nonsmooth"])
    kind = module.add_metadata([memory, root, WORD(0)])
    access.set_metadata("tbaa", module.add_metadata([kind, kind, WORD(0)]))


class Callee:
    """A C function with its type, as llvmlite wants it in a call; a pointer need not know the type.

    Parameters
    ----------
    pointer : llvmlite value
        The address.
    function_type : llvmlite type
        Type of the function.
    """

    def __init__(self, pointer: Any, function_type: Any) -> None:
        """Set the attributes that llvmlite reads of the function in a call."""
        self.type = pointer.type
        self.function_type = function_type
        self.get_reference = pointer.get_reference


def call_at(builder: Any, address: Any, result: Any, arguments: Sequence[Any]) -> Any:
    """Write code that calls the C function at an address, an integer. ``result`` is the llvmlite type of its result.

    The value is the result. The types of the parameters are those of the arguments.
    """
    function_type = ir.FunctionType(result, [argument.type for argument in arguments])
    return builder.call(Callee(builder.inttoptr(address, function_type.as_pointer()), function_type), arguments)
