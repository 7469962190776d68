"""A slender rod that slides with one end on a rough plane, into or out of Painleve's paradox."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import Plate, Rest, RigidBody, Sphere
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from scenarios.sliding_rod.paradox import Rod

Floats = NDArray[np.float64]

GRAVITY = 9.81
_SAMPLES = 2000


@final
@dataclass(frozen=True)
class SlidingRod(Scenario):
    """A uniform rod in the plane of x and z, its lower end ahead: it slides towards +x at ``speed``.

    The ends are spheres of a radius far below the length; in the limit of sharp ends the paradox begins at the
    friction coefficient 4/3, at tan(angle) = 2.  The rod is thin: m (2 s)^2 / 12 about its middle.

    References
    ----------
    F. Génot, B. Brogliato, "New results on Painlevé paradoxes", Eur. J. Mech. A/Solids 18 (1999) 653-677.
    """

    title: ClassVar[str] = "Painleve's sliding rod"
    coordinate_units: ClassVar[Mapping[str, str]] = {
        "x": "m",
        "z": "m",
        "phi": "rad",
        "phi_rate": "rad/s",
        "slip": "m/s",
    }
    units: ClassVar[Mapping[str, str]] = {"impact_without_collision": "s", "jam": "s", "lift_off": "s"}

    friction: float = parameter(
        1.4, doc="kinetic friction coefficient mu", minimum=0.0, usual=(0.01, 10.0), law="friction"
    )
    tilt: float = parameter(
        math.atan(2.0),
        doc="angle phi of the rod from the ground at the start",
        unit="rad",
        above=0.0,
        maximum=math.pi / 2.0,
    )
    speed: float = parameter(1.0, doc="slip speed of the lower end at the start", unit="m/s", usual=(-10.0, 10.0))
    rate: float = parameter(0.0, doc="rate of phi at the start, positive when it gets steeper", unit="rad/s")
    half_length: float = parameter(0.1, doc="half of the length, s", unit="m", above=0.0, usual=(1e-3, 10.0))
    end_radius: float = parameter(1e-5, doc="radius of the ends", unit="m", above=0.0, usual=(1e-7, 1e-2))
    mass: float = parameter(0.1, doc="mass", unit="kg", above=0.0, usual=(1e-4, 1e3))
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    t_end: float = parameter(0.2, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        if not self.tilt < math.pi / 2.0:
            raise InvalidInput(
                "SlidingRod.tilt", "must be below pi/2", self.tilt, "Give the angle from the ground in [rad]."
            )

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A two-thousandth of the run [s]."""
        return self.t_end / _SAMPLES

    @property
    def rod(self) -> Rod:
        """The rod's formulas."""
        return Rod(self.mass, self.half_length, self.end_radius)

    def build(self) -> System:
        """Return plane and rod at their start."""
        s, r = self.half_length, self.end_radius
        across = self.rod.inertia
        body = RigidBody(self.mass, (0.5 * self.mass * r * r, across, across), (Sphere(r, x=s), Sphere(r, x=-s)))
        plane = Plate(Rest())
        system = System([plane, body], gravity=GRAVITY)
        system.contact(
            body, plane, normal=Unilateral(), friction=Coulomb(self.friction), impact=EnergeticImpact(self.restitution)
        )
        ahead, height = self.rod.arm(self.tilt)
        system.place(
            body,
            position=(0.0, 0.0, height),
            orientation=(math.cos(self.tilt / 2.0), 0.0, math.sin(self.tilt / 2.0), 0.0),
            velocity=(self.speed + self.rate * height, 0.0, self.rate * ahead),
            angular_velocity=(0.0, self.rate, 0.0),
        )
        return system

    def tilts(self, q: Floats) -> Floats:
        """Return phi [rad] of states of the run, shape [n, n_q] -> [n]."""
        angle: Floats = 2.0 * np.arctan2(q[:, 5], q[:, 3])
        return angle

    def slips(self, q: Floats, u: Floats) -> Floats:
        """Return the slip velocity of the lower end [m/s] of states of the run, shape [n]."""
        velocity: Floats = u[:, 0] - u[:, 4] * (self.half_length * np.sin(self.tilts(q)) + self.end_radius)
        return velocity

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, z [m] of the middle, phi [rad], its rate [rad/s] and the slip [m/s] over the samples."""
        q, u = solution.q, solution.u
        return {"x": q[:, 0], "z": q[:, 2], "phi": self.tilts(q), "phi_rate": u[:, 4], "slip": self.slips(q, u)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u} at the end: x, z [m], phi [rad] and their rates."""
        q, u = solution.q_end, solution.u_end
        phi = float(self.tilts(q[None])[0])
        return {"q": [float(q[0]), float(q[2]), phi], "u": [float(u[0]), float(u[2]), float(u[4])]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the critical friction at the start, and when [s] what happened first (None if it did not)."""
        events = solution.events

        def first(cause: int) -> float | None:
            found = events.time[events.cause == cause]
            return float(found[0]) if len(found) > 0 else None

        return {
            "critical_friction": self.rod.critical_friction(self.tilt),
            "impact_without_collision": first(Cause.PAINLEVE),
            "jam": first(Cause.JAM),
            "lift_off": first(Cause.LIFT_OFF),
            "events": events.causes(),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return whether the start is a paradox, and the rate at which the rod then turns about its end if e = 0."""
        if self.speed <= 0.0 or self.rod.free_acceleration(self.tilt, self.rate, GRAVITY) >= 0.0:
            return ()
        events, rod = solution.events, self.rod
        paradox = self.friction > rod.critical_friction(self.tilt)
        # the first event is the start itself, unless it is an impact
        struck = float(len(events.cause) > 0 and events.cause[0] == Cause.PAINLEVE)
        source = "Genot and Brogliato (1999): no force where mu > (1 + a + tan^2 phi) / (a tan phi), a = m s^2 / J"
        found = [Criterion.near("impacts without collision at the start", struck, float(paradox), 0.0, source)]
        if paradox and struck and self.restitution == 0.0:
            ahead, below = rod.arm(self.tilt)
            before, after = events.u_before[0], events.u_after[:1]
            moment = rod.inertia * before[4] + rod.mass * (below * before[0] + ahead * before[2])
            pivoting = moment / (rod.inertia + rod.mass * (ahead**2 + below**2))
            source = "angular momentum about the end, which stops"
            found.append(
                Criterion.near("rate of the rod after it [rad/s]", after[0, 4], pivoting, 1e-6 * abs(pivoting), source)
            )
            slip = float(self.slips(events.q[:1], after)[0]) / self.speed
            found.append(Criterion.near("slip after it over that before", slip, 0.0, 1e-8, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return angle, slip and height of the lower end over time."""
        from scenarios.sliding_rod.figures import history

        return {"history": history(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return where the paradox begins, and three runs: lift-off, jamming, impact without collision."""
        from scenarios.sliding_rod.figures import gallery

        return gallery(cls, run)
