"""The numba types of the record ``S`` and of the two heaps, and what the optimiser may know of them.

They are plain pointers; what stands there is said at each use, as llvmlite is to drop the types of pointers.  Loads
and stores carry alias metadata: a store into a heap touches neither the other heap nor a scalar, a scalar no other
scalar, and offsets and counts never change while the engine runs.  Without that, every store would make the compiler
read every offset again.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import types
from numba.extending import (
    lower_builtin,
    models,
    register_model,
    type_callable,
)

from nonsmooth.engine.memory.tables import CONSTANT_SCALARS, N_SCALARS, SCALARS
from nonsmooth.engine.native.numba_names import (
    AttributeTemplate,
    Conversion,
    infer_getattr,
    ir,
    lower_cast,
    lower_getattr_generic,
    lower_setattr_generic,
)


class Heap(types.Type):
    """A pointer to floats or integers."""

    def __init__(self, name: str, dtype: Any) -> None:
        self.dtype = dtype
        super().__init__(name=name)


class Table(types.Type):
    """A pointer to the record ``S``, whose fields are all eight bytes long.

    An engine's own, which has further ones at its end, is taken for that of all engines.
    """

    def __init__(self, record: np.dtype[np.void]) -> None:
        self.record = record
        self.names = record.names or ()
        super().__init__(name=f"Scalars({', '.join(self.names[N_SCALARS:])})")

    def can_convert_to(self, context: Any, other: Any) -> Any:
        """Let functions of all engines take an engine's own."""
        return Conversion.safe if other is TABLE else None


FLOATS = Heap("Floats", types.float64)
INTEGERS = Heap("Integers", types.int64)
TABLE = Table(SCALARS)


@register_model(Heap)
class _HeapModel(models.PrimitiveModel):
    def __init__(self, manager: Any, heap: Heap) -> None:
        super().__init__(manager, heap, manager.lookup(heap.dtype).get_data_type().as_pointer())


@register_model(Table)
class _TableModel(models.PrimitiveModel):
    def __init__(self, manager: Any, table: Table) -> None:
        super().__init__(manager, table, ir.IntType(64).as_pointer())


def moved(context: Any, builder: Any, heap: Heap, pointer: Any, offset: Any) -> Any:
    """Return a pointer moved by a number of elements."""
    return builder.gep(pointer, [offset], source_etype=context.get_value_type(heap.dtype))


class Callee:
    """The address of a C function, as llvmlite calls it: with the type of the function, which a pointer need not know.

    Parameters
    ----------
    pointer : llvmlite value
        The address.
    function_type : llvmlite type
        Of the function.
    """

    def __init__(self, pointer: Any, function_type: Any) -> None:
        self.type = pointer.type
        self.function_type = function_type
        self.get_reference = pointer.get_reference


def call_at(builder: Any, address: Any, result: Any, arguments: Sequence[Any]) -> Any:
    """Call the C function at an address, a number; ``result`` is the type of what it returns."""
    function_type = ir.FunctionType(result, [argument.type for argument in arguments])
    return builder.call(Callee(builder.inttoptr(address, function_type.as_pointer()), function_type), arguments)


def tag(access: Any, name: str) -> None:
    """Mark a load or store as one of the memory called ``name``."""
    module = access.function.module
    zero = ir.Constant(ir.IntType(64), 0)
    root = module.add_metadata(["nonsmooth"])
    kind = module.add_metadata([name, root, zero])
    access.set_metadata("tbaa", module.add_metadata([kind, kind, zero]))


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Any:
    def typer(heap: Any, index: Any) -> Any:
        return heap.dtype if isinstance(heap, Heap) and isinstance(index, types.Integer) else None

    return typer


@type_callable(operator.setitem)
def _type_setitem(context: Any) -> Any:
    def typer(heap: Any, index: Any, value: Any) -> Any:
        if isinstance(heap, Heap) and isinstance(index, types.Integer):
            return types.void(heap, types.int64, heap.dtype)
        return None

    return typer


@lower_builtin(operator.getitem, Heap, types.Integer)
def _get_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    heap = signature.args[0]
    load = builder.load(moved(context, builder, heap, *args), typ=context.get_value_type(heap.dtype))
    tag(load, heap.name)
    return load


@lower_builtin(operator.setitem, Heap, types.Integer, types.Any)
def _set_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    heap, _index, value = signature.args
    place = moved(context, builder, heap, args[0], args[1])
    store = builder.store(context.cast(builder, args[2], value, heap.dtype), place)
    tag(store, heap.name)
    return context.get_dummy_value()


@lower_cast(Table, Table)
def _as_other(context: Any, builder: Any, table: Table, other: Table, value: Any) -> Any:
    return value


def field_type(table: Table, name: str) -> Any:
    """Return the numba type of a scalar."""
    return types.float64 if table.record[name].kind == "f" else types.int64


def _field(context: Any, builder: Any, table: Table, value: Any, name: str) -> Any:
    word = ir.IntType(64)
    place = builder.gep(value, [ir.Constant(word, table.names.index(name))], source_etype=word)
    return builder.bitcast(place, context.get_value_type(field_type(table, name)).as_pointer())


@infer_getattr
class _TableFields(AttributeTemplate):
    key = Table

    def generic_resolve(self, table: Table, name: str) -> Any:
        return field_type(table, name) if name in table.names else None


@lower_getattr_generic(Table)
def get_field(context: Any, builder: Any, table: Table, value: Any, name: str) -> Any:
    """Load a scalar of the record."""
    place, kind = _field(context, builder, table, value, name), context.get_value_type(field_type(table, name))
    load = builder.load(place, typ=kind)
    tag(load, name)
    if name in CONSTANT_SCALARS:
        load.set_metadata("invariant.load", builder.module.add_metadata([]))
    return load


@lower_setattr_generic(Table)
def set_field(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    """Store a scalar of the record."""
    table, given = signature.args
    value = context.cast(builder, args[1], given, field_type(table, name))
    tag(builder.store(value, _field(context, builder, table, args[0], name)), name)
