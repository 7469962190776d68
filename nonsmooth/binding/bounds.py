"""Trial of each function before the engine calls it: it must read and write inside its blocks only.

The engine hands over pointers, and machine code that accesses memory far outside of its block ends the process.  So
each function is called once, as plain Python, on blocks with bounds.  For other inputs, the marks behind the blocks
show if a function wrote past its end (:mod:`nonsmooth.model.blocks`).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from nonsmooth.binding.compile import in_python
from nonsmooth.binding.source import described, line_of
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.errors import PluginError
from nonsmooth.parameters import Value

_MOST = 5000
"""Largest number of reads and writes in a trial, which then ends without a fault. Some functions of shapes make so many
that a complete trial would take too long."""
FRAMES = (
    (0.0, 0.0, 0.0, *np.eye(3).ravel(), *(FRAME - 12) * (0.0,)),
    (0.21, -0.13, 0.37, 0.8, -0.6, 0.0, 0.48, 0.64, -0.6, 0.36, 0.48, 0.8, 0.1, -0.2, -0.3, 1.0, 2.0, 3.0, *6 * (0.0,)),
)
"""Blocks of the frames of two bodies, for trials of functions of two bodies.

The frames are apart and rotated against each other. The first frame is at rest, the second one moves.
"""
_TRIALS = 8
"""Largest number of parameter sets with which one function is tried. Further sets are not tried.

Two sets count as one if they have the same length and the same first ``_BEGINNING`` numbers.
"""
_BEGINNING = 32
_tried: defaultdict[tuple[Any, ...], set[tuple[float, ...]]] = defaultdict(set)


class _OutOfBlock(IndexError):
    """Error that ends a trial: the function has read or written outside of its block."""


class _Enough(Exception):
    """Exception that ends a trial without a fault: the trial has reached its largest number of reads and writes."""


class _Bounded:
    """Replacement for a pointer to floats, which checks that each read and write is within the block of the pointer."""

    def __init__(self, values: Sequence[float], left: list[int], first: int = 0) -> None:
        self._values, self._left, self._first = values, left, first

    def _place(self, i: int) -> int:
        self._left[0] -= 1
        if self._left[0] < 0:
            raise _Enough
        if not 0 <= self._first + i < len(self._values):
            raise _OutOfBlock(f"number {self._first + i} of a block of {len(self._values)}")
        return self._first + i

    def __getitem__(self, i: int | slice) -> float | _Bounded:
        return self.moved(i.start) if isinstance(i, slice) else self._values[self._place(i)]

    def __setitem__(self, i: int, value: float) -> None:
        self._values[self._place(i)] = float(value)  # type: ignore[index]

    def moved(self, offset: int) -> _Bounded:
        """Pointer to the float ``offset`` floats further on; it has the bounds of the same block."""
        return _Bounded(self._values, self._left, self._first + offset)


def try_out(
    function: Callable[..., Any],
    form: str,
    values: Mapping[str, Value],
    heap: Sequence[float],
    size: int,
    owner: str,
    given: Sequence[float | Sequence[float]] = FRAMES,
) -> None:
    """Try a function in plain Python, to find reads and writes outside of its blocks.

    The function is called with blocks that check each index. The trial is left out if the function was tried with
    equal parameters before, or with the largest number of parameter sets.

    Parameters
    ----------
    function, form, values, owner
        As for :func:`nonsmooth.binding.compile.bind`.
    heap : sequence of float
        Block of the function's parameters, from :func:`nonsmooth.binding.compile.bind`.
    size : int
        Number of floats that the function may write.
    given : sequence
        Arguments before the parameters: numbers, and blocks to read.

    Raises
    ------
    PluginError
        If the function reads or writes outside of its blocks. Other errors are ignored here; the engine finds them.
    """
    tried, parameters = _tried[function, form, size], (len(heap), *heap[:_BEGINNING])
    if parameters in tried or len(tried) == _TRIALS:
        return
    left = [_MOST]
    arguments = [
        _Bounded(one, left) if isinstance(one, Sequence) else one for one in (*given, tuple(heap), size * [0.0])
    ]
    try:
        with np.errstate(all="ignore"):
            in_python(function, form, values, _Bounded.moved)(*arguments)
    except _OutOfBlock as error:
        raise PluginError(
            f"{owner}: {described(function)}, reaches for {error}{line_of(function, error)}: compiled, that would be "
            "anybody's memory."
        ) from error
    except Exception:
        pass
    tried.add(parameters)
