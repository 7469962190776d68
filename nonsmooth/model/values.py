"""Checks of the integers of a checkpoint from a file.

The engine uses them as places and as codes without any check, so a wrong one would read outside of an array. The field
table declares the range of each.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, declarations
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import COUNTS, OWNERS
from nonsmooth.errors import InvalidInput

_REMEDY = "It is damaged, or of another model: take the state of a run of this model."
_CHECKED = tuple(
    one
    for owner in OWNERS
    for one in declarations(owner).values()
    if one.outlives_a_step and not one.inside[0] and (one.below is not None or one.kind not in (int, float))
)
"""Numbers that outlive a step and are places, codes or booleans."""


def check_values(memory: Memory) -> None:
    """Check that each number is within its range.

    Raises
    ------
    InvalidInput
        If a number is no member of its enumeration, or exceeds the count that it refers to.
    """
    counts: Counts = {name: memory[getattr(owners.Model, name)] for name in COUNTS}
    for one in _CHECKED:
        numbers = np.atleast_1d(np.asarray(_in_use(memory, one)))
        least, end = _bounds(one, counts)
        wrong = numbers[(numbers < least) | (numbers >= end)]
        if len(wrong) > 0:
            rule = f"must be from {least} to {end - 1}"
            raise InvalidInput(f"State.continuation: {one.name}", rule, int(wrong[0]), _REMEDY)


def _in_use(memory: Memory, one: Declaration) -> object:
    """The numbers of a declaration; of contacts those of active ones."""
    found = memory[one]
    return found[: memory[owners.Island.n_contacts]] if one.owner is owners.Contact else found


def _bounds(one: Declaration, counts: Counts) -> tuple[int, int]:
    """Least value, and the first value that is too large."""
    least = min(int(one.begin), 0)
    if one.below is not None:
        return least, one.below(counts)
    return least, max(one.kind) + 1 if issubclass(one.kind, IntEnum) else 2
