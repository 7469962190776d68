"""Which integers a run can leave: the field table says of what each is a number."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, declarations
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import COUNTS, OWNERS
from nonsmooth.errors import InvalidInput

_REMEDY = "It is damaged, or of another model: take one that a run left."
_CHECKED = tuple(
    one
    for owner in OWNERS
    for one in declarations(owner).values()
    if one.outlives_a_step and not one.inside[0] and (one.below is not None or one.kind not in (int, float))
)
"""Numbers by which the engine finds others, and codes."""


def check_values(memory: Memory) -> None:
    """Look whether what outlives a step is of a run.

    Raises
    ------
    InvalidInput
        If a number is no member of its enumeration, or none of what it counts.
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
    """The numbers of a declaration; of contacts those that are listed."""
    found = memory[one]
    return found[: memory[owners.Island.n_contacts]] if one.owner is owners.Contact else found


def _bounds(one: Declaration, counts: Counts) -> tuple[int, int]:
    """Least value, and the first one that is too large."""
    least = min(int(one.begin), 0)
    if one.below is not None:
        return least, one.below(counts)
    return least, max(one.kind) + 1 if issubclass(one.kind, IntEnum) else 2
