"""A slender rod that slides with one end on a rough plane, into or out of Painleve's paradox."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Plate, Rest, RigidBody, Sphere
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from .paradox import RodContact

Floats = NDArray[np.float64]

GRAVITY = 9.81


@final
@dataclass(frozen=True)
class SlidingRod(Scenario):
    """A rod slides with its lower end ahead and jams: Painlevé's paradox.

    It moves towards +x at ``speed``.  The ends are spheres, much smaller than the length.  For sharp ends the paradox
    needs a friction coefficient above 4/3, its critical value if the angle phi of the rod from the ground has
    tan(phi) = 2; at other angles it is larger.  The moment of inertia is m (2 s)^2 / 12, as for a thin rod of
    half-length s.

    References
    ----------
    F. Génot, B. Brogliato, "New results on Painlevé paradoxes", Eur. J. Mech. A/Solids 18 (1999) 653-677.
    """

    title: ClassVar[str] = "Painleve's sliding rod"
    samples: ClassVar[int] = 2000
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

    @property
    def rod(self) -> RodContact:
        """Closed forms of the rod's contact."""
        return RodContact(self.mass, self.half_length, self.end_radius)

    def build(self) -> System:
        """Return plane and rod at their start."""
        s, r = self.half_length, self.end_radius
        across = self.rod.inertia
        body = RigidBody(self.mass, (0.5 * self.mass * r * r, across, across), (Sphere(r, x=s), Sphere(r, x=-s)))
        plane = Plate(Rest())
        system = System([plane, body], gravity=GRAVITY)
        friction, impact = Coulomb(self.friction), EnergeticImpact(self.restitution)
        system.contact(body, plane, normal=Unilateral(), friction=friction, impact=impact)
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
        """Return the angle phi of the rod from the ground [rad], shape [n], at coordinates of shape [n, n_q]."""
        angle: Floats = 2.0 * np.arctan2(q[:, 5], q[:, 3])
        return angle

    def slips(self, q: Floats, u: Floats) -> Floats:
        """Return the slip velocity of the lower end [m/s], shape [n], at q and u with one state per row."""
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
        """Return criteria: whether Painleve's paradox holds at the start of the run.

        If it does, and e = 0, also the angular velocity and the slip after the impact.
        """
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
            name, tolerance = "rate of the rod after it [rad/s]", 1e-6 * abs(pivoting)
            found.append(Criterion.near(name, after[0, 4], pivoting, tolerance, source))
            slip = float(self.slips(events.q[:1], after)[0]) / self.speed
            found.append(Criterion.near("slip after it over that before", slip, 0.0, 1e-8, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return angle, slip and gap of the lower end over time."""
        critical = f"the paradox begins at {self.rod.critical_friction(self.tilt):.4g} for this angle"
        title = f"µ = {self.friction:g}; {critical}"
        return {"history": draw.histories({"": (self, solution)}, title)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the region of Painleve's paradox, and three runs: lift-off, jamming, impact without collision."""
        cases = {
            "lift-off": cls(friction=1.2, tilt=1.0, rate=8.0, speed=5.0, t_end=0.08),
            "jamming": cls(friction=2.0, tilt=0.5, rate=5.0, speed=3.0, t_end=0.04),
            "impact without collision": cls(friction=1.4, t_end=0.04),
        }
        runs = {name: (rod, run(rod)) for name, rod in cases.items()}
        title = "Sliding can end in a lift-off, in a jam if it runs into the paradox, or at once if it starts there"
        return {"paradox": draw.paradox(cls(t_end=1e-6), run), "histories": draw.histories(runs, title)}
