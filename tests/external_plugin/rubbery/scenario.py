"""A hollow ball let go on a slope: below a critical slope it rolls, above it slides."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from bodies import Plate, Rest
from laws import EnergeticImpact, Unilateral
from nonsmooth import Solution, System, touching
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import parameter

from .body import HollowBall
from .friction import Rubber


@final
@dataclass(frozen=True)
class HollowBallOnSlope(Scenario):
    """It rolls with 3/5 g sin(slope) as long as 2/5 tan(slope) is below the coefficient at rest."""

    title: ClassVar[str] = "Hollow ball on a slope"
    samples: ClassVar[int] = 100
    coordinate_units: ClassVar[Mapping[str, str]] = {"speed": "m/s"}

    slope: float = parameter(0.3, doc="angle of the slope", unit="rad", above=0.0, maximum=1.5)
    friction: float = parameter(0.2, doc="coefficient at any speed", above=0.0, law="friction")
    t_end: float = parameter(0.5, doc="end time", unit="s", above=0.0)

    def build(self) -> System:
        """Return the slope and the ball at rest on it."""
        plate, ball = Plate(Rest(slope=self.slope)), HollowBall()
        system = System([plate, ball])
        friction = Rubber(self.friction, self.friction)
        system.contact(ball, plate, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.0))
        touching(system, ball, position=(0.0, 0.0, 1.0))
        return system

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the speed downhill [m/s]."""
        return {"speed": solution.u[:, 0] * math.cos(self.slope) - solution.u[:, 2] * math.sin(self.slope)}

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

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the speed of a ball that rolls and of one that slides."""
        balls = {f"speed_{slope:g}": cls(slope=slope) for slope in (0.4, 0.6)}
        return {name: ball.figures(run(ball))["coordinates"] for name, ball in balls.items()}
