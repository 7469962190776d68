"""The paper's scenario: a dumbbell on a vibrating plate."""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import Dumbbell, Harmonic, Plate
from laws import Coulomb, Unilateral, closing_time, effective_modulus
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, ImpactLaw, Scenario
from nonsmooth.parameters import UnusualValue, parameter, rules
from nonsmooth.runs.simulate import Progress
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from scenarios.dumbbell import attractor, coordinates
from scenarios.dumbbell.acceptance import criteria
from scenarios.dumbbell.impact import impact_law
from scenarios.dumbbell.modes import GRAVITY, defaults

Floats = NDArray[np.float64]
Part = TypeVar("Part")

_SAMPLES_PER_PERIOD = 40
_FEWEST_PER_PERIOD = 4
_SAMPLES = 20000

_GRID = 20001
"""Points of a plate period, among which the largest gap is found to 1e-9 of it."""


@final
@dataclass(frozen=True)
class DumbbellScenario(Scenario):
    """A dumbbell on a plate that vibrates as z_p = A_z sin(2 pi f t + phi_0), section 5 of the paper.

    The paper prints 2 g / f as the start of the jump; that is a flight of four plate periods.  Period 1 needs
    g / (2 f), which ``mode=jump`` takes; the printed one is ``vertical_velocity=0.7848`` at 25 Hz.
    """

    title: ClassVar[str] = "Dumbbell on a vibrating plate"
    coordinate_units: ClassVar[Mapping[str, str]] = coordinates.UNITS
    units: ClassVar[Mapping[str, str]] = {
        "period": "plate periods",
        "drift_velocity": "m/s",
        "max_gap": "m",
        "beta_range": "rad",
    }
    words: ClassVar[Mapping[str, tuple[str, ...]]] = {"attractor": attractor.NAMES}

    mode: str = parameter(
        "drift", doc="the start, by the motion it leads to", unit="", choices=("drift", "jump", "flutter", "free")
    )
    t_end: float = parameter(4.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e5))
    radius: float = parameter(
        4.76e-3, doc="radius r of the balls", unit="m", above=0.0, usual=(1e-4, 1.0), assumed=True
    )
    aspect_ratio: float | None = parameter(
        None, doc="aspect ratio A_r = (l + 2 r) / (2 r); 5.7 in flutter, else 3.9", minimum=2.0, usual=(2.0, 100.0)
    )
    rod_mass_fraction: float = parameter(
        0.15, doc="share of the rod in the total mass", minimum=0.0, maximum=0.99, assumed=True
    )
    density: float = parameter(
        7800.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4), assumed=True
    )
    restitution: float | None = parameter(
        None,
        doc="coefficient of restitution e; 0.8 in flutter, else 0.65",
        minimum=0.0,
        maximum=1.0,
        assumed=True,
        law="impact",
    )
    friction: float = parameter(
        0.2, doc="kinetic friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), assumed=True, law="friction"
    )
    static_friction: float | None = parameter(
        None,
        doc="static friction coefficient mu_s, by default mu",
        minimum=0.0,
        usual=(0.01, 2.0),
        assumed=True,
        law="friction",
    )
    gamma: float = parameter(
        0.9, doc="intensity Gamma = A_z (2 pi f)^2 / g of the vibration", minimum=0.0, usual=(0.01, 50.0)
    )
    frequency: float = parameter(25.0, doc="frequency f of the vibration", unit="Hz", above=0.0, usual=(0.1, 1e4))
    phase: float | None = parameter(
        None, doc="phase phi_0 of the vibration; pi/6 in flutter, else 0", unit="rad", usual=(0.0, 2.0 * math.pi)
    )
    beta0: float | None = parameter(
        None,
        doc="tilt beta(0); 0 in jump, 11 degrees in flutter, else 10 degrees",
        unit="rad",
        minimum=-1.57,
        maximum=1.57,
        usual=(1e-12, 0.8),
    )
    transverse_velocity: float = parameter(
        0.0, doc="velocity x1'(0) across the rod; 1 in the paper's 3D cases", unit="m/s", usual=(1e-6, 10.0)
    )
    vertical_velocity: float | None = parameter(
        None,
        doc="velocity z1'(0) of ball 1; g/(2 f) in jump, 0.4 in flutter, else 0",
        unit="m/s",
        usual=(1e-6, 10.0),
    )
    pitch_rate: float | None = parameter(
        None, doc="rate beta'(0) of the tilt; -9.6 in flutter, else 0", unit="rad/s", usual=(1e-6, 1e3)
    )
    height: float = parameter(
        0.0, doc="gap between ball 1 and the plate at t = 0", unit="m", minimum=0.0, usual=(1e-7, 10.0)
    )
    young_modulus: float = parameter(
        210e9, doc="Young's modulus E of balls and plate", unit="Pa", above=0.0, usual=(1e5, 2e12), assumed=True
    )
    poisson_ratio: float = parameter(
        0.3, doc="Poisson's ratio nu of balls and plate", minimum=0.0, maximum=0.5, assumed=True
    )
    contact_time: float | None = parameter(
        None,
        doc="contact time T_c of the accumulation rule (33), by default that of Hertz",
        unit="s",
        minimum=0.0,
        usual=(1e-12, 1e-2),
        law="impact",
    )
    impact: str = parameter("energetic", doc="impact law, by its installed name", unit="", law="impact")

    def _check(self) -> None:
        used = self.resolved()
        if used["static_friction"] < used["friction"]:
            raise InvalidInput(
                "DumbbellScenario.static_friction",
                f"must be at least the kinetic coefficient {self.friction:g}",
                self.static_friction,
                "Raise it, or leave it out to take the kinetic one.",
            )
        gap = self.height + self.centre_distance * math.sin(used["beta0"])
        if gap < -1e-9:
            raise InvalidInput(
                "DumbbellScenario.beta0",
                "must not put ball 2 into the plate",
                used["beta0"],
                f"Its gap would be {gap:.3g} m: raise height by as much, or take beta0 [rad] >= 0.",
            )
        self._quietly(self._impact_law)

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters with the values that the run uses."""
        return self._used

    @functools.cached_property
    def _used(self) -> Mapping[str, Any]:
        left_out = defaults(self.mode, self.frequency, self.friction)
        left_out["contact_time"] = self._hertz_time(self.aspect_ratio or left_out["aspect_ratio"])
        given = {name: getattr(self, name) for name in rules(type(self))}
        return {name: left_out[name] if value is None else value for name, value in given.items()}

    @property
    def sample_interval(self) -> float:
        """Time between samples [s], a whole fraction of the plate period: 1/40, down to 1/4 in long runs."""
        fraction = int(_SAMPLES / max(1.0, self.t_end * self.frequency))
        return 1.0 / (self.frequency * max(_FEWEST_PER_PERIOD, min(_SAMPLES_PER_PERIOD, fraction)))

    @property
    def centre_distance(self) -> float:
        """Distance l of the ball centres [m]."""
        return self._quietly(self._dumbbell).centre_distance

    @property
    def amplitude(self) -> float:
        """Amplitude A_z of the plate [m]."""
        return self.gamma * GRAVITY / (2.0 * math.pi * self.frequency) ** 2

    def plate_height(self, t: Floats) -> Floats:
        """Return the plate's position z_p [m] at times [s], Eq. (1)."""
        height: Floats = self.amplitude * np.sin(self._angle(t))
        return height

    def plate_velocity(self, t: Floats) -> Floats:
        """Return the plate's velocity [m/s] at times [s]."""
        velocity: Floats = self.amplitude * 2.0 * math.pi * self.frequency * np.cos(self._angle(t))
        return velocity

    def _angle(self, t: Floats) -> Floats:
        return 2.0 * math.pi * self.frequency * t + float(self.resolved()["phase"])

    def build(self) -> System:
        """Return dumbbell and plate at their start."""
        return self._quietly(self._build)

    def _build(self) -> System:
        used = self.resolved()
        plate = Plate(Harmonic(self.amplitude, self.frequency, used["phase"]))
        dumbbell = self._dumbbell()
        system = System([plate, dumbbell], gravity=GRAVITY)
        system.contact(
            dumbbell,
            plate,
            normal=Unilateral(),
            friction=Coulomb(self.friction, used["static_friction"]),
            impact=self._impact_law(),
        )
        z1 = self.radius + self.height + float(self.plate_height(np.zeros(1))[0])
        q = np.array([0.0, 0.0, z1, 0.0, used["beta0"], 0.0])
        u = np.array([self.transverse_velocity, 0.0, used["vertical_velocity"], 0.0, used["pitch_rate"], 0.0])
        system.place(dumbbell, **coordinates.to_state(q, u, dumbbell.centre_distance))
        return system

    def _dumbbell(self) -> Dumbbell:
        return self._dumbbell_of(self.resolved()["aspect_ratio"])

    def _dumbbell_of(self, aspect_ratio: float) -> Dumbbell:
        return Dumbbell(
            self.radius, aspect_ratio, self.density, self.rod_mass_fraction, self.young_modulus, self.poisson_ratio
        )

    def _hertz_time(self, aspect_ratio: float) -> float:
        """Return how long the slightest impact of a ball lasts under gravity [s], the dumbbell being level."""
        dumbbell = self._quietly(lambda: self._dumbbell_of(aspect_ratio))
        material = dumbbell.young_modulus, dumbbell.poisson_ratio
        modulus = effective_modulus(material, material)
        return closing_time(dumbbell.level_mass, dumbbell.radius, modulus, GRAVITY)

    def _impact_law(self) -> ImpactLaw:
        used = self.resolved()
        offered = {"restitution": used["restitution"], "duration": used["contact_time"]}
        return impact_law(self.impact, offered, {"restitution"} if self.restitution is not None else set())

    def _quietly(self, make: Callable[[], Part]) -> Part:
        """Build a part without repeating the warnings that the scenario's own parameters gave."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UnusualValue)
            return make()

    def paper_motion(self, solution: Solution, since: float = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return times [n], paper coordinates and rates [n, 6] of the samples from a time on [s], and of the end."""
        t, q, u = self._samples(solution)
        first = int(np.searchsorted(t, since))
        return t[first:], *coordinates.from_state(t[first:], q[first:], u[first:], self.centre_distance)

    def _samples(self, solution: Solution) -> tuple[Floats, Floats, Floats]:
        """Return times, coordinates and velocities of the samples and, if it is later, of the end."""
        t, q, u = solution.t, solution.q, solution.u
        if len(t) == 0 or solution.t_end > t[-1] + 1e-9 / self.frequency:
            t = np.append(t, solution.t_end)
            q, u = np.vstack([q, solution.q_end]), np.vstack([u, solution.u_end])
        return t, q, u

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x1 ... gamma [m, rad] and their rates (x1_rate ...) over the samples."""
        _, q, u = self.paper_motion(solution)
        n = len(solution.t)
        places = {name: q[:n, i] for i, name in enumerate(coordinates.NAMES)}
        return places | {f"{name}_rate": u[:n, i] for i, name in enumerate(coordinates.NAMES)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u} at the end: (x1, y1, z1, theta, beta, gamma) [m, rad] and their rates."""
        _, q, u = self.paper_motion(solution)
        return {"q": q[-1].tolist(), "u": u[-1].tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return attractor, period [plate periods], drift_velocity [m/s], max_gap [m], beta_range [rad]."""
        return attractor.summary(*self.settled(solution))

    def settled(self, solution: Solution) -> tuple[attractor.Motion, int]:
        """Return the settled part of a run, and how many plate periods it has."""
        t, *_ = self._samples(solution)
        cycles, start = attractor.settled(t, 1.0 / self.frequency)
        return self.motion(solution, start - 1e-9 / self.frequency), cycles

    def motion(self, solution: Solution, since: float = 0.0) -> attractor.Motion:
        """Return gaps, tilt and path of a run from a time on [s], for its classification."""
        t, q, u = self.paper_motion(solution, since)
        between = self.centre_distance
        beta, beta_rate = q[:, 4], u[:, 4]
        events = solution.events
        first = q[:, 2] - self.radius - self.plate_height(t)
        first_rate = u[:, 2] - self.plate_velocity(t)
        reach = between / 2.0 * np.cos(beta)
        length = max(self.amplitude, 1e-3 * self.radius)
        return attractor.Motion(
            t,
            np.column_stack([first, first + between * np.sin(beta)]),
            np.column_stack([first_rate, first_rate + between * np.cos(beta) * beta_rate]),
            beta,
            coordinates.tilt(events.q),
            np.column_stack([q[:, 0] - reach * np.sin(q[:, 3]), q[:, 1] + reach * np.cos(q[:, 3])]),
            events,
            1.0 / self.frequency,
            length,
            2.0 * math.pi * self.frequency * length,
        )

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return what the paper and the orbits of a ball say of a settled run of this mode."""
        return criteria(self.mode, self._is_nominal(), self.summarise(solution), solution, self.orbit_gap())

    def _is_nominal(self) -> bool:
        free = ("mode", "t_end", "transverse_velocity")
        return all(
            getattr(self, name) == field.default for name, (field, _) in rules(type(self)).items() if name not in free
        )

    def orbit_gap(self) -> float:
        """Return the largest gap [m] of a ball that flies one plate period from impact to impact."""
        used, f = self.resolved(), self.frequency
        e = used["restitution"]
        phase = math.acos(min(1.0, math.pi * (1.0 - e) / ((1.0 + e) * self.gamma))) if self.gamma > 0.0 else 0.0
        t = np.linspace(0.0, 1.0 / f, _GRID)
        plate = self.amplitude * (np.sin(phase + 2.0 * math.pi * f * t) - math.sin(phase))
        return float(np.max(GRAVITY / (2.0 * f) * t - 0.5 * GRAVITY * t**2 - plate))

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the published figures of this mode, drawn from this run."""
        from scenarios.dumbbell.figures.gallery import of_run

        return of_run(self, solution)

    @classmethod
    def gallery(cls, progress: Progress | None) -> Mapping[str, Any]:
        """Return Figs. 2 to 11 of the paper and the comparison of impact laws."""
        from scenarios.dumbbell.figures.gallery import all_figures

        return all_figures(cls, progress)
