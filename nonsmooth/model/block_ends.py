"""BlockEnds: the marks behind blocks that plug-ins write. A changed mark shows that a plug-in wrote past its block."""

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
    """The marks behind the blocks of a memory.

    Attributes
    ----------
    places : array
        Places of the marks among the floats of the memory.
    content : bytes
        The marks.
    """

    places: NDArray[np.int64]
    content: bytes

    @classmethod
    def of(cls, memory: Memory) -> BlockEnds:
        """Find the marks in a memory on which no plug-in was called yet."""
        _, arrays, _, blocks = (np.flatnonzero(part == _UNTOUCHED) for part in memory.kept)
        places = np.concatenate([arrays, memory.blocks + blocks])
        return cls(places, np.full(len(places), UNTOUCHED).tobytes())

    def are_intact(self, memory: Memory) -> bool:
        """True if no mark has changed."""
        return memory.floats[self.places].tobytes() == self.content
