"""What must hold of inner states of laws, and how they go by an integration that is not the engine's."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from nonsmooth.testing.functions import OLD, ROOM
from nonsmooth.testing.property import NotChecked

Array = NDArray[np.float64]
_EXACT, _STIFFLY = 1e-10, 1e-8
_MOST_CALLS = 50_000
_STEP = 1e-6


def check_start(initial: Sequence[float], scale: Sequence[float]) -> str:
    """Return what is wrong with the values from which states start and their usual sizes."""
    if len(initial) != len(scale):
        return f"there are {len(initial)} initial states and {len(scale)} scales"
    if not np.all(np.isfinite(initial)):
        return f"the initial states are {tuple(initial)}"
    if not (np.all(np.isfinite(scale)) and all(one > 0.0 for one in scale)):
        return f"the scales are {tuple(scale)}, not all positive and finite"
    return ""


def require_start(initial: Sequence[float], scale: Sequence[float]) -> None:
    """Raise NotChecked if something is wrong with them: nothing else can be looked at then."""
    if found := check_start(initial, scale):
        raise NotChecked(f"not checked, as {found}")


def written(call: Callable[[Array], Any], size: int, old: float = 0.0) -> Array:
    """Return what a function writes into a block that holds ``old``, with some room behind it."""
    out = np.full(size + ROOM, OLD)
    out[:size] = old
    call(out)
    return out


def misplaced(call: Callable[..., Any], given: Sequence[Array], size: int) -> str:
    """Return what is wrong where a function changes the vectors given, or leaves something of its block as it was."""
    copies = [one.copy() for one in given]
    one, other = (written(lambda out: call(*copies, out), size, old) for old in (0.5, -0.25))
    if any(not np.array_equal(a, b) for a, b in zip(given, copies, strict=True)):
        return "it changes what it is given, and may write to `out` only"
    for i in np.flatnonzero(one != other):
        return f"number {i} of what it writes is left from the call before"
    return ""


def followed(
    slope: Callable[[Array], Array], start: Array, scale: Array, times: Sequence[float], stiff: bool = False
) -> Array:
    """Return y of y' = slope(y) at rising times from y(0) = start on, shape [n_times, n]."""
    calls, exact = itertools.count(), _STIFFLY if stiff else _EXACT

    def counted(t: float, y: Array) -> Array:
        if next(calls) > _MOST_CALLS:
            raise ArithmeticError(f"{times[-1]:g} s of motion ask for more than {_MOST_CALLS} calls of the law")
        return slope(y)

    found = solve_ivp(
        counted,
        (0.0, times[-1]),
        start,
        method="LSODA" if stiff else "DOP853",
        rtol=exact,
        atol=1e-2 * exact * scale,
        t_eval=times,
    )
    if not found.success:
        raise ArithmeticError(f"the states cannot be integrated: {found.message}")
    return np.asarray(found.y.T)


def fastest(slope: Callable[[Array], Array], at: Array, scale: Array) -> float:
    """Return a bound of the rates with which y' = slope(y) changes by itself [1/s], the sizes of y being known."""
    if len(at) == 0:
        return 0.0
    base = slope(at)
    columns = [(slope(at + _STEP * scale * unit) - base) / (_STEP * scale) for unit in np.eye(len(at))]
    return float(np.max(np.sum(np.abs(columns), axis=0)))
