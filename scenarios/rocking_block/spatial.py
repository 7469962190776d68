"""A spatial block, released at rest tilted over an edge or a corner."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import BoxBody, Plate, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter
from nonsmooth.placing.starts import touching
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from .scenario import GRAVITY, laws_of

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class RockingBlock3D(Scenario):
    """A tilted block rocks in space, on edges or from corner to corner.

    Its side towards ``direction`` starts raised.  With direction 0 it stands on the edge of length ``depth`` and moves
    as :class:`RockingBlock` does.
    """

    title: ClassVar[str] = "Rocking block in space"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m", "lean_x": "1", "lean_y": "1"}
    units: ClassVar[Mapping[str, str]] = {**Scenario.units, "largest_lean": "rad"}

    base: float = parameter(0.3, doc="side along x", unit="m", above=0.0, usual=(1e-3, 1e2))
    depth: float = parameter(0.2, doc="side along y", unit="m", above=0.0, usual=(1e-3, 1e2))
    height: float = parameter(1.0, doc="height", unit="m", above=0.0, usual=(1e-3, 1e2))
    mass: float = parameter(1.0, doc="mass", unit="kg", above=0.0, usual=(1e-6, 1e6))
    tilt: float = parameter(
        0.1, doc="angle between base and ground at the start", unit="rad", above=0.0, maximum=math.pi / 2
    )
    direction: float = parameter(
        0.7, doc="direction of the raised side, from x towards y", unit="rad", minimum=-math.pi, maximum=math.pi
    )
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    exponent: float = parameter(
        1.0, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0, law="impact"
    )
    friction: float = parameter(0.6, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(3.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def build(self) -> System:
        """Return ground, block and the contacts of its eight corners."""
        ground = Plate(Rest())
        block = BoxBody(0.5 * self.base, 0.5 * self.depth, 0.5 * self.height, mass=self.mass)
        system = System([ground, block], gravity=GRAVITY)
        system.contact(ground, block, **laws_of(self))
        half = 0.5 * self.tilt
        axis_x, axis_y = math.sin(self.direction), -math.cos(self.direction)
        orientation = (math.cos(half), math.sin(half) * axis_x, math.sin(half) * axis_y, 0.0)
        far = self.base + self.depth + self.height
        touching(system, block, position=(0.0, 0.0, far), orientation=orientation)
        return system

    def axes(self, solution: Solution) -> Floats:
        """Return the third row of the rotation matrix over the samples: heights of the body axes, [n_samples, 3]."""
        a, b, c, d = solution.q[:, 3:7].T
        return np.stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d], axis=1)

    def lean(self, solution: Solution) -> Floats:
        """Return the horizontal part of the block's upright axis over the samples, in world axes [n_samples, 2]."""
        a, b, c, d = solution.q[:, 3:7].T
        return np.stack([2.0 * (b * d + a * c), 2.0 * (c * d - a * b)], axis=1)

    def corner_heights(self, solution: Solution) -> Floats:
        """Return the heights of the four lower corners [m], (-,-), (-,+), (+,-), (+,+) in x and y, [n_samples, 4]."""
        x, y, z = 0.5 * self.base, 0.5 * self.depth, -0.5 * self.height
        corners = np.array([(i * x, j * y, z) for i in (-1, 1) for j in (-1, 1)])
        heights: Floats = solution.q[:, 2, None] + self.axes(solution) @ corners.T
        return heights

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the mass centre x, y, z [m] and the horizontal part of the upright axis over the samples."""
        lean = self.lean(solution)
        position = {name: solution.q[:, i] for i, name in enumerate("xyz")}
        return {**position, "lean_x": lean[:, 0], "lean_y": lean[:, 1]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the times of the first impacts, their modes, and what is lost in all."""
        events = solution.events
        impacts = np.flatnonzero(events.cause == Cause.IMPACT)
        words = events.words("during")
        return {
            "first_impacts": [{"time": float(events.time[i]), "mode": words[i]} for i in impacts[:5]],
            "largest_lean": float(np.max(np.hypot(*self.lean(solution).T))),
            **super().summarise(solution),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return how high the mass centre comes, and losses over the energy that height and speed gave."""
        across = self.base * abs(math.cos(self.direction)) + self.depth * abs(math.sin(self.direction))
        start = 0.5 * (self.height * math.cos(self.tilt) + across * math.sin(self.tilt))
        moments = np.array(BoxBody(0.5 * self.base, 0.5 * self.depth, 0.5 * self.height, mass=self.mass).inertia)
        u = solution.u_end
        kinetic = 0.5 * float(self.mass * u[:3] @ u[:3] + moments @ u[3:] ** 2)
        given = self.mass * GRAVITY * (start - float(solution.q_end[2])) - kinetic
        return (
            Criterion(
                "largest height of the mass centre over that at the start",
                float(np.max(solution.q[:, 2])) / start,
                0.0,
                1.0 + 1e-8,
                "no contact gives energy",
            ),
            Criterion.near(
                "losses over the energy that height and speed gave",
                solution.energy.loss / given,
                1.0,
                1e-5,
                "balance of energy",
            ),
        )

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the path of the upright axis and the heights of the lower corners."""
        return {"spatial": draw.spatial(self, solution)}
