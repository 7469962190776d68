"""Data of the figures: the states in the last part of a run, before and after each jump, and a text of parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.parameters import rules
from nonsmooth.solution.solution import Solution

from .coordinates import DumbbellMotion

if TYPE_CHECKING:
    from .scenario import DumbbellScenario

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_SYMBOLS: Mapping[str, tuple[str, float, str]] = {
    "radius": ("r", 1e3, "mm"),
    "rod_mass_fraction": ("rod mass share", 1.0, ""),
    "density": ("density", 1.0, "kg/m³"),
    "restitution": ("e", 1.0, ""),
    "friction": ("µ", 1.0, ""),
    "static_friction": ("µ$_s$", 1.0, ""),
    "young_modulus": ("E", 1e-9, "GPa"),
    "poisson_ratio": ("$\\nu$", 1.0, ""),
}


@dataclass(frozen=True)
class Trace:
    """The last part of a run: samples, and the states before and after every event.

    Attributes
    ----------
    motion : DumbbellMotion
        The motion at n points in time.  A sample gives one point; an event gives two points at one time, its states
        before and after.
    touching : array
        ``touching[i, ball]`` is True if the ball is on the plate between points i and i + 1; shape [n, 2].
    struck : array
        ``struck[i, ball]`` is True if points i and i + 1 are before and after an impact in which the ball takes part;
        shape [n, 2].
    """

    motion: DumbbellMotion
    touching: Flags
    struck: Flags

    @classmethod
    def of(cls, scenario: DumbbellScenario, solution: Solution, periods: float) -> Trace:
        """Return the trace of the last plate periods."""
        events = solution.events
        begin = solution.t_end - periods / scenario.frequency
        inside = np.flatnonzero(events.time >= begin)
        padded = np.concatenate([[-np.inf], events.time, [np.inf]])
        near = np.searchsorted(events.time, solution.t)
        apart = np.minimum(solution.t - padded[near], padded[near + 1] - solution.t) > 1e-12
        plain = (solution.t >= begin) & apart
        # a sample has the event -1; an event gives two points, the states before and after it
        event = np.concatenate([np.full(plain.sum(), -1), np.repeat(inside, 2)])
        before = np.concatenate([np.zeros(plain.sum(), bool), np.tile([True, False], len(inside))])
        t = np.concatenate([solution.t[plain], np.repeat(events.time[inside], 2)])
        q = np.concatenate([solution.q[plain], np.repeat(events.q[inside], 2, axis=0)])
        jumps = np.stack([events.u_before[inside], events.u_after[inside]], axis=1).reshape(-1, solution.u.shape[1])
        u = np.concatenate([solution.u[plain], jumps])
        order = np.argsort(t, kind="stable")
        t, event, before = t[order], event[order], before[order]
        last = np.where(event >= 0, event, np.searchsorted(events.time, t, side="right") - 1)
        touching = (events.after[np.maximum(last, 0)] & 1) > 0
        hit = before & (events.cause[np.maximum(event, 0)] == Cause.IMPACT)
        struck = hit[:, None] & ((events.during[np.maximum(event, 0)] & 1) > 0)
        return cls(DumbbellMotion.of(scenario, t, q[order], u[order]), touching, struck)

    @property
    def scenario(self) -> DumbbellScenario:
        """The scenario of the run."""
        return self.motion.scenario

    @property
    def clock(self) -> Floats:
        """Time since the start of the trace [ms]."""
        return np.asarray(1e3 * (self.motion.t - self.motion.t[0]))


def note(*scenarios: DumbbellScenario, impact: str = "") -> str:
    """Return a note of the runs' parameters, given and assumed ones; ``impact`` replaces the names of their laws."""
    rows = [scenario.resolved() for scenario in scenarios]

    def values(name: str, factor: float = 1.0) -> str:
        return " / ".join(dict.fromkeys(f"{row[name] * factor:.4g}" for row in rows))

    laws = impact or ", ".join(dict.fromkeys(row["impact"] for row in rows))
    given = f"Γ = {values('gamma')}, f = {values('frequency')} Hz, A$_r$ = {values('aspect_ratio')}"
    assumed = [name for name, (_, rule) in rules(type(scenarios[0])).items() if rule.assumed and name in _SYMBOLS]
    symbols = {name: _SYMBOLS[name] for name in assumed}
    words = [f"{symbol} = {values(name, factor)} {unit}".strip() for name, (symbol, factor, unit) in symbols.items()]
    return f"{given}; impact law: {laws}\nassumed (not given in the paper): {', '.join(words)}"
