"""Fields of records: where in the workspace they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias, final

from nonsmooth.engine.memory.declare import Record, declarations
from nonsmooth.engine.memory.tables import storage_of, stride_of


@final
@dataclass(frozen=True)
class Field:
    """Where a field of a record is.

    Attributes
    ----------
    array : str
        Key of the array; "" if the record is a block among the floats.
    stride : int
        Entries of the array from one record to the next.
    first, numbers : int
        Position of the first number of the field within its record, and how many there are.
    is_vector : bool
        True if they are read and written as a tuple, False if one by one.
    behind : str
        Key of the scalar that is the position of the first record in the array; "" if that is 0.
    kind : type
        float, int, bool or an IntEnum.
    """

    array: str
    stride: int
    first: int = 0
    numbers: int = 1
    is_vector: bool = False
    behind: str = ""
    kind: type = float


Fields: TypeAlias = Mapping[str, Field]


def fields_of(owner: type[Record]) -> Fields:
    """Fields of the compiled record of an owner, by name: where its numbers are in the workspace."""
    # array and stride are those of the storage: several fields may be views of one
    return {
        name: Field(
            one.key, stride_of(storage_of(one)), one.inside[1], one.numbers, one.is_vector, one.behind, one.kind
        )
        for name, one in declarations(owner).items()
    }


def packed(first: int, numbers: int = 1, stride: int = 0) -> Field:
    """A field at position ``first`` of blocks among the floats, ``stride`` floats apart, 0 if there is one block."""
    # three numbers are a vector
    return Field("", stride, first, numbers, is_vector=numbers == 3)
