"""A run with its jumps: samples and the states before and after every event, in the paper's coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.solution import Solution
from scenarios.dumbbell import coordinates
from scenarios.dumbbell.scenario import DumbbellScenario

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Trace:
    """The last part of a run.

    Attributes
    ----------
    scenario : DumbbellScenario
        What ran.
    t : array
        Times, ascending, with repetitions at events [s], shape [n].
    q, u : array
        Paper coordinates and rates, shape [n, 6].
    touching : array
        Which balls are on the plate from this point to the next, shape [n, 2].
    struck : array
        Which balls take part in the impact that leads from this point to the next, shape [n, 2]; none
        where the way to the next point is smooth.
    """

    scenario: DumbbellScenario
    t: Floats
    q: Floats
    u: Floats
    touching: NDArray[np.bool_]
    struck: NDArray[np.bool_]

    @classmethod
    def of(cls, scenario: DumbbellScenario, solution: Solution, periods: float) -> Trace:
        """Return the trace of the last so many plate periods."""
        events = solution.events
        begin = solution.t_end - periods / scenario.frequency
        inside = np.flatnonzero(events.time >= begin)
        near = np.searchsorted(events.time, solution.t)
        padded = np.concatenate([[-np.inf], events.time, [np.inf]])
        apart = np.minimum(solution.t - padded[near], padded[near + 1] - solution.t)
        plain = (solution.t >= begin) & (apart > 1e-12)
        n = int(plain.sum())
        none = np.full(n, -1)
        t = np.concatenate([solution.t[plain], np.repeat(events.time[inside], 2)])
        q = np.concatenate([solution.q[plain], np.repeat(events.q[inside], 2, axis=0)])
        jumps = np.stack([events.u_before[inside], events.u_after[inside]], axis=1).reshape(-1, solution.u.shape[1])
        number = np.concatenate([none, np.repeat(inside, 2)])
        late = np.concatenate([none, np.tile([0, 1], len(inside))])
        order = np.lexsort((late, number, t))
        t, number, late = t[order], number[order], late[order]
        places, rates = coordinates.from_state(
            t, q[order], np.concatenate([solution.u[plain], jumps])[order], scenario.centre_distance
        )
        last = np.where(number >= 0, number, np.searchsorted(events.time, t, side="right") - 1)
        touching = (events.after[np.maximum(last, 0)] & 1) > 0
        hit = (late == 0) & (events.cause[np.maximum(number, 0)] == Cause.IMPACT)
        struck = hit[:, None] & ((events.during[np.maximum(number, 0)] & 1) > 0)
        return cls(scenario, t, places, rates, touching, struck)

    @property
    def clock(self) -> Floats:
        """Time since the start of the trace [ms]."""
        clock: Floats = 1e3 * (self.t - self.t[0])
        return clock

    @property
    def heights(self) -> Floats:
        """Lowest points of the balls [m], shape [n, 2]."""
        first = self.q[:, 2] - self.scenario.radius
        return np.column_stack([first, first + self.scenario.centre_distance * np.sin(self.q[:, 4])])

    @property
    def slip(self) -> Floats:
        """Slip velocity of ball 1 at its lowest point, along x and y [m/s], shape [n, 2]; N of Eq. (12)."""
        r, c_b = self.scenario.radius, np.cos(self.q[:, 4])
        s_t, c_t = np.sin(self.q[:, 3]), np.cos(self.q[:, 3])
        x = self.u[:, 0] - r * s_t * self.u[:, 4] - r * c_b * c_t * self.u[:, 5]
        y = self.u[:, 1] + r * c_t * self.u[:, 4] - r * c_b * s_t * self.u[:, 5]
        return np.column_stack([x, y])
