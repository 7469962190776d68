"""The numba type of a contact with named fields (:mod:`nonsmooth.engine.memory.contact_fields`).

It is the record ``S``, both heaps and the number of the contact; a field is loaded and stored as the heap's entry is.
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

from nonsmooth.engine.memory.contact_fields import NUMBERS
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS
from nonsmooth.engine.native.types import FLOATS, INTEGERS, TABLE, get_field, moved, tag


class Contact(types.Type):  # type: ignore[misc]
    """A contact with named fields."""

    def __init__(self) -> None:
        super().__init__(name="Contact")


CONTACT = Contact()


@register_model(Contact)
class _ContactModel(models.StructModel):  # type: ignore[misc]
    def __init__(self, manager: Any, contact: Contact) -> None:
        super().__init__(manager, contact, [("S", TABLE), ("w", FLOATS), ("k", INTEGERS), ("c", types.int64)])


def _heap_of(name: str) -> Any:
    return FLOATS if name in FLOAT_ARRAYS else INTEGERS


@infer_getattr
class _ContactFields(AttributeTemplate):  # type: ignore[misc]
    key = Contact

    def generic_resolve(self, contact: Contact, name: str) -> Any:
        if name not in NUMBERS:
            return None
        return _heap_of(name).dtype if NUMBERS[name] == 1 else _heap_of(name)


def _place(context: Any, builder: Any, value: Any, name: str) -> Any:
    """Return a pointer to the first number of a field."""
    parts = cgutils.create_struct_proxy(CONTACT)(context, builder, value=value)
    behind = builder.mul(parts.c, ir.Constant(ir.IntType(64), NUMBERS[name]))
    heap = _heap_of(name)
    offset = builder.add(get_field(context, builder, TABLE, parts.S, name), behind)
    return moved(context, builder, heap, parts.w if heap is FLOATS else parts.k, offset)


@lower_getattr_generic(Contact)  # type: ignore[untyped-decorator]
def _get_field(context: Any, builder: Any, contact: Contact, value: Any, name: str) -> Any:
    place = _place(context, builder, value, name)
    if NUMBERS[name] > 1:
        return place
    heap = _heap_of(name)
    load = builder.load(place, typ=context.get_value_type(heap.dtype))
    tag(load, heap.name)
    return load


@lower_setattr_generic(Contact)  # type: ignore[untyped-decorator]
def _set_field(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    heap = _heap_of(name)
    value = context.cast(builder, args[1], signature.args[1], heap.dtype)
    tag(builder.store(value, _place(context, builder, args[0], name)), heap.name)


@intrinsic  # type: ignore[untyped-decorator]
def contact_at(typingctx: Any, S: Any, w: Any, k: Any, c: Any) -> Any:
    """Return contact ``c`` with its fields by name."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        parts = cgutils.create_struct_proxy(CONTACT)(context, builder)
        parts.S, parts.w, parts.k, parts.c = args
        return parts._getvalue()

    return CONTACT(TABLE, FLOATS, INTEGERS, types.int64), codegen
