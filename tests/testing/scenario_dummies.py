"""Scenarios with one fault each: a ball on a plate."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter
from nonsmooth.testing import check_scenario
from tests.testing.body_dummies import FAULTS
from tests.testing.body_dummies import Ball as Faulty

_count = itertools.count()
_PLATE = Plate()


@dataclass(frozen=True)
class Bounce(Scenario):
    """A ball that bounces, with a fault of the name given."""

    title: ClassVar[str] = "A ball that bounces"
    coordinate_units: ClassVar[Mapping[str, str]] = {"height": "m"}

    fault: str = parameter("", doc="what is wrong", unit="")
    height: float = parameter(0.02, doc="where it starts", unit="m", above=0.01, maximum=1.0)

    @property
    def t_end(self) -> float:
        return -1.0 if self.fault == "times" else 0.2

    @property
    def sample_interval(self) -> float:
        return 0.01

    def build(self) -> ns.System:
        if self.fault == "runs":
            raise ZeroDivisionError("no system")
        # a force without a potential does work that no account knows
        ball = Faulty(FAULTS["free flight"]) if self.fault == "energy" else Ball(0.01)
        system = ns.System([_PLATE if self.fault == "builds twice" else Plate(), ball])
        system.contact(*system.bodies, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
        q, u = ball.state()
        q[2], u[0] = self.height + (0.5 if self.fault == "energy" else 0.0), 1.0
        if self.fault == "repeatable":
            u[1] = 1e-9 * next(_count)
        system.set_start(ball, q, u)
        return system

    def resolved(self) -> Mapping[str, Any]:
        return {"fault": self.fault, "height": 2.0 * self.height if self.fault == "resolved" else self.height}

    def coordinates(self, solution: ns.Solution) -> Mapping[str, Any]:
        heights = solution.q[:, 2]
        if self.fault == "results can be saved":
            return {"height": np.array([object()] * len(heights))}
        return {"height": heights[1:] if self.fault == "coordinates" else heights}

    def final(self, solution: ns.Solution) -> Mapping[str, list[float]]:
        if self.fault == "final state":
            return {"q": solution.q_end.tolist()}
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: ns.Solution) -> Mapping[str, Any]:
        if self.fault == "summary":
            return {"calls": next(_count)}
        if self.fault == "only reads":
            solution.q[:] += 1.0
        return {"impacts": solution.counters.impacts, "highest": math.inf}

    def acceptance(self, solution: ns.Solution) -> tuple[Criterion, ...]:
        first = solution.events.time[solution.events.cause == Cause.IMPACT][:1]
        time = float(first[0]) if len(first) and self.fault != "no number" else None
        fall = math.sqrt(2.0 * (self.height - 0.01) / 9.81) + (0.01 if self.fault == "missed" else 0.0)
        return (Criterion.near("time of the first impact [s]", time, fall, 1e-9, "free fall"),)

    def figures(self, solution: ns.Solution) -> Mapping[str, Any]:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(4.0, 3.0))
        if self.fault != "figures":
            figure.add_subplot().plot(solution.t, solution.q[:, 2])
        return {"height": figure}


@dataclass(frozen=True)
class Unjudged(Bounce):
    """One without a criterion."""

    def acceptance(self, solution: ns.Solution) -> tuple[Criterion, ...]:
        return ()


_NAMES = (
    "times",
    "resolved",
    "builds twice",
    "runs",
    "energy",
    "repeatable",
    "summary",
    "coordinates",
    "final state",
    "figures",
    "results can be saved",
    "only reads",
)
DUMMIES: list[tuple[str, Scenario]] = [
    *((name, Bounce(name)) for name in _NAMES),
    ("acceptance", Unjudged()),
    ("acceptance", Bounce("missed")),
    ("acceptance", Bounce("no number")),
]


def checked(scenario: Scenario) -> Any:
    """Return the properties, looked at in a run of 0.2 s."""
    return check_scenario(scenario, t_end=0.2)
