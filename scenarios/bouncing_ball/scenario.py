"""A ball that bounces on a sinusoidally vibrating table: orbits, period doublings, chaos, and how it comes to rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Ball, Harmonic, Plate
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.modes import mode_shares
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from . import orbits

Floats = NDArray[np.float64]

GRAVITY = 9.81
_SAMPLES_PER_PERIOD = 40
_SAMPLES = 20000
_REPEATS = 1e-4
"""Largest difference of two flight times that are treated as equal in the search for a period [table periods]."""


@final
@dataclass(frozen=True)
class BouncingBall(Scenario):
    """A ball bounces on a vibrating table: periodic orbits, period doublings and chaos.

    The table moves as A sin(2 pi f t), with A = Gamma g / (2 pi f)^2.  The ball starts on the orbit whose flights take
    ``orbit`` periods of the table, where that exists, or is dropped from rest at ``height`` above it.

    References
    ----------
    P. J. Holmes, "The dynamics of repeated impacts with a sinusoidally vibrating table", J. Sound Vib. 84 (1982)
    173-189.

    N. B. Tufillaro, T. Abbott, J. Reilly, *An Experimental Approach to Nonlinear Dynamics and Chaos*,
    Addison-Wesley (1992).
    """

    title: ClassVar[str] = "Ball on a vibrating table"
    coordinate_units: ClassVar[Mapping[str, str]] = {"ball": "m", "table": "m"}
    units: ClassVar[Mapping[str, str]] = {"last_flight": "table periods", "first_rest": "s"}

    gamma: float = parameter(
        0.8, doc="peak acceleration of the table over gravity, 0 for a table at rest", minimum=0.0, usual=(0.0, 20.0)
    )
    frequency: float = parameter(25.0, doc="frequency f of the table", unit="Hz", above=0.0, usual=(1.0, 1e3))
    restitution: float = parameter(0.8, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0)
    orbit: int = parameter(
        1, doc="table periods n of a flight on the orbit on which it starts", minimum=1, maximum=100, integer=True
    )
    start_phase: float | None = parameter(
        None,
        doc="phase of the table at the start, by default that of the orbit",
        unit="rad",
        usual=(0.0, 2.0 * math.pi),
    )
    speed: float | None = parameter(
        None, doc="speed at the start, by default that of the orbit, n g / (2 f)", unit="m/s", usual=(-10.0, 10.0)
    )
    height: float | None = parameter(
        None, doc="height of a drop from rest instead of the orbit", unit="m", above=0.0, usual=(1e-6, 10.0)
    )
    radius: float = parameter(0.01, doc="radius of the ball", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(7800.0, doc="density of the ball", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    contact_time: float = parameter(
        2e-5, doc="contact time T_c that ends an accumulation", unit="s", minimum=0.0, usual=(1e-12, 1e-2), law="impact"
    )
    t_end: float = parameter(4.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e4))

    def _check(self) -> None:
        if self.gamma == 0.0 and self.height is None:
            raise InvalidInput(
                "BouncingBall.height", "must be given on a table at rest", None, "Give it in [m], or take gamma > 0."
            )
        if self.height is not None and self.speed is not None:
            raise InvalidInput(
                "BouncingBall.speed", "must be left out of a drop from rest", self.speed, "Leave height or speed out."
            )

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters with the values that the run uses; ``height`` stays None without a drop."""
        return {**super().resolved(), "start_phase": self.phase, "speed": self._start()[1]}

    @property
    def period(self) -> float:
        """Period of the table [s]."""
        return 1.0 / self.frequency

    @property
    def sample_interval(self) -> float:
        """A fortieth of a table period [s], or a 20 000th of the run where that is longer."""
        return max(self.period / _SAMPLES_PER_PERIOD, self.t_end / _SAMPLES)

    @property
    def amplitude(self) -> float:
        """Amplitude A of the table [m]."""
        return self.gamma * GRAVITY / (2.0 * math.pi * self.frequency) ** 2

    @property
    def phase(self) -> float:
        """Phase of the table at t = 0 [rad]."""
        if self.start_phase is not None:
            return self.start_phase
        if self.height is not None:
            return 0.0
        return orbits.impact_phase(self.gamma, self.restitution, self.orbit)

    def table(self, t: Floats) -> Floats:
        """Return the height of the table [m] at times [s]."""
        z: Floats = self.amplitude * np.sin(2.0 * math.pi * self.frequency * t + self.phase)
        return z

    def build(self) -> System:
        """Return table and ball at their start."""
        table = Plate(Harmonic(self.amplitude, self.frequency, self.phase))
        ball = Ball(self.radius, self.density)
        system = System([table, ball], gravity=GRAVITY)
        impact = EnergeticImpact(self.restitution, duration=self.contact_time)
        system.contact(ball, table, normal=Unilateral(), friction=Frictionless(), impact=impact)
        lift, speed = self._start()
        system.place(ball, position=(0.0, 0.0, self.radius + lift), velocity=(0.0, 0.0, speed))
        return system

    def _start(self) -> tuple[float, float]:
        """Return height of the lowest point [m] and velocity [m/s] at the start."""
        table = self.amplitude * math.sin(self.phase)
        if self.height is not None:
            return table + self.height, 0.0
        return table, GRAVITY * self.orbit * self.period / 2.0 if self.speed is None else self.speed

    def impact_times(self, solution: Solution) -> Floats:
        """Return the times of all impacts [s]."""
        times: Floats = solution.events.time[solution.events.cause == Cause.IMPACT]
        return times

    def flights(self, solution: Solution) -> Floats:
        """Return the times between impacts over the table period."""
        times: Floats = np.diff(self.impact_times(solution)) * self.frequency
        return times

    def phases(self, solution: Solution) -> Floats:
        """Return the phases of the table at the impacts, in turns from 0 to 1."""
        turns: Floats = np.mod(self.impact_times(solution) * self.frequency + self.phase / (2.0 * math.pi), 1.0)
        return turns

    def lifts(self, solution: Solution) -> Floats:
        """Return the height of the ball's lowest point [m], shape [n_samples]."""
        height: Floats = solution.q[:, 2] - self.radius
        return height

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the heights of ball (lowest point) and table [m] over the samples."""
        return {"ball": self.lifts(solution), "table": self.table(solution.t)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: height of the lowest point [m] and velocity [m/s] at the end."""
        return {"q": [float(solution.q_end[2] - self.radius)], "u": [float(solution.u_end[2])]}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return number of impacts, last flight [table periods], flights after which it repeats, rest [s and share].

        ``repeats_after`` is None where the last flights show no period up to 16, ``first_rest`` where the ball never
        came to rest on the table.
        """
        flights = self.flights(solution)
        closings = solution.events.time[solution.events.cause == Cause.CLOSING]
        resting = sum(share for word, share in mode_shares(solution).items() if word == "{1,0,0}")
        return {
            "impacts": solution.counters.impacts,
            "last_flight": float(flights[-1]) if len(flights) > 0 else None,
            "repeats_after": orbits.repetition(flights, _REPEATS),
            "first_rest": float(closings[0]) if len(closings) > 0 else None,
            "resting_share": float(resting),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the flight of a stable orbit that it starts on, or when a drop on a table at rest is over."""
        if self.height is not None:
            return self._acceptance_of_drop(solution, self.height)
        n, e = self.orbit, self.restitution
        on_orbit = self.speed is None and self.start_phase is None
        if not (on_orbit and orbits.existence(e, n) < self.gamma < orbits.stability(e, n)):
            return ()
        flights, phases = self.flights(solution), self.phases(solution)
        flight, phase = (float(values[-1]) if len(values) else None for values in (flights, phases))
        angle = orbits.impact_phase(self.gamma, e, n) / (2.0 * math.pi)
        source = "Holmes (1982): cos(phase) = n pi (1 - e) / ((1 + e) Gamma)"
        return (
            Criterion.near("last flight [table periods]", flight, self.orbit, 1e-6, "the stable orbit of n periods"),
            Criterion.near("phase of the table at the last impact [turns]", phase, angle, 1e-6, source),
        )

    def _acceptance_of_drop(self, solution: Solution, height: float) -> tuple[Criterion, ...]:
        e, fall = self.restitution, math.sqrt(2.0 * height / GRAVITY)
        if self.gamma > 0.0 or e == 1.0 or (1.0 + e) / (1.0 - e) * fall >= self.t_end:
            return ()
        rest = (1.0 + e) / (1.0 - e) * fall
        closings = solution.events.time[solution.events.cause == Cause.CLOSING]
        found = float(closings[0]) if len(closings) else math.nan
        # the bounces that the contact time cuts off
        cut = 2.1 * self.contact_time / (1.0 - e) + 1e-9
        source = "the sum of all flights, (1 + e) / (1 - e) sqrt(2 h / g), less those that rule (33) cuts off"
        return (Criterion("time at rest [s]", found, rest - cut, rest + 1e-9, source),)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the last of the motion."""
        return {"motion": draw.motion(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the bifurcation diagram and the motion on four of its branches."""
        return {"bifurcation": draw.bifurcation(cls(restitution=0.6), run), "motions": draw.branches(cls, run)}
