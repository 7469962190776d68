"""Guard: an event of the scenario's own."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

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
