"""Motions and inner states by an integration that is not the engine's, and what must hold of where states start."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from nonsmooth.interfaces import StatefulFrictionLaw, TractionLaw
from nonsmooth.testing.functions import written
from nonsmooth.testing.outcome import NotChecked

Array = NDArray[np.float64]
StatefulLaw = StatefulFrictionLaw | TractionLaw
_EXACT, _STIFFLY = 1e-10, 1e-8
"""Relative tolerances of the two methods, below the deviations that the checks allow."""
_MOST_CALLS = 50_000
_STEP = 1e-6
"""Step of the differences by which rates of change are bounded, in units of the sizes of the states."""
_SAME, _STEPS = 1e-5, 1e-7
"""Deviation of two motions that counts as none: of the change, and of the whole, by the engine's 1e-9 per step."""


def start_of(law: StatefulLaw) -> tuple[Array, Array]:
    """Return initial states and their usual sizes."""
    return np.array(law.initial_state, dtype=float), np.array(law.state_scale, dtype=float)


def start_fault(law: StatefulLaw) -> str:
    """Return the fault of initial states and scales; "" if they are in order."""
    initial, scale = law.initial_state, law.state_scale
    if len(initial) != len(scale):
        return f"there are {len(initial)} initial states and {len(scale)} scales"
    if not np.all(np.isfinite(initial)):
        return f"the initial states are {tuple(initial)}"
    if not (np.all(np.isfinite(scale)) and all(one > 0.0 for one in scale)):
        return f"the scales are {tuple(scale)}, not all positive and finite"
    return ""


def require(fault: str) -> None:
    """Raise NotChecked if there is a fault without which nothing else can be checked."""
    if fault:
        raise NotChecked(f"not checked, as {fault}")


def writing_fault(call: Callable[..., Any], given: Sequence[Array], size: int) -> str:
    """Return the fault of a function that changes the vectors given, or leaves a number of its block as it was."""
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
    """Return y of y' = slope(y) at rising times from y(0) = start, shape [n_times, n]."""
    calls, exact = itertools.count(), _STIFFLY if stiff else _EXACT

    def counted(t: float, y: Array) -> Array:
        if next(calls) > _MOST_CALLS:
            raise ArithmeticError(f"{times[-1]:g} s of motion ask for more than {_MOST_CALLS} calls of the law")
        return slope(y)

    method, atol = "LSODA" if stiff else "DOP853", 1e-2 * exact * scale
    found = solve_ivp(counted, (0.0, times[-1]), start, method=method, rtol=exact, atol=atol, t_eval=times)
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


def is_same_motion(given: Any, wanted: Any, start: Any, size: float) -> bool:
    """True if velocities by the engine are those of an independent integration, to the tolerances of both."""
    change = float(np.max(np.abs(np.asarray(wanted) - start)))
    return bool(np.max(np.abs(np.asarray(given) - wanted)) <= _SAME * change + _STEPS * size)
