"""A tower of prisms, of which the uppermost is pushed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import HullBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

Floats = NDArray[np.float64]

_SAMPLES = 400
_GRAVITY = 9.81
_SIDES = (6, 5, 4, 3)
"""Sides of the prisms, from below."""


@final
@dataclass(frozen=True)
class PolyhedronStack(Scenario):
    """Prisms of six, five, four and three sides on each other, each a little smaller than that under it and turned.

    What holds them are corners on faces and edges across edges; as the uppermost slides, its corners leave the face
    below, and the crossings of its edges take over.
    """

    title: ClassVar[str] = "Tower of prisms"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m"}
    units: ClassVar[Mapping[str, str]] = {"way": "m", "friction_loss": "J"}

    radius: float = parameter(0.03, doc="radius round the lowest prism", unit="m", above=0.0, usual=(1e-3, 10.0))
    height: float = parameter(0.02, doc="height of a prism", unit="m", above=0.0, usual=(1e-3, 10.0))
    taper: float = parameter(0.94, doc="radius of a prism over that under it", above=0.1, maximum=1.0)
    turn: float = parameter(
        0.3, doc="angle of a prism from that under it", unit="rad", minimum=-math.pi, maximum=math.pi
    )
    density: float = parameter(1000.0, doc="density", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    push: float = parameter(
        0.3, doc="speed of the uppermost at the start, along x", unit="m/s", minimum=0.0, usual=(1e-3, 10.0)
    )
    friction: float = parameter(0.5, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(0.2, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        if self.friction == 0.0 and self.push == 0.0:
            raise InvalidInput(
                "PolyhedronStack.push", "must be positive without friction", self.push, "Nothing would happen."
            )

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A four-hundredth of the run [s]."""
        return self.t_end / _SAMPLES

    def prisms(self) -> list[HullBody]:
        """Return the prisms from below."""
        found = []
        for i, sides in enumerate(_SIDES):
            radius, angles = self.radius * self.taper**i, 2.0 * np.pi * np.arange(sides) / sides
            ring = radius * np.column_stack([np.cos(angles), np.sin(angles)])
            points = [(x, y, z) for x, y in ring.tolist() for z in (-0.5 * self.height, 0.5 * self.height)]
            found.append(HullBody(points, density=self.density))
        return found

    def build(self) -> System:
        """Return ground and tower, the uppermost prism with its speed."""
        prisms = self.prisms()
        bodies = [Plate(Rest()), *prisms]
        system = System(bodies, gravity=_GRAVITY)
        for one, two in itertools.pairwise(bodies):
            system.contact(one, two, normal=Unilateral(), friction=Coulomb(self.friction), impact=EnergeticImpact(0.0))
        for i, prism in enumerate(prisms):
            half = 0.5 * i * self.turn
            system.place(
                prism,
                position=(0.0, 0.0, self.height * (i + 0.5)),
                orientation=(math.cos(half), 0.0, 0.0, math.sin(half)),
                velocity=(self.push if i == len(prisms) - 1 else 0.0, 0.0, 0.0),
            )
        return system

    def positions(self, solution: Solution) -> Floats:
        """Return the centres over the samples [m], shape [n_samples, n, 3]."""
        return solution.q.reshape(len(solution.t), -1, 7)[:, :, :3]

    @property
    def way(self) -> float:
        """How far friction lets the uppermost slide, v^2 / (2 mu g) [m]."""
        return self.push**2 / (2.0 * self.friction * _GRAVITY) if self.friction > 0.0 else math.inf

    @property
    def stands(self) -> bool:
        """Whether the uppermost stops long before it tips, and nothing below it slides or is turned over."""
        inner = self.radius * self.taper ** (len(_SIDES) - 2) * math.cos(math.pi / _SIDES[-2])
        return self.way < 0.5 * inner and self.friction * self.height < 0.6 * inner

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y and z of every prism [m] over the samples."""
        places = self.positions(solution)
        return {f"{c}_{i + 1}": places[:, i, j] for i in range(len(_SIDES)) for j, c in enumerate("xyz")}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: positions [m], quaternions, velocities at the end."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return how far each prism went, and the events by cause."""
        causes = solution.events.causes()
        ends = solution.q_end.reshape(-1, 7)[:, :3]
        return {
            "way": np.linalg.norm(ends - self.positions(solution)[0], axis=1).tolist(),
            "events": {cause: causes.count(cause) for cause in sorted(set(causes))},
            "friction_loss": solution.energy.friction_loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return what was lost to friction and, of a push that it survives, how far each prism went."""
        account = solution.energy
        start, end = account.kinetic_start + account.potential_start, account.kinetic_end + account.potential_end
        found = [
            Criterion.near(
                "energy less what was lost over that at the start",
                (end + account.loss) / start,
                1.0,
                1e-9,
                "balance of energy",
            )
        ]
        if self.stands and self.t_end > self.push / (self.friction * _GRAVITY):
            way = solution.q_end.reshape(-1, 7)[:, :3] - self.positions(solution)[0]
            source = "Coulomb's law: v^2 / (2 mu g)"
            found.append(Criterion.near("way of the uppermost [m]", way[-1, 0], self.way, 1e-9, source))
            rest = float(np.max(np.abs(way[:-1])))
            found.append(Criterion.near("way of those below [m]", rest, 0.0, 1e-9, "friction below bears more weight"))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the tower before and after, and the way of the uppermost."""
        from scenarios.polyhedron_stack.figures import tower

        return {"tower": tower(self, solution)}
