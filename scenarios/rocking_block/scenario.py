"""A planar block, released at rest with one corner on the ground: its first impact is a double one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import PlanarBody, Plate, Point, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from .housner import frictionless_fall

Floats = NDArray[np.float64]

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]."""


def laws_of(block: Any) -> dict[str, Any]:
    """Return normal, friction and impact law of a block's contacts, by keyword; planar and spatial blocks use it."""
    return {
        "normal": Unilateral(),
        "friction": Coulomb(block.friction) if block.friction > 0.0 else Frictionless(),
        "impact": EnergeticImpact(block.restitution, exponent=block.exponent),
    }


@final
@dataclass(frozen=True)
class RockingBlock(Scenario):
    """A tilted block falls back and rocks on its two lower corners.

    References
    ----------
    G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bull. Seismol. Soc. Am. 53
    (1963) 403-417.
    """

    title: ClassVar[str] = "Rocking block"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "z": "m", "tilt": "rad"}

    base: float = parameter(1.0, doc="length L of the side that it stands on", unit="m", above=0.0, usual=(1e-3, 1e2))
    height: float = parameter(0.5, doc="height H", unit="m", above=0.0, usual=(1e-3, 1e2))
    mass: float = parameter(1.0, doc="mass", unit="kg", above=0.0, usual=(1e-6, 1e6))
    tilt: float = parameter(
        math.pi / 3, doc="angle between base and ground at the start", unit="rad", above=0.0, maximum=math.pi / 2
    )
    restitution: float = parameter(
        0.8, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    exponent: float = parameter(
        1.0, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0, law="impact"
    )
    friction: float = parameter(0.0, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(2.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    @property
    def corners(self) -> Floats:
        """The corners in the body frame [m], left and right lower, left and right upper, shape [4, 2]."""
        x, z = 0.5 * self.base, 0.5 * self.height
        return np.array([(-x, -z), (x, -z), (-x, z), (x, z)])

    def build(self) -> System:
        """Return ground, block and the contacts of its four corners."""
        moment = self.mass * (self.base**2 + self.height**2) / 12.0
        ground = Plate(Rest())
        block = PlanarBody(self.mass, moment, tuple(Point(x, 0.0, z) for x, z in self.corners.tolist()))
        system = System([ground, block], gravity=GRAVITY)
        system.contact(ground, block, **laws_of(self))
        # the angle of a planar body is positive where its first axis points down
        lift = 0.5 * (self.base * math.sin(self.tilt) + self.height * math.cos(self.tilt))
        system.place(block, position=(0.0, lift), angle=-self.tilt)
        return system

    def corner_heights(self, solution: Solution) -> Floats:
        """Return the heights of the corners over the samples [m], shape [n_samples, 4]."""
        z, angle = solution.q[:, 1, None], solution.q[:, 2, None]
        heights: Floats = z - np.sin(angle) * self.corners[:, 0] + np.cos(angle) * self.corners[:, 1]
        return heights

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the mass centre x, z [m] and the tilt [rad] over the samples."""
        return {"x": solution.q[:, 0], "z": solution.q[:, 1], "tilt": -solution.q[:, 2]}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: x, z [m], tilt [rad] and their rates at the end."""
        signs = np.array([1.0, 1.0, -1.0])
        return {"q": (signs * solution.q_end).tolist(), "u": (signs * solution.u_end).tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return time, contacts and velocities of the first impact, and what is lost in all."""
        events = solution.events
        first = np.flatnonzero(events.cause == Cause.IMPACT)[:1]
        return {
            "first_impact": {
                "time": events.time[first].tolist(),
                "mode": [events.words("during")[i] for i in first],
                "velocity_before": events.u_before[first, 1].tolist(),
                "velocity_after": events.u_after[first, 1].tolist(),
                "tilt_rate_before": (-events.u_before[first, 2]).tolist(),
                "tilt_rate_after": (-events.u_after[first, 2]).tolist(),
            },
            **super().summarise(solution),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return when and how fast a block without friction lies flat, whose mass centre falls along a vertical."""
        if self.friction > 0.0 or self.base * math.cos(self.tilt) <= self.height * math.sin(self.tilt):
            return ()
        time, rate = frictionless_fall(self.base, self.height, self.tilt, GRAVITY)
        first = self.summarise(solution)["first_impact"]
        values = [(first[name] or [None])[0] for name in ("time", "tilt_rate_before", "velocity_before")]
        source = "energy of the fall without friction"
        found = [
            Criterion.near("time of the first impact [s]", values[0], time, 1e-7, f"quadrature of the {source}"),
            Criterion.near("tilt rate before it [rad/s]", values[1], -rate, 1e-6 * rate, source),
            Criterion.near("velocity before it [m/s]", values[2], -0.5 * self.base * rate, 1e-6 * rate, source),
        ]
        if (self.base, self.height, self.tilt) == (1.0, 0.5, math.pi / 3):
            source = "published case of a flat impact of two points"
            found.append(Criterion.near("time of the first impact [s]", values[0], 0.58747797, 1e-8, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the heights of the lower corners over time."""
        words = f"e = {self.restitution:g}, η = {self.exponent:g}, μ = {self.friction:g}"
        title = f"Its corners strike {solution.counters.impacts} times ({words})"
        return {"corners": draw.corners(self, solution, title)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the double impact, the velocity ratio over the slenderness, and the decay of a rocking motion."""
        double = cls(t_end=1.4)
        slender = cls(base=0.25, height=1.0, tilt=0.15, restitution=0.0, friction=0.5, t_end=4.0)
        claim = "The first impact of a frictionless block lifts both corners at once"
        return {
            "corners": draw.corners(double, run(double), claim),
            "velocity_ratio": draw.velocity_ratios(cls, run),
            "rocking": draw.rocking(slender, run(slender)),
        }
