"""The numbers behind blocks that plug-ins write: a plug-in that writes past its block is found by them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import UNTOUCHED
from nonsmooth.engine.memory.memory import Memory

_UNTOUCHED = int(np.float64(UNTOUCHED).view(np.int64))


@final
@dataclass(frozen=True)
class BlockEnds:
    """The numbers behind blocks, which nobody may change.

    Attributes
    ----------
    places : array
        Where they stand in the heap of floats.
    content : bytes
        What stands there.
    """

    places: NDArray[np.int64]
    content: bytes

    @classmethod
    def of(cls, memory: Memory) -> BlockEnds:
        """Find them in a memory on which nothing was called yet."""
        _, arrays, _, blocks = (np.flatnonzero(part == _UNTOUCHED) for part in memory.kept)
        places = np.concatenate([arrays, memory.blocks + blocks])
        return cls(places, np.full(len(places), UNTOUCHED).tobytes())

    def hold(self, memory: Memory) -> bool:
        """True if all of them are as they were."""
        return memory.floats[self.places].tobytes() == self.content
