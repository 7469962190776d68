"""Euler's disk: a thin disc rolls on its rim, ever flatter and ever faster."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import DiscBody, Plate, Rest
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from . import steady
from .air_film import AirFilm
from .tilt_guard import TiltGuard

Floats = NDArray[np.float64]

_GRAVITY = 9.81


@final
@dataclass(frozen=True)
class RollingDisc(Scenario):
    """Euler's disk: a thin disc rolls on its rim, ever flatter and ever faster.

    Contact friction acts on slip only: without air the disc would roll for ever.  Here the moment of :class:`AirFilm`
    lets it settle.  Real discs also lose energy by rolling friction and vibration.

    References
    ----------
    H. K. Moffatt, "Euler's disk and its finite-time singularity", Nature 404 (2000) 833-834; radius, mass
    and viscosity are from there.
    """

    title: ClassVar[str] = "Euler's disk"
    samples: ClassVar[int] = 4000
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m", "tilt": "rad", "precession": "rad/s"}
    units: ClassVar[Mapping[str, str]] = {
        "time": "s",
        "tilt": "rad",
        "precession": "rad/s",
        "friction_loss": "J",
        "air_loss": "J",
    }

    radius: float = parameter(0.0375, doc="radius a", unit="m", above=0.0, usual=(1e-4, 10.0))
    mass: float = parameter(0.4, doc="mass", unit="kg", above=0.0, usual=(1e-6, 1e4))
    tilt: float = parameter(0.1, doc="angle alpha to the table at the start", unit="rad", above=0.0, maximum=1.5)
    pace: float = parameter(
        1.0, doc="precession rate at the start over that of steady rolling", minimum=0.0, usual=(0.1, 10.0)
    )
    spin: float = parameter(0.0, doc="angular velocity about the own axis at the start", unit="rad/s")
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    restitution: float = parameter(
        0.5, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    viscosity: float = parameter(
        1.8e-5, doc="viscosity of the air; 0 for none", unit="Pa s", minimum=0.0, usual=(1e-6, 10.0)
    )
    end_tilt: float = parameter(0.02, doc="tilt that ends the run", unit="rad", above=0.0, maximum=1.5)
    t_end: float = parameter(
        100.0, doc="end time, if the run does not end before", unit="s", above=0.0, usual=(1e-6, 1e4)
    )

    def _check(self) -> None:
        if self.end_tilt >= self.tilt:
            raise InvalidInput(
                "RollingDisc.end_tilt",
                f"must be below the tilt at the start, {self.tilt:g} rad",
                self.end_tilt,
                "The run ends when the disc comes down to it.",
            )

    def build(self) -> System:
        """Return table and disc; the lowest point of the rim is in the direction of x."""
        table, disc = Plate(Rest()), DiscBody(self.radius, mass=self.mass, foot_height=0.0)
        system = System([table, disc], gravity=_GRAVITY)
        friction = Coulomb(self.friction) if self.friction > 0.0 else Frictionless()
        system.contact(table, disc, normal=Unilateral(), friction=friction, impact=EnergeticImpact(self.restitution))
        if self.viscosity > 0.0:
            system.load(AirFilm(self.viscosity, self.radius), table, disc)
        system.guard(TiltGuard(self.end_tilt))
        sine, rate = math.sin(self.tilt), self.pace * float(steady.precession(self.tilt, self.radius, _GRAVITY))
        system.place(
            disc,
            position=(0.0, 0.0, self.radius * sine),
            orientation=(math.cos(0.5 * self.tilt), 0.0, math.sin(0.5 * self.tilt), 0.0),
            angular_velocity=(-rate * sine, 0.0, self.spin),
        )
        return system

    def axis(self, q: Floats, u: Floats) -> tuple[Floats, Floats]:
        """Return the disc's axis and its rate [1/s] in world axes, shapes [n, 3]."""
        return _axis(q, u)

    def tilts(self, solution: Solution) -> Floats:
        """Return the angle between disc and table over the samples [rad]."""
        return _tilt_and_precession(solution.q, solution.u)[0]

    def precession(self, solution: Solution) -> Floats:
        """Return the rate at which the lowest point runs round over the samples [rad/s]."""
        return _tilt_and_precession(solution.q, solution.u)[1]

    def contact_points(self, q: Floats, u: Floats) -> Floats:
        """Return x and y of the lowest point of the rim [m], shape [n, 2]."""
        axis, _ = self.axis(q, u)
        flat = axis[:, :2] / np.hypot(axis[:, 0], axis[:, 1])[:, None]
        return q[:, :2] + self.radius * axis[:, 2, None] * flat

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the centre x, y, z [m], the tilt [rad] and the precession rate [rad/s] over the samples."""
        position = dict(zip("xyz", solution.q.T, strict=False))
        return {**position, "tilt": self.tilts(solution), "precession": self.precession(solution)}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return tilt and precession rate at the end, precession rate / rate of steady rolling, and losses."""
        ends = _tilt_and_precession(solution.q_end[None], solution.u_end[None])
        tilt, rate = (float(end[0]) for end in ends)
        return {
            "time": solution.t_end,
            "tilt": tilt,
            "precession": rate,
            "precession_over_steady": rate / float(steady.precession(tilt, self.radius, _GRAVITY)),
            "friction_loss": solution.energy.friction_loss,
            "air_loss": -solution.energy.load_work,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria for slow settling: precession at the end and duration, both relative to the theory."""
        slow = 1e-2 * self.tilt**2
        if self.pace != 1.0 or self.spin != 0.0 or self.viscosity > slow or self.tilt > 0.3:
            return ()
        steadiness = float(self.summarise(solution)["precession_over_steady"])
        flat = steady.time_to_flat(self.tilt, self.radius, self.mass, self.viscosity)
        exact = flat * (1.0 - (math.sin(self.end_tilt) / math.sin(self.tilt)) ** 3)
        name = "precession at the end over that of steady rolling"
        found = [Criterion.near(name, steadiness, 1.0, 0.01, "Omega^2 sin(alpha) = 4 g / a")]
        if exact < self.t_end:
            source = "the power of the air (Moffatt 2000) in steady rolling; a rolling disc is slower by some alpha^2"
            name, over = "time to the tilt of the end over the theory", solution.t_end / exact
            found.append(Criterion(name, over, 0.999, 1.0 + 3.0 * self.tilt**2, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return tilt over time with precession over tilt, and the paths on the table."""
        words = f"μ = {self.friction:g}, viscosity {self.viscosity:g} Pa s"
        tilts, rates = self.tilts(solution), self.precession(solution)
        strayed = 1e3 * float(np.max(np.hypot(*(solution.q[:, :2] - solution.q[0, :2]).T)))
        settles = (
            f"As the tilt goes from {tilts[0]:.3g} to {tilts[-1]:.3g} rad the contact runs round "
            f"at {rates[0]:.3g} to {rates[-1]:.3g} rad/s ({words})"
        )
        strays = f"The centre strays by {strayed:.2g} mm from where it started\n({words})"
        run = {"run": (self, solution)}
        return {"settling": draw.settling(run, settles), "paths": draw.paths(run, strays)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return a disc that settles through air, and the paths of three discs without air."""
        settling = {"rolls, μ = 0.3": cls(), "slips on a smooth table, μ = 0": cls(friction=0.0)}
        airless = {
            "steady rolling": cls(tilt=0.5, viscosity=0.0, t_end=0.6),
            "precession 0.8 times as fast": cls(tilt=0.5, viscosity=0.0, pace=0.8, t_end=0.6),
            "spin 10 rad/s: slides, then rolls": cls(tilt=0.5, viscosity=0.0, spin=10.0, t_end=0.6),
        }
        settled, rolled = ({name: (disc, run(disc)) for name, disc in discs.items()} for discs in (settling, airless))
        return {
            "settling": draw.settling(settled, "The flatter the disc, the faster its contact runs round"),
            "paths": draw.paths(rolled, "Only steady rolling keeps the centre at rest (no air)"),
        }


def _axis(q: Floats, u: Floats) -> tuple[Floats, Floats]:
    """Return the disc's axis and its rate in world axes, shapes [n, 3]."""
    a, b, c, d = q[:, 3:7].T
    first = np.stack([a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)], axis=1)
    second = np.stack([2.0 * (b * c - a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d + a * b)], axis=1)
    third = np.stack([2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a - b * b - c * c + d * d], axis=1)
    return third, u[:, 4, None] * first - u[:, 3, None] * second


def _tilt_and_precession(q: Floats, u: Floats) -> tuple[Floats, Floats]:
    """Return the angle between disc and table and the rate at which the lowest point runs round, shapes [n]."""
    axis, rate = _axis(q, u)
    across = np.hypot(axis[:, 0], axis[:, 1])
    tilts: Floats = np.arctan2(across, np.abs(axis[:, 2]))
    turned: Floats = axis[:, 0] * rate[:, 1] - axis[:, 1] * rate[:, 0]
    return tilts, turned / across**2
