"""A block on a moving belt, held by a spring: friction that falls with the slip speed drives a stick-slip cycle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import ConstantVelocity, PlanarBody, Plate, Point, Rest, Spring
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import EnergeticImpact, Stribeck, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_LENGTH = 10.0
"""Natural length of the spring relative to its largest possible elongation, ``BlockOnBelt.reach``.

A long spring stays nearly level when the block moves.
"""


@final
@dataclass(frozen=True)
class BlockOnBelt(Scenario):
    """A spring holds a block on a moving belt: stick and slip alternate.

    The coordinate q is the elongation of the spring.  The friction force falls with the slip speed, F = F_s / (1 +
    delta |v|): the coefficient is F over the weight. By default the block starts at rest on the belt.

    References
    ----------
    R. I. Leine, D. H. van Campen, A. de Kraker, L. van den Steen, "Stick-slip vibrations induced by alternate friction
    models", Nonlinear Dynamics 16 (1998) 41-54.
    """

    title: ClassVar[str] = "Block on a belt"
    samples: ClassVar[int] = 2000
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
        """Return all parameters; a velocity that was not given is replaced by the speed of the belt."""
        return {**super().resolved(), "velocity": self.start_velocity}

    @property
    def start_velocity(self) -> float:
        """Velocity at the start [m/s]."""
        return self.belt_speed if self.velocity is None else self.velocity

    @property
    def reach(self) -> float:
        """Upper bound of the elongation [m]: F_s / k + (belt speed + block speed) / sqrt(k / m) + start elongation."""
        swing = (self.belt_speed + abs(self.start_velocity)) * math.sqrt(self.mass / self.stiffness)
        return self.static_force / self.stiffness + swing + abs(self.elongation)

    def build(self) -> System:
        """Return wall, belt and block, which touches the belt at its mass centre: no force has an arm to tilt it."""
        reach, half = self.reach, math.sqrt(0.5)
        length = _LENGTH * reach
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
        return np.asarray(solution.events.time[solution.events.cause == Cause.STICK_TO_SLIP])

    def catches(self, solution: Solution) -> Floats:
        """Return the times at which the belt catches the block [s]."""
        return np.asarray(solution.events.time[solution.events.cause == Cause.SLIP_TO_STICK])

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the elongation [m] and its rate [m/s] over the samples."""
        return {"elongation": solution.q[:, 0], "elongation_rate": solution.u[:, 0]}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: elongation [m] and velocity [m/s] at the end."""
        return {"q": [float(solution.q_end[0])], "u": [float(solution.u_end[0])]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return numbers of the motion: elongations at which slip starts, and extremes of the elongation [m].

        Also the period [s], the part of the last cycle in stick, and the loss to friction [J].

        ``stick_share`` is the fraction of the last cycle in stick.  Both it and the period are None before the second
        cycle.
        """
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
        places, found = self.summarise(solution)["breakaway"], []
        for name, value in (("first", places[:1]), ("last", places[-1:])):
            at = value[0] if value else None
            name = f"elongation at the {name} breakaway [m]"
            found.append(Criterion.near(name, at, place, 1e-6 * self.reach, source))
        way = place - self.elongation
        if self.start_velocity == self.belt_speed and way > 0.0:
            times = self.breakaways(solution)
            first = float(times[0]) if len(times) else None
            time = way / self.belt_speed
            found.append(Criterion.near("time of the first breakaway [s]", first, time, 1e-6 * time, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return phase portrait and elongation over time."""
        sticks = self.summarise(solution)["stick_share"]
        claim = "The block slides on" if sticks is None else f"Of each period the block sticks {100.0 * sticks:.0f} %"
        title = f"{claim} (δ = {self.decay:g} s/m, belt {self.belt_speed:g} m/s)"
        return {"portrait": _portrait({"": (self, solution)}, title)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the limit cycle from two starts."""
        starts = {
            "starts at rest on the belt, q = 0": cls(),
            "starts near the balance of spring and friction": cls(elongation=0.65, velocity=0.0),
        }
        runs = {label: (block, run(block)) for label, block in starts.items()}
        return {"limit_cycle": _portrait(runs, "Stick with the belt, slip back: both starts end in one limit cycle")}


def _portrait(runs: Mapping[str, tuple[BlockOnBelt, Solution]], title: str) -> Figure:
    """Draw velocity over elongation, and elongation over time."""
    figure, (phase, time) = charts.panels(1, 2, title, (9.6, 4.4), width_ratios=(1.0, 1.3))
    block = next(iter(runs.values()))[0]
    q = "elongation of the spring q [m]"
    cycles = {label: (run.q[:, 0], run.u[:, 0]) for label, (_, run) in runs.items()}
    charts.portrait(cycles, q, "velocity of the block [m/s]", ax=phase)
    charts.histories({q: {label: (run.t, run.q[:, 0]) for label, (_, run) in runs.items()}}, axes=[time])
    phase.axhline(block.belt_speed, color="0.6", linewidth=0.8, zorder=0)
    phase.set_title("grey: speed of the belt", fontsize=9)
    time.axhline(block.static_force / block.stiffness, color="0.6", linewidth=0.8, zorder=0)
    time.set_title("grey: where static friction ends, q = F_s / k", fontsize=9)
    charts.legend(figure)
    return figure
