"""The dumbbell of :mod:`scenarios.dumbbell` with polyhedra in place of balls, compared with the dumbbell with balls."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Dumbbell, RigidBody, TriangleMesh, Triangles
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import UnusualValue, parameter
from nonsmooth.rotations import rotation
from nonsmooth.runs.simulate import simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from .dumbbell import DumbbellScenario
from .dumbbell.scenario import GRAVITY

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_COMPARED = 3
"""Impacts whose times are compared."""
_GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
_CORNERS = np.array([np.roll((0.0, a, b * _GOLDEN), k) for k in (0, 2, 1) for a in (-1.0, 1.0) for b in (-1.0, 1.0)])
"""Vertices of an icosahedron with edges of length 2."""


@final
@dataclass(frozen=True)
class MeshDumbbell(Scenario):
    """A dumbbell of polyhedra on a vibrating plate, compared with the dumbbell of balls.

    It has the mass and inertia of the dumbbell with balls, so that only the surface differs.
    """

    title: ClassVar[str] = "Dumbbell out of meshes"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m", "gap": "m"}
    units: ClassVar[Mapping[str, str]] = {"delays": "s", "distance_at_end": "m"}

    mode: str = parameter(
        "drift", doc="mode of the dumbbell whose start is taken", unit="", choices=("drift", "jump", "flutter")
    )
    subdivisions: int = parameter(
        2, doc="n of 20 4^n triangles for a ball; 0 is an icosahedron", minimum=0, maximum=4, integer=True
    )
    t_end: float = parameter(0.1, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e2))

    @property
    def exact(self) -> DumbbellScenario:
        """The dumbbell with exact balls, in the same mode and to the same end time."""
        return DumbbellScenario(mode=self.mode, t_end=self.t_end)

    def build(self) -> System:
        """Return plate and dumbbell at their start."""
        system = self.exact.build()
        (dumbbell,) = (body for body in system.bodies if isinstance(body, Dumbbell))
        (plate,) = (body for body in system.bodies if body is not dumbbell)
        contact, half = system.contacts[0], 0.5 * dumbbell.centre_distance
        assert contact.impact is not None
        surface = ball_of_triangles(dumbbell.radius, self.subdivisions)
        balls = TriangleMesh(surface, -half), TriangleMesh(surface, half)
        body = RigidBody(dumbbell.total_mass, dumbbell.inertia, balls)
        meshes = System([plate, body], gravity=GRAVITY)
        with warnings.catch_warnings():
            # the warning reports a mesh with many corners, which is intended here
            warnings.simplefilter("ignore", UnusualValue)
            meshes.contact(plate, body, normal=contact.normal, friction=contact.friction, impact=contact.impact)
        meshes.set_start(body, *system.start(dumbbell))
        return meshes

    def with_balls(self) -> Solution:
        """Return a run of the same scenario with balls, with samples at the same times."""
        return simulate(self.exact.build(), self.t_end, sample_interval=self.sample_interval, progress=None)

    def gaps(self, t: Floats, q: Floats, meshes: bool) -> Floats:
        """Return the gaps of both balls over the plate [m], shape [n, 2], of polyhedra or of balls."""
        scenario, radius = self.exact, self.exact.radius
        half = 0.5 * scenario.centre_distance
        corners = np.array(ball_of_triangles(radius, self.subdivisions).mesh.vertices)
        rows = np.array([rotation(one)[2] for one in q[:, 3:7]])
        centers = q[:, 2:3] + rows[:, :1] * [-half, half]
        depth = -np.min(rows @ corners.T, axis=1) if meshes else np.full(len(q), radius)
        return np.asarray(centers - depth[:, None] - scenario.plate_height(t)[:, None])

    def delays(self, solution: Solution, balls: Solution) -> list[float]:
        """Return the times of the first impacts minus the times of the same impacts with balls [s]."""
        own, other = (one.events.time[one.events.cause == Cause.IMPACT][:_COMPARED] for one in (solution, balls))
        n = min(len(own), len(other))
        return [float(x) for x in own[:n] - other[:n]]

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return mass centre x, y, z [m] and the gaps of both balls [m] over the samples."""
        gaps = self.gaps(solution.t, solution.q, meshes=True)
        return {**{name: solution.q[:, i] for i, name in enumerate("xyz")}, "gap_1": gaps[:, 0], "gap_2": gaps[:, 1]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return numbers of triangles, contacts and impacts, impacts with balls, delays [s], distance at the end [m].

        The distance is the distance between the mass centres of both dumbbells.
        """
        balls = self.with_balls()
        return {
            "triangles": 20 * 4**self.subdivisions,
            "contacts": len(self.build().contacts),
            "impacts": solution.counters.impacts,
            "impacts_of_balls": balls.counters.impacts,
            "delays": self.delays(solution, balls),
            "distance_at_end": float(math.dist(solution.q_end[:3], balls.q_end[:3])),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the deepest point below the plate over the radius, and the delay of the second impact."""
        lowest = float(np.min(self.gaps(solution.t, solution.q, meshes=True)))
        found = [Criterion("gap over the radius", lowest / self.exact.radius, -1e-7, math.inf, "unilateral contact")]
        delays = self.delays(solution, self.with_balls())
        if len(delays) > 1:
            source = "a polyhedron is no ball: milliseconds with a thousand triangles, more with fewer"
            found.append(Criterion("delay of the second impact [s]", abs(delays[1]), 1e-5, 1e-2, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the gaps of both dumbbells over time."""
        return {"gaps": _gaps([(self, solution)], self.with_balls())}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the gaps for balls of 80 and of 1280 triangles."""
        scenarios = [cls(subdivisions=1), cls(subdivisions=3)]
        return {"gaps": _gaps([(one, run(one)) for one in scenarios], scenarios[0].with_balls())}


def ball_of_triangles(radius: float, subdivisions: int) -> Triangles:
    """Return an icosahedron whose triangles are cut in four ``subdivisions`` times, all vertices at ``radius`` [m]."""
    from scipy.spatial import ConvexHull

    points = _CORNERS / math.hypot(1.0, _GOLDEN)
    for _ in range(subdivisions):
        triangles = ConvexHull(points).simplices
        edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        middles = np.sum(points[edges], axis=1)
        points = np.vstack([points, middles / np.linalg.norm(middles, axis=1)[:, None]])
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    # Qhull orders the corners of a facet in either sense: turn those with an inward normal
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ni,ni->n", normals, corners[:, 0]) < 0
    faces = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    return Triangles(radius * points, faces, f"of {len(faces)} triangles")


def _gaps(runs: Sequence[tuple[MeshDumbbell, Solution]], balls: Solution) -> Figure:
    """Draw the gaps of both balls over time, and their largest difference from the gaps with balls."""
    exact = runs[0][0].gaps(balls.t, balls.q, meshes=False)
    curves = {"balls": (balls.t, exact)}
    differences, worst = {}, []
    for scenario, solution in runs:
        own, label = scenario.gaps(solution.t, solution.q, meshes=True), f"{20 * 4**scenario.subdivisions} triangles"
        curves[label] = solution.t, own
        n = min(len(own), len(exact))
        apart = 1e3 * np.max(np.abs(own[:n] - exact[:n]), axis=1)
        differences[label] = 1e3 * solution.t[:n], np.maximum(apart, 1e-6)
        worst.append(f"{float(np.max(apart)):.2g} mm with {label}")
    title = f"Gaps differ from those of balls by up to\n{', '.join(worst)}"
    figure, (*axes, below) = charts.panels(3, 1, title, (7.2, 6.4), sharex=True)
    for i, ax in enumerate(axes):
        gaps = {label: (1e3 * t, 1e3 * gap[:, i]) for label, (t, gap) in curves.items()}
        charts.histories({f"gap of ball {i + 1} [mm]": gaps}, xlabel="", axes=[ax])
        ax.lines[0].set(color="0.7", linewidth=4.0)
    # the balls have no difference: an empty first curve takes their colour, so that each polyhedron keeps its colour
    charts.histories({"largest difference [mm]": {"": ([], []), **differences}}, xlabel="time [ms]", axes=[below])
    below.set_yscale("log")
    charts.legend(figure)
    return figure
