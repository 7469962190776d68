"""Fields of records: where in the workspace they stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias, final

from nonsmooth.engine.memory.declare import Declaration, Record, declarations
from nonsmooth.engine.memory.tables import storage_of, stride_of


@final
@dataclass(frozen=True)
class Field:
    """Where a field of a record stands.

    Attributes
    ----------
    array : str
        The array; without a name the record is a block among the floats.
    stride : int
        Numbers from that of one record to that of the next.
    first, numbers : int
        Which of them the field is.
    is_vector : bool
        True if they are a tuple.
    behind : str
        Scalar that says how far into the array the first record is.
    is_boolean : bool
        True if the number answers a question.
    enumeration : type or None
        IntEnum of which the number is a member.
    is_float : bool
        True if it is a float, False if an integer.
    """

    array: str
    stride: int
    first: int = 0
    numbers: int = 1
    is_vector: bool = False
    behind: str = ""
    is_boolean: bool = False
    enumeration: type[IntEnum] | None = None
    is_float: bool = True


Fields: TypeAlias = Mapping[str, Field]


def fields_of(owner: type[Record]) -> Fields:
    """Fields of the compiled record of an owner, by name."""
    return {name: _field(declared) for name, declared in declarations(owner).items()}


def _field(declared: Declaration) -> Field:
    storage = storage_of(declared)
    return Field(
        array=declared.key,
        stride=stride_of(storage),
        first=declared.inside[1],
        numbers=declared.numbers,
        is_vector=declared.is_vector,
        behind=declared.behind,
        is_boolean=declared.kind is bool,
        enumeration=declared.kind if issubclass(declared.kind, IntEnum) else None,
        is_float=storage.is_float,
    )


def packed(first: int, numbers: int = 1, stride: int = 0) -> Field:
    """A field of a block among the floats; three numbers are a vector."""
    return Field("", stride, first, numbers, is_vector=numbers == 3)
