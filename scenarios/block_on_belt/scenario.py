"""A block on a moving belt, held by a spring: friction that falls with the slip speed drives a stick-slip cycle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import ConstantVelocity, PlanarBody, Plate, Point, Rest, Spring
from laws import EnergeticImpact, Stribeck, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.runs.simulate import Progress, simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

Floats = NDArray[np.float64]

_SAMPLES = 2000
_GRAVITY = 9.81
_ROOM = 10.0
"""Length of the spring over the largest way that the block can be expected to go."""


@final
@dataclass(frozen=True)
class BlockOnBelt(Scenario):
    """A block that its weight presses on a belt, and a spring to a wall; q is the elongation of the spring.

    The friction force falls with the slip speed, F = F_s / (1 + delta |v|): the coefficient is F over the weight.
    By default the block starts at rest on the belt.

    References
    ----------
    R. I. Leine, D. H. van Campen, A. de Kraker, L. van den Steen, "Stick-slip vibrations induced by alternate friction
    models", Nonlinear Dynamics 16 (1998) 41-54.
    """

    title: ClassVar[str] = "Block on a belt"
    coordinate_units: ClassVar[Mapping[str, str]] = {"elongation": "m", "elongation_rate": "m/s"}
    units: ClassVar[Mapping[str, str]] = {
        "breakaway": "m",
        "period": "s",
        "smallest_q": "m",
        "largest_q": "m",
        "friction_loss": "J",
    }

    mass: float = parameter(1.0, doc="mass m", unit="kg", above=0.0, usual=(1e-6, 1e6))
    stiffness: float = parameter(1.0, doc="stiffness k of the spring", unit="N/m", above=0.0, usual=(1e-6, 1e9))
    damping: float = parameter(0.0, doc="damping of the spring", unit="N s/m", minimum=0.0)
    static_force: float = parameter(1.0, doc="friction force F_s at breakaway", unit="N", above=0.0, usual=(1e-6, 1e6))
    decay: float = parameter(3.0, doc="fall of the friction per slip speed delta", unit="s/m", minimum=0.0)
    belt_speed: float = parameter(0.2, doc="speed of the belt", unit="m/s", above=0.0, usual=(1e-6, 1e2))
    elongation: float = parameter(0.0, doc="elongation q of the spring at the start", unit="m")
    velocity: float | None = parameter(None, doc="velocity at the start, by default that of the belt", unit="m/s")
    t_end: float = parameter(40.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e4))

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters, the velocity at the start as taken."""
        values = {name: getattr(self, name) for name in rules(type(self))}
        return values | {"velocity": self.start_velocity}

    @property
    def start_velocity(self) -> float:
        """Velocity at the start [m/s]."""
        return self.belt_speed if self.velocity is None else self.velocity

    @property
    def sample_interval(self) -> float:
        """A two-thousandth of the run [s]."""
        return self.t_end / _SAMPLES

    @property
    def reach(self) -> float:
        """The elongation at breakaway, how far the speeds carry the block, and the start, added [m]."""
        swing = (self.belt_speed + abs(self.start_velocity)) * math.sqrt(self.mass / self.stiffness)
        return self.static_force / self.stiffness + swing + abs(self.elongation)

    def build(self) -> System:
        """Return wall, belt and block, which touches the belt at its mass centre: no force has an arm to tilt it."""
        reach, half = self.reach, math.sqrt(0.5)
        length = _ROOM * reach
        wall = Plate(Rest(position=(-length, 0.0, 0.0), orientation=(half, 0.0, half, 0.0)))
        belt = Plate(ConstantVelocity((self.belt_speed, 0.0, 0.0)))
        block = PlanarBody(self.mass, self.mass * reach**2 / 12.0, (Point(),))
        system = System([wall, belt, block], gravity=_GRAVITY)
        friction = Stribeck(self.static_force / (self.mass * _GRAVITY), self.decay)
        system.contact(belt, block, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.0))
        system.load(Spring(self.stiffness, length, self.damping), wall, block)
        system.place(block, position=(self.elongation, 0.0), velocity=(self.start_velocity, 0.0))
        return system

    def breakaways(self, solution: Solution) -> Floats:
        """Return the times at which slip starts [s]."""
        events = solution.events
        times: Floats = events.time[events.cause == Cause.STICK_TO_SLIP]
        return times

    def catches(self, solution: Solution) -> Floats:
        """Return the times at which the belt catches the block [s]."""
        events = solution.events
        times: Floats = events.time[events.cause == Cause.SLIP_TO_STICK]
        return times

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the elongation [m] and its rate [m/s] over the samples."""
        return {"elongation": solution.q[:, 0], "elongation_rate": solution.u[:, 0]}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: elongation [m] and velocity [m/s] at the end."""
        return {"q": [float(solution.q_end[0])], "u": [float(solution.u_end[0])]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return where slip starts, the last period and its share of stick (None before two cycles), the extremes."""
        events, starts = solution.events, self.breakaways(solution)
        caught = self.catches(solution)
        last = caught[caught < starts[-1]][-1:] if len(starts) >= 2 else caught[:0]
        period = float(starts[-1] - starts[-2]) if len(starts) >= 2 else None
        stick = float((starts[-1] - last[0]) / period) if period and len(last) else None
        return {
            "breakaway": events.q[events.cause == Cause.STICK_TO_SLIP, 0].tolist(),
            "period": period,
            "stick_share": stick,
            "smallest_q": float(solution.q[:, 0].min()),
            "largest_q": float(solution.q[:, 0].max()),
            "friction_loss": solution.energy.friction_loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return when slip starts first, for a block that starts with the belt, and where it starts each time."""
        source = "Leine et al. (1998): it sticks until the spring and damper pull with F_s"
        place = (self.static_force - self.damping * self.belt_speed) / self.stiffness
        events = solution.events
        places, found = events.q[events.cause == Cause.STICK_TO_SLIP, 0], []
        for name, value in (("first", places[:1]), ("last", places[-1:])):
            at = float(value[0]) if len(value) else None
            found.append(
                Criterion.near(f"elongation at the {name} breakaway [m]", at, place, 1e-6 * self.reach, source)
            )
        way = place - self.elongation
        if self.start_velocity == self.belt_speed and way > 0.0:
            times = self.breakaways(solution)
            first = float(times[0]) if len(times) else None
            time = way / self.belt_speed
            found.append(Criterion.near("time of the first breakaway [s]", first, time, 1e-6 * time, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return phase portrait and elongation over time."""
        from scenarios.block_on_belt.figures import portrait

        words = f"δ = {self.decay:g} s/m, belt {self.belt_speed:g} m/s"
        share = self.summarise(solution)["stick_share"]
        said = "The block slides on" if share is None else f"Of each period the block sticks {100.0 * share:.0f} %"
        return {"portrait": portrait({"run": (self, solution)}, f"{said} ({words})")}

    @classmethod
    def gallery(cls, progress: Progress | None) -> Mapping[str, Any]:
        """Return the limit cycle from two starts."""
        from scenarios.block_on_belt.figures import portrait

        runs = {}
        starts = {
            "starts at rest on the belt, q = 0": cls(),
            "starts near the balance of spring and friction": cls(elongation=0.65, velocity=0.0),
        }
        for name, scenario in starts.items():
            interval = scenario.sample_interval
            run = simulate(scenario.build(), scenario.t_end, sample_interval=interval, progress=progress)
            runs[name] = scenario, run
        return {"limit_cycle": portrait(runs, "Stick with the belt, slip back: both starts end in one limit cycle")}
