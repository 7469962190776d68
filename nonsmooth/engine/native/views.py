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

from nonsmooth.engine.memory.declare import Declaration, Singleton, declarations
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
    arguments : tuple
        Arguments of its class.
    """

    members: tuple[tuple[str, Any], ...] = _POINTERS
    arguments: tuple[Any, ...]

    def __reduce__(self) -> tuple[type[View], tuple[Any, ...]]:
        """Pickle its class and arguments. Files of machine code name types, and would hold all declarations else."""
        return type(self), self.arguments


class RowType(types.Type):
    """An array of the workspace: floats or integers, and the offset of its first entry."""

    def __init__(self, pointer: Pointer) -> None:
        """Set the types of the entries, in Python and in numba, and the values that the array consists of."""
        self.kind, self.dtype = pointer.kind, pointer.dtype
        self.members = ("pointer", pointer), ("start", types.int64)
        super().__init__(name=f"Row({pointer.name})")


FLOAT_ROW, INTEGER_ROW = RowType(FLOATS), RowType(INTEGERS)


class PartType(View):
    """The numbers of an owner that exists once, in the workspace of an engine that adds the owners ``own``."""

    def __init__(self, name: str, owner: type[Singleton], own: tuple[type[Singleton], ...]) -> None:
        """Take the declarations of the owner. Numba compares types by their names.

        So the name of the type has those of the scalars that an engine adds, which come after ``N_SCALARS`` others.
        """
        self.arguments = name, owner, own
        self.fields, self.names = declarations(owner), record_with(own).names or ()
        super().__init__(name=f"Singleton({', '.join((name, *self.names[N_SCALARS:]))})")

    def type_of(self, name: str) -> Any:
        """Numba type of a scalar or an array by its name; None if there is none, which is an error where it is used."""
        declared = self.fields.get(name)
        if declared is None:
            return None
        if declared.size is None:
            return type_of_number(declared.kind)
        return FLOAT_ROW if declared.is_float else INTEGER_ROW

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Write the machine code that reads a scalar or an array (a `RowType`) by its name from the owner's numbers.

        ``value`` holds the pointers to scalars, floats and integers.
        """
        declared, pointers = self.fields[name], _members(context, builder, self, value)
        if declared.size is None:
            return load(builder, declared.kind, self._place(builder, pointers, declared), declared.key)
        # an array is its pointer and the offset of its first entry, which is a scalar under its name
        row = _members(context, builder, self.type_of(name))
        row.pointer = pointers.floats if declared.is_float else pointers.integers
        row.start = load_offset(builder, pointers, declared.key, self.names)
        return row._getvalue()

    def store(self, context: Any, builder: Any, value: Any, name: str, number: Any) -> None:
        """Write the machine code that stores ``number`` in a scalar of the owner."""
        declared, pointers = self.fields[name], _members(context, builder, self, value)
        store(builder, declared.kind, self._place(builder, pointers, declared), number, declared.key)

    def _place(self, builder: Any, pointers: Any, declared: Declaration) -> Any:
        """Pointer to a scalar, whose position among all follows from its key."""
        # scalars are integers and floats of the same size: the pointer gets the type of this one
        place = moved(builder, int, pointers.scalars, WORD(self.names.index(declared.key)))
        return builder.bitcast(place, stored_type(declared.kind).as_pointer())


def load_offset(builder: Any, pointers: Any, key: str, names: tuple[str, ...] = _NAMES) -> Any:
    """Write the code that loads an integer among the scalars by its key: the offset of an array, or a count."""
    return load(builder, int, moved(builder, int, pointers.scalars, WORD(names.index(key))), key)


class RecordType(View):
    """A record, or a block among the floats, with its fields by name."""

    members = (*_POINTERS, ("index", types.int64))

    def __init__(self, name: str) -> None:
        """Take the fields, which have the place of each number. Numba compares types by their names."""
        self.arguments, self.fields = (name,), _FIELDS[name]
        super().__init__(name=f"Record({name})")

    def type_of(self, name: str) -> Any:
        """Numba type of a field by its name: a number, a tuple, or a pointer to several; None if there is none."""
        field = self.fields.get(name)
        if field is None:
            return None
        if field.is_vector:
            return types.UniTuple(types.float64, field.numbers)
        return type_of_number(field.kind) if field.numbers == 1 else pointer_to(field.kind)

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Write the code that reads a field: its number, a tuple, or the pointer to several numbers."""
        field, place = self.fields[name], self.place(context, builder, value, name)
        if field.is_vector:
            numbers = [load(builder, float, one) for one in _each(builder, field, place)]
            return context.make_tuple(builder, self.type_of(name), numbers)
        return place if field.numbers > 1 else load(builder, field.kind, place)

    def store(self, context: Any, builder: Any, value: Any, name: str, number: Any) -> None:
        """Write the code that stores a number, or a tuple number by number, in a field."""
        field, place = self.fields[name], self.place(context, builder, value, name)
        if field.is_vector:
            numbers = private.cgutils.unpack_tuple(builder, number)
            for one, part in zip(_each(builder, field, place), numbers, strict=True):
                store(builder, float, one, part)
        else:
            store(builder, field.kind, place, number)

    def place(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """Pointer to the first number of a field.

        Its offset is the sum of those of the array, of the first record in it, of this record and of the field.
        """
        field, members = self.fields[name], _members(context, builder, self, value)
        # a field names the scalars that hold the first two offsets. An empty name: there is no such offset to add.
        # ``index`` is the number of a record in an array, or the offset of a block, which has no array
        offset = builder.mul(members.index, WORD(field.stride)) if field.array else members.index
        for key in (field.array, field.behind):
            if key:
                offset = builder.add(load_offset(builder, members, key), offset)
        start = members.floats if field.kind is float else members.integers
        return moved(builder, field.kind, start, builder.add(offset, WORD(field.first)))


def _each(builder: Any, field: Field, place: Any) -> list[Any]:
    """Pointers to all numbers of a field, which follow each other, from the pointer ``place`` to the first."""
    return [moved(builder, field.kind, place, WORD(i)) for i in range(field.numbers)]


class Sequence(types.IterableType):
    """All records of a kind. ``count`` is the key of the scalar that is their present number."""

    members = _POINTERS

    def __init__(self, record: RecordType, count: str) -> None:
        """Set the type of the records and the key of their number. Numba compares types by their names."""
        self.dtype, self.count = record, count
        super().__init__(name=f"Sequence({record.name})")

    @property
    def iterator_type(self) -> Any:
        """Type of the iterator of a loop over the records. Numba needs it if a kernel has such a loop."""
        return Iterator(self)


class Iterator(types.SimpleIteratorType):
    """The position of a loop over all records of a kind."""

    def __init__(self, sequence: Sequence) -> None:
        """Set the values of the iterator: the sequence, a pointer to the next number, and the number after the last."""
        self.sequence = sequence
        # a pointer to a local variable, since the loop changes the number and numba passes values
        self.members = ("sequence", sequence), ("next", types.EphemeralPointer(types.int64)), ("end", types.int64)
        super().__init__(f"Iterator({sequence.name})", sequence.dtype)


_FIELDS: dict[str, Fields] = {owner.__name__: fields_of(owner) for owner in RECORDS.values()} | dict(PACKED)
"""The fields of records by the names of their owners, and of blocks by their kinds."""
types_of = {name: RecordType(name) for name in _FIELDS}
"""The numba types of records and blocks by the same names."""
_SEQUENCES = {name: Sequence(types_of[owner.__name__], owner.length) for name, owner in RECORDS.items()}


class WorkspaceType(View):
    """The numbers of one trajectory, by owner. ``own`` are parts that an engine adds."""

    def __init__(self, own: Mapping[str, type[Singleton]]) -> None:
        """Make the types of all parts. Numba compares types by name: it lists the scalars that ``own`` adds."""
        self.arguments, added = (own,), tuple(own.values())
        names = record_with(added).names or ()
        self.parts = {name: PartType(name, owner, added) for name, owner in {**PARTS, **own}.items()}
        super().__init__(name=f"Workspace({', '.join(names[N_SCALARS:])})")

    def can_convert_to(self, context: Any, other: Any) -> Any:
        """Let kernels of all engines take the workspace of one with parts of its own. Numba needs this at a call."""
        # the numbers of ``own`` come last: all others have the same positions. None forbids the conversion
        return private.Conversion.safe if other is WORKSPACE else None

    def type_of(self, name: str) -> Any:
        """Numba type of an owner by its name: the records of a kind, or a part; None if there is none."""
        return _SEQUENCES.get(name) or self.parts.get(name)

    def load(self, context: Any, builder: Any, value: Any, name: str) -> Any:
        """The value of an owner: the three pointers of the workspace, whatever its name."""
        return value


WORKSPACE = WorkspaceType({})
"""The workspace of an engine without parts of its own."""


@private.lower_cast(WorkspaceType, WorkspaceType)
def _as_other(context: Any, builder: Any, given: WorkspaceType, other: WorkspaceType, value: Any) -> Any:
    """Convert a workspace to that of another engine, as `can_convert_to` allows: both are the same three pointers."""
    return value


class _Model(models.StructModel):
    """Storage of values of the types above, which numba needs of each type: a struct of their members."""

    def __init__(self, manager: Any, kind: Any) -> None:
        """Give numba the names and types of the members."""
        super().__init__(manager, kind, list(kind.members))


for _kind in (WorkspaceType, PartType, RowType, RecordType, Sequence, Iterator):
    register_model(_kind)(_Model)
for _kind, _name in ((WorkspaceType, "floats"), (WorkspaceType, "integers"), (RowType, "start"), (RecordType, "index")):
    make_attribute_wrapper(_kind, _name, _name)


def _members(context: Any, builder: Any, kind: Any, value: Any = None) -> Any:
    """Members of a value of the type ``kind``, as attributes to be read; without a value, of a new one, to be set."""
    return private.cgutils.create_struct_proxy(kind)(context, builder, value=value)


@private.infer_getattr
class _Attributes(private.AttributeTemplate):
    """Types of the attributes of all views."""

    key = View

    def generic_resolve(self, view: Any, name: str) -> Any:
        """Type of an attribute, for numba's inference of types. None if there is none."""
        return view.type_of(name)


@private.lower_getattr_generic(View)
def _get_attribute(context: Any, builder: Any, view: Any, value: Any, name: str) -> Any:
    """Write the code of reading an attribute of a view. Numba calls this for each of them that a kernel reads."""
    return view.load(context, builder, value, name)


@private.lower_setattr_generic(View)
def _set_attribute(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    """Write the code of setting an attribute: ``args`` are the view and the value, ``signature`` has their types."""
    signature.args[0].store(context, builder, args[0], name, args[1])


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Any:
    """Types of ``array[index]`` for the pointers, arrays and sequences of the workspace."""

    def typer(array: Any, index: Any) -> Any:
        """Signature for an array and an index of these types. With None, numba tries its other rules."""
        is_known = isinstance(array, (Pointer, RowType, Sequence)) and isinstance(index, types.Integer)
        return array.dtype(array, types.int64) if is_known else None

    return typer


@type_callable(operator.setitem)
def _type_setitem(context: Any) -> Any:
    """Types of ``array[index] = value`` for the pointers and arrays of the workspace. Records are not replaced."""

    def typer(array: Any, index: Any, value: Any) -> Any:
        """Signature for arguments of these types. With None, numba tries its other rules."""
        # numba converts the value to the type of the entries
        is_known = isinstance(array, (Pointer, RowType)) and isinstance(index, types.Integer)
        return types.void(array, types.int64, array.dtype) if is_known else None

    return typer


def _entry(context: Any, builder: Any, array: Any, value: Any, index: Any) -> Any:
    """Pointer to an entry of an array of the workspace. ``array`` is its type: a pointer, or a row, with an offset."""
    if isinstance(array, RowType):
        # the offset is added to the index, not to the pointer, so that the optimiser sees one address
        row = _members(context, builder, array, value)
        value, index = row.pointer, builder.add(row.start, index)
    return moved(builder, array.kind, value, index)


@lower_builtin(operator.getitem, Pointer, types.Integer)
@lower_builtin(operator.getitem, RowType, types.Integer)
def _get_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the code of ``array[index]``. Numba calls this with the types in ``signature`` and the values ``args``."""
    array = signature.args[0]
    return load(builder, array.kind, _entry(context, builder, array, *args))


@lower_builtin(operator.setitem, Pointer, types.Integer, types.Any)
@lower_builtin(operator.setitem, RowType, types.Integer, types.Any)
def _set_item(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the code of ``array[index] = value``, whose values are ``args`` and whose types are in ``signature``."""
    array = signature.args[0]
    store(builder, array.kind, _entry(context, builder, array, *args[:2]), args[2])
    # numba wants a value even from a statement
    return context.get_dummy_value()


@lower_builtin(operator.getitem, Sequence, types.Integer)
def _get_record(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the code of ``sequence[index]``: the record of this number."""
    return _record(context, builder, signature.args[0], *args)


def _record(context: Any, builder: Any, sequence: Sequence, value: Any, index: Any) -> Any:
    """Code of the record of a number in a sequence: the pointers of the workspace and the number."""
    pointers, record = _members(context, builder, sequence, value), _members(context, builder, sequence.dtype)
    record.scalars, record.floats, record.integers = pointers.scalars, pointers.floats, pointers.integers
    record.index = index
    return record._getvalue()


@type_callable(len)
def _type_len(context: Any) -> Any:
    """Type of ``len(sequence)``: an integer. With None, numba tries its other rules."""
    return lambda sequence: types.int64 if isinstance(sequence, Sequence) else None


@lower_builtin(len, Sequence)
def _len(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the code of ``len(sequence)``: the scalar that is the present number of records."""
    sequence = signature.args[0]
    return load_offset(builder, _members(context, builder, sequence, args[0]), sequence.count)


@lower_builtin("getiter", Sequence)
def _iterate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the code of ``iter(sequence)``, which begins a loop: over the records that exist when it begins."""
    iterator = _members(context, builder, signature.return_type)
    iterator.sequence = args[0]
    # a local variable, 0 at first: the number of the next record
    iterator.next = private.cgutils.alloca_once_value(builder, WORD(0))
    iterator.end = _len(context, builder, signature, args)
    return iterator._getvalue()


@lower_builtin("iternext", Iterator)
@private.iternext_impl(private.RefType.UNTRACKED)
def _next(context: Any, builder: Any, signature: Any, args: Any, found: Any) -> None:
    """Write the code of one pass of a loop: set ``found`` to the next record, or to invalid after the last.

    Numba ends the loop when ``found`` is invalid. Records are not counted by references, which `UNTRACKED` means.
    """
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
    """Copy the fields of the same name from a record to one of another owner.

    So a declared contact is copied to a slot, a record of ``ws.contacts``, when its features are near, and later back.
    An intrinsic: numba calls it with types, and gets the signature of the call and the function that writes its code.
    """

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        """Write the code: a load and a store for each number."""
        for name, field in source.fields.items():
            # a field that begins within the storage of another one is copied with that one
            if field.first == 0 and name in target.fields:
                places = (record.place(context, builder, args[i], name) for i, record in enumerate((source, target)))
                # a boolean is copied as an integer: it may be a view of an address, and means that this is not 0
                kind = pointer_to(field.kind).kind
                for one, other in zip(*(_each(builder, field, place) for place in places), strict=True):
                    store(builder, kind, other, load(builder, kind, one))
        return context.get_dummy_value()

    return types.void(source, target), codegen


def _packed(kind: str) -> Any:
    """Make the function ``record(floats, start)`` of kernels, which gives names to the numbers of a block of floats.

    For blocks that follow each other it is ``record(floats, start, index)``. It is an intrinsic: numba calls it with
    types, and gets the signature of the call and the function that writes its code.
    """
    # all fields of a kind have the same stride, the length of a block; it is 0 if there is only one
    record, stride = types_of[kind], next(iter(PACKED[kind].values())).stride

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        """Write the code of the record: the pointer to the floats, and the offset of the block as its index."""
        members = _members(context, builder, record)
        # a block has floats only: the pointers to scalars and integers are not set
        members.floats, members.index = args[0], args[1]
        if stride > 0:
            # block number args[2] of several that follow each other
            members.index = builder.add(args[1], builder.mul(args[2], WORD(stride)))
        return members._getvalue()

    def single(typingctx: Any, floats: Any, start: Any) -> Any:
        """Types of a call for the only block of its kind."""
        return record(FLOATS, types.int64), codegen

    def one_of_many(typingctx: Any, floats: Any, start: Any, index: Any) -> Any:
        """Types of a call for block ``index`` of several that follow each other."""
        return record(FLOATS, types.int64, types.int64), codegen

    return intrinsic(one_of_many if stride > 0 else single)


# in the order of PACKED
impact_state, part_end, delassus_block, joint_row, frame_at, part_at, load_wrench = map(_packed, PACKED)
