"""Types that plug-in functions and the engine share."""

from __future__ import annotations

from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
"""An array of floats of numpy."""


class ReadFloats(Protocol):
    """A block or a tuple of floats that functions only read."""

    def __getitem__(self, index: int, /) -> float: ...


class Floats(ReadFloats, Protocol):
    """A block of floats that plug-in functions read or write by index."""

    def __setitem__(self, index: int, value: float, /) -> None: ...


class Integers(Protocol):
    """A block of integers."""

    def __getitem__(self, index: int, /) -> int: ...

    def __setitem__(self, index: int, value: int, /) -> None: ...
