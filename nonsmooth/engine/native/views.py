"""The numba type of the workspace: one argument that reaches every number of the engine by name.

A workspace consists of three pointers: to scalars, floats and integers. ``ws.island`` is a part of it,
``ws.island.time`` a scalar, ``ws.island.y`` an array, ``ws.contacts[c]`` a record. The compiler resolves all names into
the loads and stores that pointers and offsets would give.

A named tuple of arrays would be the obvious way. But numba counts references to arrays, which makes loops ten times
slower, and passes each array to each function, which makes compiling take minutes.
"""

from __future__ import annotations

import operator
from collections.abc import Mapping
from typing import Any

from numba import types
from numba.extending import intrinsic, lower_builtin, make_attribute_wrapper, models, register_model, type_callable

from nonsmooth.engine.memory.declare import Declaration, declarations
from nonsmooth.engine.memory.declare import Part as Owner
from nonsmooth.engine.memory.fields import Field, Fields, fields_of
from nonsmooth.engine.memory.tables import N_SCALARS, record_with
from nonsmooth.engine.memory.workspace import PARTS, RECORDS
from nonsmooth.engine.memory.written import PACKED
from nonsmooth.engine.native import numba_names as private
from nonsmooth.engine.native.types import (
    FLOATS,
    INTEGERS,
    SCALARS,
    WORD,
    Pointer,
    load,
    moved,
    pointer_to,
    store,
    stored_type,
    type_of_number,
)

_POINTERS = (("scalars", SCALARS), ("floats", FLOATS), ("integers", INTEGERS))
_NAMES = record_with(()).names or ()


class View(types.Type):
    """A type whose numbers are attributes.

    Its classes have the methods ``type_of``, which gives the numba type of an attribute, or None for an unknown name,
    ``load``, and ``store``, whose value is of the attribute's type.

    Attributes
    ----------
    members : tuple
        Names and types of the values that it consists of.
    """

    members: tuple[tuple[str, Any], ...] = _POINTERS


class Row(types.Type):
    """An array of the workspace: floats or integers, and the offset of its first entry."""

    def __init__(self, pointer: Pointer) -> None:
        self.kind, self.dtype = pointer.kind, pointer.dtype
        self.members = ("pointer", pointer), ("start", types.int64)
        super().__init__(name=f"Row({pointer.name})")


FLOAT_ROW, INTEGER_ROW = Row(FLOATS), Row(INTEGERS)


class Part(View):
    """The numbers of an owner that exists once. ``names`` are those of all scalars of the workspace."""

    def __init__(self, name: str, owner: type[Owner], names: tuple[str, ...]) -> None:
        self.fields, self.names = declarations(owner), names
        super().__init__(name=f"Part({', '.join((name, *names[N_SCALARS:]))})")

    def type_of(self, name: str) -> Any:
        """Type of a scalar or an array."""
        declared = self.fields.get(name)
        if declared is None:
            return None
        if declared.size is None:
            return type_of_number(declared.kind)
        return FLOAT_ROW if declared.is_float else INTEGER_ROW

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Load a scalar, or the offset of an array."""
        declared, pointers = self.fields[name], _members(context, builder, self, value)
        if declared.size is None:
            return load(builder, declared.kind, self._place(builder, pointers, declared), declared.key)
        row = _members(context, builder, self.type_of(name))
        row.pointer = pointers.floats if declared.is_float else pointers.integers
        row.start = load_offset(builder, pointers, declared.key, self.names)
        return row._getvalue()

    def store(self, context: Any, builder: Any, value: Any, name: str, number: Any) -> None:
        """Store a scalar."""
        declared, pointers = self.fields[name], _members(context, builder, self, value)
        store(builder, declared.kind, self._place(builder, pointers, declared), number, declared.key)

    def _place(self, builder: Any, pointers: Any, declared: Declaration) -> Any:
        """Pointer to a scalar."""
        place = moved(builder, int, pointers.scalars, WORD(self.names.index(declared.key)))
        return builder.bitcast(place, stored_type(declared.kind).as_pointer())


def load_offset(builder: Any, pointers: Any, key: str, names: tuple[str, ...] = _NAMES) -> Any:
    """Load an integer among the scalars: an offset or a count."""
    return load(builder, int, moved(builder, int, pointers.scalars, WORD(names.index(key))), key)


class Record(View):
    """A record, or a block among the floats, with its fields by name."""

    members = (*_POINTERS, ("index", types.int64))

    def __init__(self, name: str, fields: Fields) -> None:
        self.fields = fields
        super().__init__(name=f"Record({name})")

    def type_of(self, name: str) -> Any:
        """Type of a field."""
        field = self.fields.get(name)
        if field is None:
            return None
        if field.is_vector:
            return types.UniTuple(types.float64, field.numbers)
        return type_of_number(field.kind) if field.numbers == 1 else pointer_to(field.kind)

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Load a number or a tuple, or find the pointer to several numbers."""
        field, place = self.fields[name], self.place(context, builder, value, name)
        if field.is_vector:
            numbers = [load(builder, float, one) for one in _each(builder, field, place)]
            return context.make_tuple(builder, self.type_of(name), numbers)
        return place if field.numbers > 1 else load(builder, field.kind, place)

    def store(self, context: Any, builder: Any, value: Any, name: str, number: Any) -> None:
        """Store a number or a tuple."""
        field, place = self.fields[name], self.place(context, builder, value, name)
        if field.is_vector:
            numbers = private.cgutils.unpack_tuple(builder, number)
            for one, part in zip(_each(builder, field, place), numbers, strict=True):
                store(builder, float, one, part)
        else:
            store(builder, field.kind, place, number)

    def place(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Pointer to the first number of a field."""
        field, members = self.fields[name], _members(context, builder, self, value)
        offset = builder.mul(members.index, WORD(field.stride)) if field.array else members.index
        for key in (field.array, field.behind):
            if key:
                offset = builder.add(load_offset(builder, members, key), offset)
        start = members.floats if field.kind is float else members.integers
        return moved(builder, field.kind, start, builder.add(offset, WORD(field.first)))


def _each(builder: Any, field: Field, place: Any) -> list[Any]:
    """Pointers to all numbers of a field, from that to the first."""
    return [moved(builder, field.kind, place, WORD(i)) for i in range(field.numbers)]


class Sequence(types.IterableType):
    """All records of a kind. ``count`` is the key of the scalar that is their present number."""

    members = _POINTERS

    def __init__(self, record: Record, count: str) -> None:
        self.dtype, self.count = record, count
        super().__init__(name=f"Sequence({record.name})")

    @property
    def iterator_type(self) -> Any:
        """Type of the iterator of a loop over the records."""
        return Iterator(self)


class Iterator(types.SimpleIteratorType):
    """The position of a loop over all records of a kind."""

    def __init__(self, sequence: Sequence) -> None:
        self.sequence = sequence
        self.members = ("sequence", sequence), ("next", types.EphemeralPointer(types.int64)), ("end", types.int64)
        super().__init__(f"Iterator({sequence.name})", sequence.dtype)


types_of = {owner.__name__: Record(owner.__name__, fields_of(owner)) for owner in RECORDS.values()}
"""The numba types of records by the names of their owners, and of blocks by their kinds."""
types_of |= {kind: Record(kind, fields) for kind, fields in PACKED.items()}
_SEQUENCES = {name: Sequence(types_of[owner.__name__], owner.length) for name, owner in RECORDS.items()}


class Workspace(View):
    """The numbers of one trajectory, by owner. ``own`` are parts that an engine adds."""

    def __init__(self, own: Mapping[str, type[Owner]]) -> None:
        names = record_with(own.values()).names or ()
        self.parts = {name: Part(name, owner, names) for name, owner in {**PARTS, **own}.items()}
        super().__init__(name=f"Workspace({', '.join(names[N_SCALARS:])})")

    def can_convert_to(self, context: Any, other: Any) -> Any:
        """Let kernels of all engines take the workspace of an engine with parts of its own."""
        return private.Conversion.safe if other is WORKSPACE else None

    def type_of(self, name: str) -> Any:
        """Type of an owner."""
        return _SEQUENCES.get(name) or self.parts.get(name)

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """The same pointers, for each owner."""
        return value


WORKSPACE = Workspace({})
"""The workspace of an engine without parts of its own."""


@private.lower_cast(Workspace, Workspace)
def _as_other(context: Any, builder: Any, given: Workspace, other: Workspace, value: Any) -> Any:
    return value


class _Model(models.StructModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, list(kind.members))


for _kind in (Workspace, Part, Row, Record, Sequence, Iterator):
    register_model(_kind)(_Model)
for _kind, _name in ((Workspace, "floats"), (Workspace, "integers"), (Row, "start"), (Record, "index")):
    make_attribute_wrapper(_kind, _name, _name)


def _members(context: Any, builder: Any, kind: Any, value: Any = None) -> Any:
    """The members of a value by name, or of one to be filled in."""
    return private.cgutils.create_struct_proxy(kind)(context, builder, value=value)


@private.infer_getattr
class _Attributes(private.AttributeTemplate):
    key = View

    def generic_resolve(self, view: Any, name: str) -> Any:
        return view.type_of(name)


@private.lower_getattr_generic(View)
def _get_attribute(context: Any, builder: Any, view: Any, value: Any, name: str) -> Any:
    return view.load(context, builder, value, name)


@private.lower_setattr_generic(View)
def _set_attribute(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    signature.args[0].store(context, builder, args[0], name, args[1])


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Any:
    def typer(array: Any, index: Any) -> Any:
        is_known = isinstance(array, (Pointer, Row, Sequence)) and isinstance(index, types.Integer)
        return array.dtype(array, types.int64) if is_known else None

    return typer


@type_callable(operator.setitem)
def _type_setitem(context: Any) -> Any:
    def typer(array: Any, index: Any, value: Any) -> Any:
        is_known = isinstance(array, (Pointer, Row)) and isinstance(index, types.Integer)
        return types.void(array, types.int64, array.dtype) if is_known else None

    return typer


def _entry(context: Any, builder: Any, array: Any, value: Any, index: Any) -> Any:
    """Pointer to an entry of an array."""
    if isinstance(array, Row):
        # the offset is added to the index, not to the pointer, so that the optimiser sees one address
        row = _members(context, builder, array, value)
        value, index = row.pointer, builder.add(row.start, index)
    return moved(builder, array.kind, value, index)


@lower_builtin(operator.getitem, Pointer, types.Integer)
@lower_builtin(operator.getitem, Row, types.Integer)
def _get_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    array = signature.args[0]
    return load(builder, array.kind, _entry(context, builder, array, *args))


@lower_builtin(operator.setitem, Pointer, types.Integer, types.Any)
@lower_builtin(operator.setitem, Row, types.Integer, types.Any)
def _set_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    array = signature.args[0]
    store(builder, array.kind, _entry(context, builder, array, *args[:2]), args[2])
    return context.get_dummy_value()


@lower_builtin(operator.getitem, Sequence, types.Integer)
def _get_record(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    return _record(context, builder, signature.args[0], *args)


def _record(context: Any, builder: Any, sequence: Sequence, value: Any, index: Any) -> Any:
    """The record of a number."""
    pointers, record = _members(context, builder, sequence, value), _members(context, builder, sequence.dtype)
    record.scalars, record.floats, record.integers = pointers.scalars, pointers.floats, pointers.integers
    record.index = index
    return record._getvalue()


@type_callable(len)
def _type_len(context: Any) -> Any:
    return lambda sequence: types.int64 if isinstance(sequence, Sequence) else None


@lower_builtin(len, Sequence)
def _len(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    sequence = signature.args[0]
    return load_offset(builder, _members(context, builder, sequence, args[0]), sequence.count)


@lower_builtin("getiter", Sequence)
def _iterate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Iterator over the records that exist when the loop begins."""
    iterator = _members(context, builder, signature.return_type)
    iterator.sequence = args[0]
    iterator.next = private.cgutils.alloca_once_value(builder, WORD(0))
    iterator.end = _len(context, builder, signature, args)
    return iterator._getvalue()


@lower_builtin("iternext", Iterator)
@private.iternext_impl(private.RefType.UNTRACKED)
def _next(context: Any, builder: Any, signature: Any, args: Any, found: Any) -> None:
    """Set ``found`` to the next record, or to invalid after the last."""
    (kind,) = signature.args
    iterator = _members(context, builder, kind, args[0])
    number = builder.load(iterator.next, typ=WORD)
    is_valid = builder.icmp_signed("<", number, iterator.end)
    found.set_valid(is_valid)
    with builder.if_then(is_valid):
        found.yield_(_record(context, builder, kind.sequence, iterator.sequence, number))
        builder.store(builder.add(number, WORD(1)), iterator.next)


@intrinsic
def copy_fields(typingctx: Any, source: Any, target: Any) -> Any:
    """Copy the numbers that two records of different owners have in common."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        for name, field in source.fields.items():
            # a field that begins within the storage of another one is copied with that one
            if field.first == 0 and name in target.fields:
                places = (record.place(context, builder, args[i], name) for i, record in enumerate((source, target)))
                # as integers, since a question may be asked of an address
                kind = pointer_to(field.kind).kind
                for one, other in zip(*(_each(builder, field, place) for place in places), strict=True):
                    store(builder, kind, other, load(builder, kind, one))
        return context.get_dummy_value()

    return types.void(source, target), codegen


def _packed(kind: str) -> Any:
    """Intrinsic ``record(floats, start)``, or ``record(floats, start, index)`` for blocks that follow each other."""
    record, stride = types_of[kind], next(iter(PACKED[kind].values())).stride

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        members = _members(context, builder, record)
        members.floats, members.index = args[0], args[1]
        if stride > 0:
            members.index = builder.add(args[1], builder.mul(args[2], WORD(stride)))
        return members._getvalue()

    def single(typingctx: Any, floats: Any, start: Any) -> Any:
        return record(FLOATS, types.int64), codegen

    def one_of_many(typingctx: Any, floats: Any, start: Any, index: Any) -> Any:
        return record(FLOATS, types.int64, types.int64), codegen

    return intrinsic(one_of_many if stride > 0 else single)


records = {kind: _packed(kind) for kind in PACKED}
"""Constructors of the record of a block, by kind."""
