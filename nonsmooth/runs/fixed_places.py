"""FixedPlaces: where numbers of a model are in its memory, as far as the state of a run needs them.

No run changes these, so all runs of a model share them, and a checkpoint can be read without its memory.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.model.checkpoint import Booleans, Integers


class FixedPlaces(NamedTuple):
    """Places in the memory of a model.

    Attributes
    ----------
    tails : array
        Place of the tail of each body's output among the blocks: q', force, inverse mass and energies.
    features : array
        Place of the features of each declared contact among the floats, or 0.
    changing : tuple of array
        Which numbers a run may change (:attr:`nonsmooth.engine.memory.memory.Memory.changing`).
    """

    tails: Integers
    features: Integers
    changing: tuple[Booleans, ...]

    @classmethod
    def of(cls, memory: Memory, n_bodies: int) -> FixedPlaces:
        """The places in a memory."""
        tails, features = memory[owners.Body.tail][:n_bodies], memory.declared(owners.Contact.features)
        return cls(tails - memory.blocks, features.copy(), memory.changing)
