"""Guard: an event of the scenario's own."""

from __future__ import annotations

import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Component


class Guard(Component, ABC):
    """A condition on time and state whose end is located, recorded and, if wanted, the end of the run.

    The contract:

    1. ``value`` is a plain function ``value(t, q, u, ...)`` of time [s] and of all coordinates and velocities of
       the system, in the order of its bodies; its further arguments are parameters of the guard.
    2. The event is where the value falls from positive to zero.  Where it starts at zero, it must rise first.
    """

    @property
    @abstractmethod
    def value(self) -> Callable[..., float]:
        """The function of point 1, smooth in its arguments."""

    @property
    @abstractmethod
    def ends_run(self) -> bool:
        """Whether the run ends at the first such event."""


def guard_value(guard: Guard, t: float, q: Vector, u: Vector) -> float | Exception:
    """Return the value of a guard at time t [s] and the state q, u, computed by Python, or what it raises."""
    names = tuple(inspect.signature(guard.value).parameters)[3:]
    offered = guard.parameters()
    try:
        return float(guard.value(t, q, u, *[offered[name] for name in names if name in offered]))
    except Exception as error:
        return error
