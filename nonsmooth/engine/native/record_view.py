"""The numba type of a record with named fields (:mod:`nonsmooth.engine.memory.records`).

It is the record ``S``, both heaps and a number; a field is loaded and stored as the heap's entry is.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    lower_setattr_generic,
    models,
    register_model,
)

from nonsmooth.engine.memory.fields import Field, Fields
from nonsmooth.engine.memory.records import PACKED, RECORDS
from nonsmooth.engine.native.types import FLOATS, INTEGERS, TABLE, get_field, moved, tag


class Record(types.Type):  # type: ignore[misc]
    """A record of a kind, with its fields by name."""

    def __init__(self, kind: str, fields: Fields) -> None:
        self.fields = fields
        super().__init__(name=f"Record({kind})")


@register_model(Record)
class _RecordModel(models.StructModel):  # type: ignore[misc]
    def __init__(self, manager: Any, record: Record) -> None:
        super().__init__(manager, record, [("S", TABLE), ("w", FLOATS), ("k", INTEGERS), ("n", types.int64)])


def _heap_of(field: Field) -> Any:
    return FLOATS if field.is_float else INTEGERS


@infer_getattr
class _RecordFields(AttributeTemplate):  # type: ignore[misc]
    key = Record

    def generic_resolve(self, record: Record, name: str) -> Any:
        field = record.fields.get(name)
        if field is None:
            return None
        heap = _heap_of(field)
        if field.is_vector:
            return types.UniTuple(heap.dtype, field.numbers)
        return heap.dtype if field.numbers == 1 else heap


def _place(context: Any, builder: Any, record: Record, value: Any, field: Field) -> Any:
    """Return a pointer to the first number of a field."""
    word = ir.IntType(64)
    parts = cgutils.create_struct_proxy(record)(context, builder, value=value)
    offset = builder.mul(parts.n, ir.Constant(word, field.stride)) if field.array else parts.n
    for name in (field.array, field.behind):
        if name:
            offset = builder.add(get_field(context, builder, TABLE, parts.S, name), offset)
    offset = builder.add(offset, ir.Constant(word, field.first))
    heap = _heap_of(field)
    return moved(context, builder, heap, parts.w if heap is FLOATS else parts.k, offset)


def _entry(context: Any, builder: Any, heap: Any, place: Any, i: int) -> Any:
    return moved(context, builder, heap, place, ir.Constant(ir.IntType(64), i))


def _load(context: Any, builder: Any, heap: Any, place: Any) -> Any:
    load = builder.load(place, typ=context.get_value_type(heap.dtype))
    tag(load, heap.name)
    return load


@lower_getattr_generic(Record)  # type: ignore[untyped-decorator]
def _get_field(context: Any, builder: Any, record: Record, value: Any, name: str) -> Any:
    field = record.fields[name]
    heap, place = _heap_of(field), _place(context, builder, record, value, field)
    if field.is_vector:
        places = [_entry(context, builder, heap, place, i) for i in range(field.numbers)]
        numbers = [_load(context, builder, heap, one) for one in places]
        return context.make_tuple(builder, types.UniTuple(heap.dtype, field.numbers), numbers)
    return place if field.numbers > 1 else _load(context, builder, heap, place)


@lower_setattr_generic(Record)  # type: ignore[untyped-decorator]
def _set_field(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    record, given = signature.args
    field = record.fields[name]
    heap, place = _heap_of(field), _place(context, builder, record, args[0], field)
    if field.is_vector:
        vector = types.UniTuple(heap.dtype, field.numbers)
        numbers = cgutils.unpack_tuple(builder, context.cast(builder, args[1], given, vector))
        for i, number in enumerate(numbers):
            tag(builder.store(number, _entry(context, builder, heap, place, i)), heap.name)
        return
    tag(builder.store(context.cast(builder, args[1], given, heap.dtype), place), heap.name)


types_of = {kind: Record(kind, fields) for kind, fields in (*RECORDS.items(), *PACKED.items())}
"""The numba types of the records by kind."""


def _indexed(kind: str) -> Any:
    record = types_of[kind]

    def view(typingctx: Any, S: Any, w: Any, k: Any, number: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            parts = cgutils.create_struct_proxy(record)(context, builder)
            parts.S, parts.w, parts.k, parts.n = args
            return parts._getvalue()

        return record(TABLE, FLOATS, INTEGERS, types.int64), codegen

    return intrinsic(view)


def _packed(kind: str) -> Any:
    record = types_of[kind]
    stride = next(iter(PACKED[kind].values())).stride

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        parts = cgutils.create_struct_proxy(record)(context, builder)
        parts.w, parts.n = args[0], args[1]
        if stride > 0:
            parts.n = builder.add(args[1], builder.mul(args[2], ir.Constant(ir.IntType(64), stride)))
        return parts._getvalue()

    def single(typingctx: Any, w: Any, start: Any) -> Any:
        return record(FLOATS, types.int64), codegen

    def one_of_many(typingctx: Any, w: Any, start: Any, number: Any) -> Any:
        return record(FLOATS, types.int64, types.int64), codegen

    return intrinsic(one_of_many if stride > 0 else single)


records = {kind: _indexed(kind) for kind in RECORDS} | {kind: _packed(kind) for kind in PACKED}
"""What makes a record of each kind."""
