"""A rigid part with the surface of a mesh falls on flat ground and tumbles to rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import METRES, MeshBody, MeshFile, Plate, Surface, Triangles
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.placing.starts import at_height
from nonsmooth.rotations import rotation
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_BUILT_IN = "bracket"
_OUTLINE = ((0.0, 0.0), (0.06, 0.0), (0.06, 0.01), (0.012, 0.01), (0.012, 0.04), (0.0, 0.04))
"""Outline of the bracket, an L [m], counter-clockwise."""
_CAPS = ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5))
"""Triangles that fill the outline, by indices of its corners."""
_DEPTH, _TAPER = 0.03, 0.25
"""Depth of the bracket along z [m], and fraction by which its far end is smaller than its near end, respectively.

The smaller end makes all faces of the bracket different.
"""


@final
@dataclass(frozen=True)
class MeshDrop(Scenario):
    """A part from a mesh file falls on flat ground, tumbles and comes to rest.

    ``mesh=part.stl`` loads the user's own file, in any format that trimesh reads, with ``unit`` for the unit of its
    numbers.  The default is a bracket of 60 mm.
    """

    title: ClassVar[str] = "A part dropped on the ground"
    coordinate_units: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("x", "y", "z", "lowest"), "m"),
        "kinetic_energy": "J",
    }
    units: ClassVar[Mapping[str, str]] = {"extent": "m", "mass": "kg", "first_impact": "s"}

    mesh: str = parameter(_BUILT_IN, doc="file of the surface, or the bracket that comes with the scenario", unit="")
    unit: str = parameter("mm", doc="unit of the numbers in the file", unit="", choices=tuple(METRES))
    scale: float = parameter(1.0, doc="factor by which the part of the file is enlarged", above=0.0)
    repair: str = parameter("none", doc="repairs of the file, such as merge or holes, joined by commas", unit="")
    density: float = parameter(2700.0, doc="density", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    height: float = parameter(
        0.05, doc="height of the lowest point at the start", unit="m", above=0.0, usual=(1e-4, 10.0)
    )
    tilt: float = parameter(
        0.6, doc="angle of the part's z axis with the vertical at the start", unit="rad", maximum=math.pi
    )
    direction: float = parameter(
        0.4, doc="direction towards which it leans, from x towards y", unit="rad", minimum=-math.pi, maximum=math.pi
    )
    spin: float = parameter(0.0, doc="spin about the vertical at the start", unit="rad/s", usual=(1e-3, 1e3))
    speed: float = parameter(0.0, doc="speed along x at the start", unit="m/s", usual=(1e-3, 1e2))
    restitution: float = parameter(
        0.4, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    contact_time: float = parameter(
        1e-4, doc="contact time T_c that ends an accumulation", unit="s", above=0.0, usual=(1e-12, 1e-2), law="impact"
    )
    t_end: float = parameter(0.3, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))
    _body: MeshBody = field(init=False, repr=False, compare=False)

    def _check(self) -> None:
        object.__setattr__(self, "_body", MeshBody(self._surface(), density=self.density))

    def _surface(self) -> Surface:
        if self.mesh == _BUILT_IN:
            return _bracket()
        words = tuple(word.strip() for word in self.repair.split(",")) if self.repair != "none" else ()
        return MeshFile(self.mesh, self.unit, self.scale, words)

    @property
    def body(self) -> MeshBody:
        """The part, one object for the scenario's geometry and figures; :meth:`build` makes an equal one that falls."""
        return self._body

    @property
    def orientation(self) -> tuple[float, float, float, float]:
        """Unit quaternion from the axes of the mesh to the world's at the start."""
        half = 0.5 * self.tilt
        axis = -math.sin(self.direction), math.cos(self.direction)
        return math.cos(half), math.sin(half) * axis[0], math.sin(half) * axis[1], 0.0

    def build(self) -> System:
        """Return ground and part at its start."""
        ground, body = Plate(), MeshBody(self.body.surface, density=self.density)
        system = System([ground, body], gravity=_GRAVITY)
        friction = Coulomb(self.friction) if self.friction > 0.0 else Frictionless()
        impact = EnergeticImpact(self.restitution, duration=self.contact_time)
        system.contact(ground, body, normal=Unilateral(), friction=friction, impact=impact)
        spin = rotation(self.orientation).T @ np.array([0.0, 0.0, self.spin])
        at_height(
            system,
            body,
            self.height,
            position=(0.0, 0.0, self.height + 2.0 * self.body.mesh.extent),
            orientation=self.orientation,
            velocity=(self.speed, 0.0, 0.0),
            angular_velocity=tuple(spin.tolist()),
        )
        return system

    def corners(self, q: Floats) -> Floats:
        """Return the vertices of the mesh in the world for the coordinates of one instant [m], shape [n, 3]."""
        own = self.body.mesh.vertices - self.body.centre
        return np.asarray(own @ rotation(q[3:7]).T + q[:3])

    def lowest(self, solution: Solution) -> Floats:
        """Return the height of the lowest point over the samples [m], shape [n_samples]."""
        own = self.body.mesh.hull.corners - self.body.centre
        a, b, c, d = solution.q[:, 3:7].T
        rows = np.stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d], axis=1)
        return np.asarray(solution.q[:, 2] + np.min(rows @ own.T, axis=1))

    def kinetic_energy(self, u: Floats) -> Floats:
        """Return the kinetic energy [J], shape [n], for velocities of shape [n, 6]."""
        (x, y, z), (yz, xz, xy) = self.body.inertia, self.body.products
        tensor = np.array([[x, xy, xz], [xy, y, yz], [xz, yz, z]])
        turning = np.einsum("ni,ij,nj->n", u[:, 3:], tensor, u[:, 3:])
        return np.asarray(0.5 * (self.body.total_mass * np.sum(u[:, :3] ** 2, axis=1) + turning))

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return mass centre x, y, z [m], lowest point [m] and kinetic energy [J] over the samples."""
        position = {name: solution.q[:, i] for i, name in enumerate("xyz")}
        return {**position, "lowest": self.lowest(solution), "kinetic_energy": self.kinetic_energy(solution.u)}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return sizes of the part, kinetic energy at the end / energy of the fall, number of impacts, losses [J]."""
        mesh = self.body.mesh
        kinetic = float(self.kinetic_energy(solution.u_end[None])[0])
        return {
            "triangles": len(mesh.faces),
            "corners": len(mesh.hull.corners),
            "extent": mesh.extent,
            "mass": self.body.total_mass,
            "volume_ratio": mesh.volume_ratio,
            "repairs": list(mesh.repairs),
            "first_impact": self._first_impact(solution),
            "kinetic_share": kinetic / (self.body.total_mass * _GRAVITY * self.height),
            **super().summarise(solution),
        }

    def _first_impact(self, solution: Solution) -> float | None:
        times = solution.events.time[solution.events.cause == Cause.IMPACT]
        return float(times[0]) if len(times) else None

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria for the body's lowest point, the time of the first impact, and the balance of energy."""
        system = self.build()
        q, u = system.start(system.bodies[1])
        kinetic = self.kinetic_energy(np.stack([u, solution.u_end]))
        weight = self.body.total_mass * _GRAVITY
        given = weight * float(q[2] - solution.q_end[2]) + float(kinetic[0] - kinetic[1])
        fall = math.sqrt(2.0 * self.height / _GRAVITY)
        depth = float(np.min(self.lowest(solution))) / self.body.mesh.extent
        found = [Criterion("lowest point over the largest extent", depth, -1e-8, math.inf, "unilateral contact")]
        if self.spin == 0.0 and solution.t_end > fall:
            name, first = "time of the first impact over that of a free fall", self._first_impact(solution) or math.nan
            found.append(Criterion.near(name, first / fall, 1.0, 1e-9, "t = sqrt(2 h / g)"))
        if solution.energy.loss > 0.0:
            name, ratio = "losses over the energy that height and speed gave", solution.energy.loss / given
            found.append(Criterion.near(name, ratio, 1.0, 1e-6, "balance of energy"))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the part at six instants, and its lowest point and energy over time."""
        return {"poses": draw.poses(self, solution), "history": draw.history(self, solution)}


def _bracket() -> Triangles:
    """Return the surface of an L-shaped bracket, 60 mm long, not convex: 12 vertices and 20 triangles."""
    n = len(_OUTLINE)
    near = [(x, y, 0.0) for x, y in _OUTLINE]
    far = [((1.0 - _TAPER) * x, (1.0 - _TAPER) * y, _DEPTH) for x, y in _OUTLINE]
    faces = [(a, c, b) for a, b, c in _CAPS] + [(a + n, b + n, c + n) for a, b, c in _CAPS]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, j + n), (i, j + n, i + n)]
    return Triangles((*near, *far), tuple(faces), _BUILT_IN)
