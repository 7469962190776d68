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
        The array; without a name the record is a block among the floats.
    stride : int
        Numbers from that of one record to that of the next.
    first, numbers : int
        Which of them the field is.
    is_vector : bool
        True if they are a tuple.
    behind : str
        Scalar that says how far into the array the first record is.
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
    """Fields of the compiled record of an owner, by name."""
    return {
        name: Field(
            one.key, stride_of(storage_of(one)), one.inside[1], one.numbers, one.is_vector, one.behind, one.kind
        )
        for name, one in declarations(owner).items()
    }


def packed(first: int, numbers: int = 1, stride: int = 0) -> Field:
    """A field of a block among the floats; three numbers are a vector."""
    return Field("", stride, first, numbers, is_vector=numbers == 3)
