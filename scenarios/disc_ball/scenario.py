"""A disc strikes two balls that touch: the smallest multiple impact in a plane."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Ball
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from .closed_forms import half_angle, symmetric

Floats = NDArray[np.float64]

_NAMES = ("disc", "left", "right")


@final
@dataclass(frozen=True)
class DiscBall(Scenario):
    """A disc strikes two touching balls at once: Bernoulli's problem, without friction and gravity.

    All centres remain in the plane of x and y; y is the axis of symmetry, and the disc moves towards +y.  With
    ``offset`` 0 it touches both balls at the same instant, also if its path is oblique to y.  No body turns, so that a
    sphere can represent the disc.

    References
    ----------
    C. Liu, Z. Zhao, B. Brogliato, "Frictionless multiple impacts in multibody systems. I. Theoretical
    framework", Proc. R. Soc. A 464 (2008) 3193-3211, for the impact law.
    """

    title: ClassVar[str] = "Disc into two balls"
    samples: ClassVar[int] = 400
    coordinate_units: ClassVar[Mapping[str, str]] = {f"{axis}_{name}": "m" for axis in "xy" for name in _NAMES}

    mass_ratio: float = parameter(1.0, doc="mass of the disc over that of a ball", above=0.0, usual=(1e-3, 1e3))
    radius_ratio: float = parameter(1.0, doc="radius of the disc over that of a ball", above=0.0, usual=(1e-2, 1e2))
    stiffness_ratio: float = parameter(
        1.0, doc="stiffness at the right ball over that at the left one", above=0.0, usual=(1e-6, 1e6), law="impact"
    )
    restitution: float = parameter(
        1.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    exponent: float = parameter(
        1.5, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0, law="impact"
    )
    incidence: float = parameter(
        0.0, doc="angle of the disc's velocity from the axis, positive to the right", unit="rad", usual=(-1.0, 1.0)
    )
    offset: float = parameter(
        0.0, doc="distance of the disc's path from the one that reaches both balls at once, to the right", unit="m"
    )
    radius: float = parameter(0.01, doc="radius of the balls", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(7800.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    speed: float = parameter(1.0, doc="speed of the disc", unit="m/s", above=0.0, usual=(1e-3, 1e2))
    distance: float = parameter(0.01, doc="distance to the strike", unit="m", above=0.0, usual=(1e-6, 10.0))
    t_end: float = parameter(0.03, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        # beyond this angle the disc leaves one of the balls when it touches both
        largest = math.pi / 2.0 - self.half_angle
        if abs(self.incidence) >= largest:
            raise InvalidInput(
                "DiscBall.incidence",
                f"must be below {largest:.4g} rad in size, or the disc passes one ball",
                self.incidence,
                "Take a smaller angle [rad].",
            )

    @property
    def half_angle(self) -> float:
        """Angle alpha [rad] between y and the line from the disc's centre to a ball's, when the disc touches both."""
        return half_angle(self.radius_ratio)

    @property
    def radii(self) -> tuple[float, float, float]:
        """Radii of disc, left and right ball [m]."""
        return self.radius_ratio * self.radius, self.radius, self.radius

    @property
    def direction(self) -> Floats:
        """Unit vector of the disc's velocity before the strike, shape [2]."""
        return np.array([math.sin(self.incidence), math.cos(self.incidence)])

    def build(self) -> System:
        """Return disc, balls and contacts at their start."""
        disc = Ball(self.radii[0], self.density * self.mass_ratio / self.radius_ratio**3)
        left, right = Ball(self.radius, self.density), Ball(self.radius, self.density)
        system = System([disc, left, right], gravity=0.0)
        for one, two, stiffness in ((disc, left, 1.0), (disc, right, self.stiffness_ratio), (left, right, 1.0)):
            impact = EnergeticImpact(self.restitution, stiffness, self.exponent)
            system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=impact)
        for ball, x in ((left, -self.radius), (right, self.radius)):
            system.place(ball, position=(x, 0.0, 0.0))
        x, y = self.direction
        between = (self.radii[0] + self.radius) * math.cos(self.half_angle)
        place = (self.offset * y - self.distance * x, -between - self.offset * x - self.distance * y, 0.0)
        system.place(disc, position=place, velocity=(self.speed * x, self.speed * y, 0.0))
        return system

    def positions(self, solution: Solution) -> Floats:
        """Return the centres of disc, left and right ball [m], shape [n_samples, 3, 2]."""
        return solution.q.reshape(len(solution.t), 3, 7)[:, :, :2]

    def velocities(self, solution: Solution) -> Floats:
        """Return final velocities of disc, left and right ball relative to the disc's initial speed, shape [3, 2]."""
        return np.asarray(solution.u_end.reshape(3, 6)[:, :2] / self.speed)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x and y of disc, left and right ball [m] over the samples."""
        places = self.positions(solution)
        return {f"{axis}_{name}": places[:, i, j] for i, name in enumerate(_NAMES) for j, axis in enumerate("xy")}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: centres [m] and velocities [m/s] of disc, left and right ball at the end, x before y."""
        q, u = solution.q_end.reshape(3, 7)[:, :2], solution.u_end.reshape(3, 6)[:, :2]
        return {"q": q.ravel().tolist(), "u": u.ravel().tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the results of a run by name.

        ``disc``, ``left`` and ``right`` are the final velocities (x, y) of disc, left and right ball, relative to the
        initial speed of the disc.  ``energy_kept`` is the final kinetic energy relative to the initial one, ``impacts``
        the number of impacts.
        """
        account = solution.energy
        return {
            **dict(zip(_NAMES, self.velocities(solution).tolist(), strict=True)),
            "energy_kept": account.kinetic_end / account.kinetic_start,
            "impacts": solution.counters.impacts,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the momenta, and all speeds of a symmetric strike."""
        after, found = self.velocities(solution), []
        momenta = np.array([self.mass_ratio, 1.0, 1.0]) @ after
        for axis, value, direction in zip("xy", momenta, self.direction, strict=True):
            name = f"momentum along {axis} over that of a ball at the speed of the disc"
            found.append(Criterion.near(name, value, self.mass_ratio * direction, 1e-9, "balance of momentum"))
        if self.offset == 0.0 and self.incidence == 0.0 and self.stiffness_ratio == 1.0:
            disc, ball = symmetric(self.mass_ratio, self.radius_ratio, self.restitution)
            source = "one impulse for both contacts: P (1/m + 2 cos^2 alpha / M) = (1 + e) v cos alpha"
            found.append(Criterion.near("velocity of the disc after over before", after[0, 1], disc, 1e-6, source))
            for name, velocity in (("left", after[1]), ("right", after[2])):
                speed = float(np.hypot(*velocity))
                found.append(Criterion.near(f"speed of the {name} ball over that before", speed, ball, 1e-6, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the bodies before and after, with their velocities."""
        return {"strike": draw.strike(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the strike, and its outcome over the ratio of stiffnesses and over the offset."""
        one = cls()
        over = {"stiffness": draw.over_stiffness(one, run), "offset": draw.over_offset(one, run)}
        return {**one.figures(run(one)), **over}
