"""What must hold of inner states of laws, and how they go by an integration that is not the engine's."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from nonsmooth.testing.functions import OLD, ROOM

Array = NDArray[np.float64]
_EXACT = 1e-10
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


def written(call: Callable[[Array], Any], size: int, old: float = 0.0) -> Array:
    """Return what a function writes into a block that holds ``old``, with some room behind it."""
    out = np.full(size + ROOM, OLD)
    out[:size] = old
    call(out)
    return out


def left_over(call: Callable[[Array], Any], size: int) -> str:
    """Return what is wrong where a function leaves something of the block as it was."""
    for i in np.flatnonzero(written(call, size, 0.5) != written(call, size, -0.25)):
        return f"number {i} of what it writes is left from the call before"
    return ""


def followed(
    slope: Callable[[Array], Array], start: Array, scale: Array, times: Sequence[float], stiff: bool = False
) -> Array:
    """Return y of y' = slope(y) at rising times from y(0) = start on, shape [n_times, n]."""
    found = solve_ivp(
        lambda t, y: slope(y),
        (0.0, times[-1]),
        start,
        method="LSODA" if stiff else "DOP853",
        rtol=_EXACT,
        atol=1e-2 * _EXACT * scale,
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
