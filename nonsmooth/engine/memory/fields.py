"""Fields of records: where in the memory they stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias, final

from nonsmooth.engine.memory.blocks import GEOMETRY
from nonsmooth.engine.memory.tables import COUNTS, FLOAT_ARRAYS, INTEGER_ARRAYS


@final
@dataclass(frozen=True)
class Field:
    """Where a field of a record stands.

    Attributes
    ----------
    array : str
        The array; without a name the record stands in the heap of floats, with no other between.
    stride : int
        Numbers from that of one record to that of the next.
    first, numbers : int
        Which of them the field is.
    is_vector : bool
        Whether they are a tuple.
    behind : str
        A scalar that tells how far into the array the first record is.
    is_boolean : bool
        Whether the number, 0 or 1, answers a question.
    """

    array: str
    stride: int
    first: int = 0
    numbers: int = 1
    is_vector: bool = False
    behind: str = ""
    is_boolean: bool = False

    @property
    def is_float(self) -> bool:
        """Whether it stands in the heap of floats."""
        return not self.array or self.array in FLOAT_ARRAYS


Fields: TypeAlias = Mapping[str, Field]


def stride_of(array: str) -> int:
    """Return how many numbers an array has for each record."""
    size = (FLOAT_ARRAYS | INTEGER_ARRAYS)[array]
    empty = size(dict.fromkeys(COUNTS, 0))
    return max(size({**dict.fromkeys(COUNTS, 0), name: 1}) for name in COUNTS) - empty


def row(array: str) -> Field:
    """Return the field of all numbers that an array has for a record."""
    return Field(array, stride_of(array), 0, stride_of(array))


def rows(*arrays: str) -> Fields:
    """Return such fields by the names of their arrays."""
    return {array: row(array) for array in arrays}


def vector(array: str, first: int = 0, numbers: int = 2) -> Field:
    """Return a field that is a tuple."""
    return Field(array, stride_of(array), first, numbers, is_vector=True)


def one(array: str, first: int = 0) -> Field:
    """Return a field that is one number."""
    return Field(array, stride_of(array), first)


def question(array: str, first: int = 0) -> Field:
    """Return a field that is true or false."""
    return Field(array, stride_of(array), first, is_boolean=True)


def geometry(first: int, numbers: int = 1, is_tuple: bool = True) -> Field:
    """Return a field of the geometry block of a contact."""
    return Field("geometry", GEOMETRY, first, numbers, is_tuple and numbers > 1)


def without(prefix: str, *arrays: str) -> Fields:
    """Return fields named after their arrays, but for a prefix."""
    return {array.removeprefix(prefix): row(array) for array in arrays}


def packed(first: int, numbers: int = 1, stride: int = 0) -> Field:
    """Return a field of a record in the heap of floats; three numbers are a vector."""
    return Field("", stride, first, numbers, is_vector=numbers == 3)
