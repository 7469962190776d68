"""A hollow ball let go on a slope: below a critical slope it rolls, above it slides."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from bodies import Plate, Rest
from laws import EnergeticImpact, Unilateral
from nonsmooth import Solution, System, simulate, touching
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter, rules

from .body import HollowBall
from .friction import Rubber


@final
@dataclass(frozen=True)
class HollowBallOnSlope(Scenario):
    """It rolls with 3/5 g sin(slope) as long as 2/5 tan(slope) is below the coefficient at rest."""

    title: ClassVar[str] = "Hollow ball on a slope"
    coordinate_units: ClassVar[Mapping[str, str]] = {"speed": "m/s"}

    slope: float = parameter(0.3, doc="angle of the slope", unit="rad", above=0.0, maximum=1.5)
    friction: float = parameter(0.2, doc="coefficient at any speed", above=0.0, law="friction")
    t_end: float = parameter(0.5, doc="end time", unit="s", above=0.0)

    @property
    def sample_interval(self) -> float:
        """A hundredth of the run [s]."""
        return self.t_end / 100.0

    def build(self) -> System:
        """Return the slope and the ball at rest on it."""
        plate, ball = Plate(Rest(slope=self.slope)), HollowBall()
        system = System([plate, ball])
        friction = Rubber(self.friction, self.friction)
        system.contact(ball, plate, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.0))
        touching(system, ball, position=(0.0, 0.0, 1.0))
        return system

    def resolved(self) -> Mapping[str, Any]:
        """Return everything."""
        return {name: getattr(self, name) for name in rules(type(self))}

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the speed downhill [m/s]."""
        return {"speed": solution.u[:, 0] * math.cos(self.slope) - solution.u[:, 2] * math.sin(self.slope)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return the state at the end."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the acceleration downhill over g [1]."""
        speed = np.linalg.norm(solution.u_end[:3])
        return {"acceleration": float(speed / self.t_end / 9.81)}

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the acceleration: that of rolling up to the critical slope, that of sliding above it."""
        rolls = 0.4 * math.tan(self.slope) <= self.friction
        sliding = math.sin(self.slope) - self.friction * math.cos(self.slope)
        expected = 0.6 * math.sin(self.slope) if rolls else sliding
        found = self.summarise(solution)["acceleration"]
        return (Criterion.near("acceleration downhill over g", found, expected, 1e-6, "rigid body on a slope"),)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the speed over time."""
        from matplotlib.figure import Figure

        figure = Figure(figsize=(5.0, 3.0), layout="constrained")
        axes = figure.add_subplot(xlabel="time [s]", ylabel="speed downhill [m/s]", title=self.title)
        axes.plot(solution.t, self.coordinates(solution)["speed"])
        return {"speed": figure}

    @classmethod
    def gallery(cls, progress: Any) -> Mapping[str, Any]:
        """Return the speed of a ball that rolls and of one that slides."""
        drawn = {}
        for slope in (0.4, 0.6):
            one = cls(slope=slope)
            drawn[f"speed_{slope:g}"] = one.figures(simulate(one.build(), one.t_end, progress=progress))["speed"]
        return drawn
