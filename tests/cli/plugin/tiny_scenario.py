"""A plug-in as a user would write it: a ball on a vibrating plate, and some mistakes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np

from nonsmooth import Solution, System
from nonsmooth.bodies import Ball, Harmonic, Plate
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, FrictionLaw, RigidNormalLaw, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter

NUMBER = 1.0


@dataclass(frozen=True)
class Tiny(Scenario):
    """A ball on a vibrating plate."""

    title: ClassVar[str] = "A ball on a vibrating plate"
    samples: ClassVar[int] = 100
    coordinate_units: ClassVar[Mapping[str, str]] = {"height": "m"}

    t_end: float = parameter(0.1, doc="end time", unit="s", above=0.0)
    radius: float = parameter(5e-3, doc="radius of the ball", unit="m", above=0.0, usual=(1e-4, 1.0), assumed=True)
    mode: str = parameter(
        "bounce",
        doc="what to do",
        unit="",
        choices=("bounce", "nan law", "bad figure", "bad summary", "missed", "none"),
    )

    def build(self) -> System:
        """Drop the ball from a radius above the plate."""
        print("a plug-in that prints")
        ball = Ball(radius=self.radius)
        plate = Plate(motion=Harmonic(amplitude=3e-4, frequency=25.0))
        system = System([plate, ball])
        system.place(ball, position=(0.0, 0.0, 2.0 * self.radius))
        friction: FrictionLaw = NotANumber() if self.mode == "nan law" else Coulomb(0.2)
        system.contact(ball, plate, normal=Unilateral(), friction=friction, impact=EnergeticImpact(restitution=0.9))
        return system

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the height [m]."""
        return {"height": solution.q[:, 2]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return something of every type."""
        if self.mode == "bad summary":
            raise ZeroDivisionError("a summary that fails")
        return {
            "attractor": "bounce",
            "period": math.nan,
            "drift_velocity": np.array([1.0, -np.inf]),
            "count": np.int64(len(solution.events)),
            "flag": np.bool_(True),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return how well the first impact is hit."""
        if self.mode == "none":
            return ()
        times = solution.events.time[solution.events.cause == Cause.IMPACT][:1]
        t = float(times[0]) if len(times) else math.nan
        gap = self.radius - 0.5 * 9.81 * t * t - 3e-4 * math.sin(2.0 * math.pi * 25.0 * t)
        wanted = 1e-3 if self.mode == "missed" else 0.0
        return (
            Criterion.near("gap at the first impact [m]", gap, wanted, 1e-9, "free fall on a sine"),
            Criterion("impacts", float(solution.counters.impacts), 1.0, math.inf, "it falls on the plate"),
        )

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the height over time."""
        from matplotlib.figure import Figure

        if self.mode == "bad figure":
            raise ZeroDivisionError("a figure that fails")
        figure = Figure(figsize=(4.0, 3.0))
        figure.add_subplot().plot(solution.t, solution.q[:, 2])
        return {"height": figure}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the heights of two runs."""
        scenarios = {f"height_{t_end:g}": cls(t_end=t_end) for t_end in (0.05, 0.1)}
        return {name: tiny.figures(run(tiny))["height"] for name, tiny in scenarios.items()}


@final
@dataclass(frozen=True)
class Demanding(Tiny):
    """The same without a default."""

    t_end: float = parameter(doc="end time", unit="s", above=0.0)


def _nan(speed: float) -> float:
    return math.nan


@final
@dataclass(frozen=True)
class NotANumber(FrictionLaw):
    """A law that returns no number."""

    @property
    def coefficient(self) -> Callable[..., float]:
        """No number."""
        return _nan

    def is_fulfilled(
        self, slip: tuple[float, float], normal_force: float, tangential_force: tuple[float, float], tolerance: float
    ) -> bool:
        """Never."""
        return False


@dataclass(frozen=True)
class Abstract(RigidNormalLaw):
    """A law without a certificate."""


@final
class Bare(RigidNormalLaw):
    """A law that is no dataclass."""

    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        """Accept everything."""
        return True
