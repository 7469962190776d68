"""A trial of each function before the engine calls it: whether it keeps to the numbers that it may read and write.

The engine hands over pointers, and machine code that leaves its block far behind ends the process.  So each function is
called once, as plain Python, on numbers that know their bounds.  What it does in other cases the guards behind the
blocks tell (:mod:`nonsmooth.model.blocks`).
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
"""Numbers that a trial reads and writes before it is left: long functions of the built-in shapes take no more time."""
FRAMES = (
    (0.0, 0.0, 0.0, *np.eye(3).ravel(), *(FRAME - 12) * (0.0,)),
    (0.21, -0.13, 0.37, 0.8, -0.6, 0.0, 0.48, 0.64, -0.6, 0.36, 0.48, 0.8, 0.1, -0.2, -0.3, 1.0, 2.0, 3.0, *6 * (0.0,)),
)
"""Two frames, apart and turned, one at rest, to try functions of two bodies with."""
_TRIALS = 8
"""Sets of parameters that a function is tried with, as long as they differ in their length or beginning."""
_BEGINNING = 32
_tried: defaultdict[tuple[Any, ...], set[tuple[float, ...]]] = defaultdict(set)


class _OutOfBlock(IndexError):
    """A number was read or written that is not there."""


class _Enough(Exception):
    """The trial has taken long enough."""


class _Bounded:
    """Numbers that can be read, written and moved over as those behind a pointer, but for their bounds."""

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
        """Numbers from an offset on."""
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
    """Call a function, as plain Python, on numbers that know their bounds; once for the same parameters.

    Parameters
    ----------
    function, form, values, owner
        As for :func:`nonsmooth.binding.compile.bind`.
    heap : sequence of float
        What that function gave for the parameters.
    size : int
        How many numbers it may write.
    given : sequence
        What stands before the parameters: numbers, and sequences of those to be read.

    Raises
    ------
    PluginError
        If it reads or writes beyond what it was given; whatever else it does is left for the engine to find.
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
