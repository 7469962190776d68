"""The dumbbell with balls out of triangles beside the one with balls."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import Dumbbell, RigidBody, TriangleMesh
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import UnusualValue, parameter, rules
from nonsmooth.rotations import rotation
from nonsmooth.run_scenario import run_scenario
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from scenarios.dumbbell import DumbbellScenario
from scenarios.dumbbell.scenario import GRAVITY
from scenarios.mesh_dumbbell.ball import ball

Floats = NDArray[np.float64]

_SAMPLES = 1000
_COMPARED = 3
"""Impacts whose times are compared."""


@final
@dataclass(frozen=True)
class MeshDumbbell(Scenario):
    """The dumbbell of the paper with polyhedra for balls, from the start of a mode, on the same plate.

    Mass and inertia are those of the body with balls, so that what differs is the surface alone.
    """

    title: ClassVar[str] = "Dumbbell out of meshes"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m", "gap": "m"}
    units: ClassVar[Mapping[str, str]] = {"delays": "s", "distance_at_end": "m"}

    mode: str = parameter(
        "drift",
        doc="the start, by the motion of the dumbbell it leads to",
        unit="",
        choices=("drift", "jump", "flutter"),
    )
    subdivisions: float = parameter(
        2.0, doc="n of 20 4^n triangles for a ball; 0 is an icosahedron", minimum=0.0, maximum=4.0
    )
    t_end: float = parameter(0.1, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e2))

    def _check(self) -> None:
        if self.subdivisions != round(self.subdivisions):
            raise InvalidInput(
                "MeshDumbbell.subdivisions",
                "must be a whole number",
                self.subdivisions,
                "Each cuts triangles into four.",
            )

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A thousandth of the run [s]."""
        return self.t_end / _SAMPLES

    @property
    def exact(self) -> DumbbellScenario:
        """The dumbbell with balls."""
        return DumbbellScenario(mode=self.mode, t_end=self.t_end)

    def build(self) -> System:
        """Return plate and dumbbell at their start."""
        system = self.exact.build()
        (dumbbell,) = (body for body in system.bodies if isinstance(body, Dumbbell))
        (plate,) = (body for body in system.bodies if body is not dumbbell)
        contact, half = system.contacts[0], 0.5 * dumbbell.centre_distance
        assert contact.impact is not None
        surface = ball(dumbbell.radius, int(self.subdivisions))
        balls = TriangleMesh(surface, -half), TriangleMesh(surface, half)
        body = RigidBody(dumbbell.total_mass, dumbbell.inertia, balls)
        meshes = System([plate, body], gravity=GRAVITY)
        with warnings.catch_warnings():
            # that they have many corners is what this is about
            warnings.simplefilter("ignore", UnusualValue)
            meshes.contact(plate, body, normal=contact.normal, friction=contact.friction, impact=contact.impact)
        meshes.set_start(body, *system.start(dumbbell))
        return meshes

    def beside(self) -> Solution:
        """Return a run of the dumbbell with balls."""
        return run_scenario(self.exact)

    def gaps(self, t: Floats, q: Floats, meshes: bool) -> Floats:
        """Return the gaps of both balls over the plate [m], shape [n, 2], of polyhedra or of balls."""
        scenario, radius = self.exact, self.exact.radius
        half = 0.5 * scenario.centre_distance
        corners = np.array(ball(radius, int(self.subdivisions)).mesh.vertices)
        rows = np.array([rotation(one)[2] for one in q[:, 3:7]])
        centers = q[:, 2:3] + rows[:, :1] * [-half, half]
        depth = -np.min(rows @ corners.T, axis=1) if meshes else np.full(len(q), radius)
        return np.asarray(centers - depth[:, None] - scenario.plate_height(t)[:, None])

    def delays(self, solution: Solution, beside: Solution) -> list[float]:
        """Return by how much later the first impacts come than those of the dumbbell with balls [s]."""
        own, other = (one.events.time[one.events.cause == Cause.IMPACT][:_COMPARED] for one in (solution, beside))
        n = min(len(own), len(other))
        return [float(x) for x in own[:n] - other[:n]]

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return mass centre x, y, z [m] and the gaps of both balls [m] over the samples."""
        gaps = self.gaps(solution.t, solution.q, meshes=True)
        return {**{name: solution.q[:, i] for i, name in enumerate("xyz")}, "gap_1": gaps[:, 0], "gap_2": gaps[:, 1]}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: mass centre [m], quaternion, velocity [m/s], angular velocity in body axes [rad/s]."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return triangles of a ball, impacts, those of the body with balls, and the delay of the first ones [s]."""
        beside = self.beside()
        return {
            "triangles": 20 * 4 ** int(self.subdivisions),
            "contacts": len(self.build().contacts),
            "impacts": solution.counters.impacts,
            "impacts_of_balls": beside.counters.impacts,
            "delays": self.delays(solution, beside),
            "distance_at_end": float(math.dist(solution.q_end[:3], beside.q_end[:3])),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the deepest point below the plate over the radius, and the delay of the second impact."""
        lowest = float(np.min(self.gaps(solution.t, solution.q, meshes=True)))
        found = [Criterion("gap over the radius", lowest / self.exact.radius, -1e-7, math.inf, "unilateral contact")]
        delays = self.delays(solution, self.beside())
        if len(delays) > 1:
            source = "a polyhedron is no ball: milliseconds with a thousand triangles, more with fewer"
            found.append(Criterion("delay of the second impact [s]", abs(delays[1]), 1e-5, 1e-2, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the gaps of both dumbbells over time."""
        from scenarios.mesh_dumbbell.figures import gaps

        return {"gaps": gaps([(self, solution)], self.beside())}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the same for balls of 80 and of 1280 triangles."""
        from scenarios.mesh_dumbbell.figures import gaps

        scenarios = [cls(subdivisions=1.0), cls(subdivisions=3.0)]
        runs = [(one, run(one)) for one in scenarios]
        return {"gaps": gaps(runs, scenarios[0].beside())}
