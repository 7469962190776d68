"""The numba types of the record of scalars, of floats and of integers, and what the optimiser may know of them.

All three are pointers. Each access names the type of the number, because llvmlite is about to drop the types of
pointers. Loads and stores carry alias metadata:

* a store to floats changes neither integers nor scalars;
* a store to a scalar changes no other scalar;
* offsets and counts never change while the engine runs.

Without it, the compiler would load each offset again after each store.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import types
from numba.extending import lower_builtin, models, register_model, type_callable

from nonsmooth.engine.memory.tables import CONSTANT_SCALARS, N_SCALARS, SCALARS
from nonsmooth.engine.native.numba_names import ir


class Pointer(types.Type):
    """A pointer to floats or integers."""

    def __init__(self, name: str, dtype: Any) -> None:
        self.dtype = dtype
        super().__init__(name=name)


class ScalarRecord(types.Type):
    """A pointer to the record of scalars, all of which are eight bytes long.

    The record of an engine with a part of its own has further scalars at its end, by which its type is named.
    """

    def __init__(self, record: np.dtype[np.void]) -> None:
        self.record = record
        self.names = record.names or ()
        super().__init__(name=f"Scalars({', '.join(self.names[N_SCALARS:])})")


FLOATS = Pointer("Floats", types.float64)
INTEGERS = Pointer("Integers", types.int64)
SCALAR_RECORD = ScalarRecord(SCALARS)


@register_model(Pointer)
class _PointerModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Pointer) -> None:
        super().__init__(manager, kind, manager.lookup(kind.dtype).get_data_type().as_pointer())


@register_model(ScalarRecord)
class _ScalarRecordModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: ScalarRecord) -> None:
        super().__init__(manager, kind, ir.IntType(64).as_pointer())


def moved(context: Any, builder: Any, kind: Pointer, pointer: Any, offset: Any) -> Any:
    """The pointer ``offset`` elements further."""
    return builder.gep(pointer, [offset], source_etype=context.get_value_type(kind.dtype))


def load(context: Any, builder: Any, kind: Pointer, place: Any) -> Any:
    """Load the number at a pointer."""
    number = builder.load(place, typ=context.get_value_type(kind.dtype))
    tag(number, kind.name)
    return number


def store(builder: Any, kind: Pointer, place: Any, number: Any) -> None:
    """Store a number at a pointer."""
    tag(builder.store(number, place), kind.name)


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
        self.type = pointer.type
        self.function_type = function_type
        self.get_reference = pointer.get_reference


def call_at(builder: Any, address: Any, result: Any, arguments: Sequence[Any]) -> Any:
    """Call the C function at an address, which is an integer. ``result`` is the llvmlite type of its result."""
    function_type = ir.FunctionType(result, [argument.type for argument in arguments])
    return builder.call(Callee(builder.inttoptr(address, function_type.as_pointer()), function_type), arguments)


def tag(access: Any, name: str) -> None:
    """Mark a load or store as one of the memory called ``name``. Memories of different names do not overlap."""
    module = access.function.module
    zero = ir.Constant(ir.IntType(64), 0)
    root = module.add_metadata(["nonsmooth"])
    kind = module.add_metadata([name, root, zero])
    access.set_metadata("tbaa", module.add_metadata([kind, kind, zero]))


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Any:
    def typer(pointer: Any, index: Any) -> Any:
        return pointer.dtype if isinstance(pointer, Pointer) and isinstance(index, types.Integer) else None

    return typer


@type_callable(operator.setitem)
def _type_setitem(context: Any) -> Any:
    def typer(pointer: Any, index: Any, value: Any) -> Any:
        if isinstance(pointer, Pointer) and isinstance(index, types.Integer):
            return types.void(pointer, types.int64, pointer.dtype)
        return None

    return typer


@lower_builtin(operator.getitem, Pointer, types.Integer)
def _get_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    kind = signature.args[0]
    return load(context, builder, kind, moved(context, builder, kind, *args))


@lower_builtin(operator.setitem, Pointer, types.Integer, types.Any)
def _set_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    kind, _index, given = signature.args
    place = moved(context, builder, kind, args[0], args[1])
    store(builder, kind, place, context.cast(builder, args[2], given, kind.dtype))
    return context.get_dummy_value()


def type_of_scalar(scalars: ScalarRecord, name: str) -> Any:
    """Numba type of a scalar."""
    return types.float64 if scalars.record[name].kind == "f" else types.int64


def _place_of_scalar(context: Any, builder: Any, scalars: ScalarRecord, pointer: Any, name: str) -> Any:
    word = ir.IntType(64)
    place = builder.gep(pointer, [ir.Constant(word, scalars.names.index(name))], source_etype=word)
    return builder.bitcast(place, context.get_value_type(type_of_scalar(scalars, name)).as_pointer())


def load_scalar(context: Any, builder: Any, scalars: ScalarRecord, pointer: Any, name: str) -> Any:
    """Load a scalar of the record at a pointer."""
    place = _place_of_scalar(context, builder, scalars, pointer, name)
    number = builder.load(place, typ=context.get_value_type(type_of_scalar(scalars, name)))
    tag(number, name)
    if name in CONSTANT_SCALARS:
        number.set_metadata("invariant.load", builder.module.add_metadata([]))
    return number


def store_scalar(
    context: Any, builder: Any, scalars: ScalarRecord, pointer: Any, name: str, value: Any, given: Any
) -> None:
    """Store a value of the numba type ``given`` as a scalar of the record at a pointer."""
    number = context.cast(builder, value, given, type_of_scalar(scalars, name))
    tag(builder.store(number, _place_of_scalar(context, builder, scalars, pointer, name)), name)
