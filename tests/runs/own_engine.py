"""An engine that no module of nonsmooth knows: the midpoint rule with a fixed step, for bodies without contacts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import DONE, PAUSED
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.parameters import parameter
from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Midpoint(Engine):
    """Two evaluations of the bodies a step, in Python."""

    step: float = parameter(1e-3, doc="step", unit="s", above=0.0)

    @property
    def layers(self) -> tuple[str, ...]:
        """None but those that every engine has."""
        return ()

    def check(self, system: System) -> None:
        """Refuse what holds or drives bodies."""
        if system.contacts or system.joints or system.loads:
            raise InvalidInput("Midpoint", "must have free bodies only", repr(system), "Take EventDriven.")

    @property
    def promised_residual(self) -> float:
        """So much, with the step as it is by default."""
        return 1e-5

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return nothing."""
        return {}

    def settings(self, time_scale: float) -> Mapping[str, float]:
        """Return the error of a step that explains what the account of energy lacks."""
        return {"rtol": 1e-5, "impact_rtol": 1e-5}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> int:
        """Step as far as the step fits, and the rest at the end."""
        s = memory.scalars[0]
        y = memory[owners.Island.y][: int(s["n_y"])]
        for _ in range(most_steps):
            if s["t"] >= s["t_end"]:
                return DONE
            if 2 * s["n_samples"] > s["sample_capacity"]:
                return PAUSED
            h = min(self.step, float(s["t_end"] - s["t"]))
            if wary and h < self.step:
                return PAUSED
            before = y.copy()
            y += 0.5 * h * _slope(call, memory)
            after = before + h * _slope(call, memory)
            while s["next_sample"] <= s["t"] + h:
                share = (s["next_sample"] - s["t"]) / h
                place = call("begin_sample")
                memory.floats[place : place + len(y)] = before + share * (after - before)
            y[:] = after
            s["t"] = s["t_end"] if h < self.step else s["t"] + h
            s["steps"] += 1
        return PAUSED


def _slope(call: Callable[..., Any], memory: Memory) -> np.ndarray:
    """Return dy/dt of free bodies, whose output blocks hold dq/dt, the force and the inverse mass."""
    call("evaluate_at")
    s = memory.scalars[0]
    slope = np.zeros(int(s["n_y"]))
    names = ("body_q", "body_u", "body_nq", "body_nu", "body_tail")
    for q, u, n_q, n_u, tail in zip(*(memory.array(name, int(s["n_bodies"])).tolist() for name in names), strict=True):
        block = memory.floats[tail:]
        force, inverse = block[n_q : n_q + n_u], block[n_q + n_u : n_q + n_u + n_u**2].reshape(n_u, n_u)
        slope[q : q + n_q] = block[:n_q]
        slope[s["n_q"] + u : s["n_q"] + u + n_u] = inverse @ force
    return slope
