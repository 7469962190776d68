"""The paper's scenario: a dumbbell on a vibrating plate."""

from __future__ import annotations

import contextlib
import functools
import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Dumbbell, Harmonic, Plate
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, ImpactLaw, Run, Scenario
from nonsmooth.laws import Coulomb, Unilateral, closing_time, effective_modulus
from nonsmooth.parameters import UnusualValue, parameter, rules
from nonsmooth.plugins.file import find
from nonsmooth.solution.modes import mode_shares
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import attractor, coordinates, figures

Floats = NDArray[np.float64]

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]."""

_COEFFICIENT: Mapping[str, Any] = {"minimum": 0.0, "usual": (0.01, 2.0), "assumed": True, "law": "friction"}
_DEFAULTS = {"aspect_ratio": 3.9, "restitution": 0.65, "phase": 0.0, "vertical_velocity": 0.0, "pitch_rate": 0.0}
_STARTS: Mapping[str, dict[str, float]] = {
    "drift": {"beta0": math.radians(10.0)},
    "jump": {"beta0": 0.0},
    "flutter": {
        "aspect_ratio": 5.7,
        "restitution": 0.8,
        "phase": math.pi / 6.0,
        "beta0": math.radians(11.0),
        "vertical_velocity": 0.4,
        "pitch_rate": -9.6,
    },
    "free": {"beta0": math.radians(10.0)},
}
"""Mode -> start of its motion in the dumbbell's paper, section 5.1, as parameters of the scenario [SI units, rad].

The vertical velocity of the jump is not listed, because it depends on the frequency.
"""

_PERIODS: Mapping[str, float] = {"drift": 1.0, "jump": 1.0, "flutter": 2.0}
"""Plate periods after which the paper's motions repeat, section 5."""
_REST_OF_BALL_1 = "{01,00,01}"
"""The paper's word of the mode in which ball 1 is on the plate and ball 2 in the air."""


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Build parts without repeating the warnings that the scenario's own parameters gave."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualValue)
        yield


@final
@dataclass(frozen=True)
class DumbbellScenario(Scenario):
    """A dumbbell on a vibrating plate drifts, jumps or flutters: the system of the paper.

    The plate moves as z_p = A_z sin(2 pi f t + phi_0).

    ``mode=jump`` starts with the vertical velocity g / (2 f), so that the first flight takes one plate period.  The
    paper prints 2 g / f, which gives a flight of four plate periods.  For this velocity set
    ``vertical_velocity=0.7848`` [m/s], at 25 Hz.
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
    friction: float = parameter(0.2, doc="kinetic friction coefficient mu", **_COEFFICIENT)
    static_friction: float | None = parameter(
        None, doc="static friction coefficient mu_s, by default mu", **_COEFFICIENT
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
        used = self._used
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
        self._impact_law()

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters; values that were not given follow from the mode and from the other parameters."""
        return self._used

    @functools.cached_property
    def _used(self) -> Mapping[str, Any]:
        left_out = _DEFAULTS | _STARTS[self.mode] | {"static_friction": self.friction}
        if self.mode == "jump":
            left_out["vertical_velocity"] = GRAVITY / (2.0 * self.frequency)
        left_out["contact_time"] = self._hertz_time(self.aspect_ratio or left_out["aspect_ratio"])
        return {name: left_out[name] if value is None else value for name, value in super().resolved().items()}

    def _hertz_time(self, aspect_ratio: float) -> float:
        """Return the contact time T_c [s] of a ball of the level dumbbell, by Hertz's law and gravity.

        An impact at the speed g T_c, which gravity gives in the time T_c, lasts just T_c.
        """
        body, material = self._dumbbell(aspect_ratio), (self.young_modulus, self.poisson_ratio)
        return closing_time(body.level_mass, self.radius, effective_modulus(material, material), GRAVITY)

    @property
    def sample_interval(self) -> float:
        """Time between samples [s], a whole fraction of the plate period: 1/40, down to 1/4 in long runs."""
        fraction = int(20000 / max(1.0, self.t_end * self.frequency))
        return 1.0 / (self.frequency * max(4, min(40, fraction)))

    @property
    def centre_distance(self) -> float:
        """Distance l of the ball centres [m]."""
        return self._dumbbell(self._used["aspect_ratio"]).centre_distance

    @property
    def amplitude(self) -> float:
        """Amplitude A_z of the plate [m]."""
        return self.gamma * GRAVITY / (2.0 * math.pi * self.frequency) ** 2

    def plate_height(self, t: Floats) -> Floats:
        """Return the plate's position z_p [m] at times [s], Eq. (1)."""
        return np.asarray(self.amplitude * np.sin(self._angle(t)))

    def plate_velocity(self, t: Floats) -> Floats:
        """Return the plate's velocity [m/s] at times [s]."""
        return np.asarray(self.amplitude * 2.0 * math.pi * self.frequency * np.cos(self._angle(t)))

    def _angle(self, t: Floats) -> Floats:
        return 2.0 * math.pi * self.frequency * t + float(self._used["phase"])

    @_quiet()
    def build(self) -> System:
        """Return dumbbell and plate at their start."""
        used = self._used
        plate = Plate(Harmonic(self.amplitude, self.frequency, used["phase"]))
        dumbbell = self._dumbbell(used["aspect_ratio"])
        system = System([plate, dumbbell], gravity=GRAVITY)
        z1 = self.radius + self.height + float(self.plate_height(np.zeros(1))[0])
        q = np.array([0.0, 0.0, z1, 0.0, used["beta0"], 0.0])
        u = np.array([self.transverse_velocity, 0.0, used["vertical_velocity"], 0.0, used["pitch_rate"], 0.0])
        friction, impact = Coulomb(self.friction, used["static_friction"]), self._impact_law()
        system.contact(dumbbell, plate, normal=Unilateral(), friction=friction, impact=impact)
        system.place(dumbbell, **coordinates.to_state(q, u, dumbbell.centre_distance))
        return system

    @_quiet()
    def _dumbbell(self, aspect_ratio: float) -> Dumbbell:
        return Dumbbell(
            self.radius, aspect_ratio, self.density, self.rod_mass_fraction, self.young_modulus, self.poisson_ratio
        )

    @_quiet()
    def _impact_law(self) -> ImpactLaw:
        """Return the impact law that ``impact`` names, with the scenario's values of the parameters that it has."""
        owner, used = find("impact law", "laws", ImpactLaw, self.impact), self._used
        if self.restitution is not None and "restitution" not in rules(owner):
            rule = f"must not be given with impact={self.impact}, which does not have it"
            raise InvalidInput("DumbbellScenario.restitution", rule, self.restitution, "Leave it out.")
        offered = {"restitution": used["restitution"], "duration": used["contact_time"]}
        law: ImpactLaw = owner(**{name: value for name, value in offered.items() if name in rules(owner)})
        return law

    def motion(self, solution: Solution, since: float = 0.0) -> coordinates.DumbbellMotion:
        """Return the motion in the coordinates of the dumbbell's paper, at samples from ``since`` [s] to the end."""
        t, q, u = solution.t, solution.q, solution.u
        if len(t) == 0 or solution.t_end > t[-1] + 1e-9 / self.frequency:
            t = np.append(t, solution.t_end)
            q, u = np.vstack([q, solution.q_end]), np.vstack([u, solution.u_end])
        first = int(np.searchsorted(t, since))
        return coordinates.DumbbellMotion.of(self, t[first:], q[first:], u[first:])

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x1 ... gamma [m, rad] and their rates (x1_rate ...) over the samples."""
        motion, n = self.motion(solution), len(solution.t)
        return dict(zip(coordinates.UNITS, np.hstack([motion.q[:n], motion.u[:n]]).T, strict=True))

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u} at the end: (x1, y1, z1, theta, beta, gamma) [m, rad] and their rates."""
        motion = self.motion(solution)
        return {"q": motion.q[-1].tolist(), "u": motion.u[-1].tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return attractor, period [plate periods], drift_velocity [m/s], max_gap [m], beta_range [rad]."""
        return attractor.Settled.of(self, solution).summary()

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria for a run with the start of its mode: its period [plate periods] and a second quantity.

        It is the part of the time with ball 1 alone on the plate for drift, the largest gaps [m] for jump, and the
        tilts [rad] for flutter.
        """
        if self.mode not in _PERIODS or not self._is_nominal():
            return ()
        paper, summary = "the paper, section 5", self.summarise(solution)
        period = summary["period"] if summary["attractor"] == self.mode else None
        name = f"plate periods after which the {self.mode} repeats"
        found = [Criterion.near(name, period, _PERIODS[self.mode], 0.0, paper)]
        if self.mode == "drift":
            part = float(mode_shares(solution).get(_REST_OF_BALL_1, 0.0))
            source = f"{paper}: ball 1 rests most of the cycle"
            found.append(Criterion(f"share of time in {_REST_OF_BALL_1}", part, 0.5, 1.0, source))
        if self.mode == "jump":
            orbit, source = self._orbit_gap(), "both balls on the orbit of a bouncing ball, n = 1"
            for ball, gap in enumerate(summary["max_gap"], 1):
                found.append(Criterion.near(f"largest gap of ball {ball} [m]", gap, orbit, 1e-3 * orbit, source))
        if self.mode == "flutter":
            source = "the compliant limit with the same parameters: +-10.4 degrees"
            for word, sign, value in zip(("least", "largest"), (-1.0, 1.0), summary["beta_range"], strict=True):
                tilt = sign * math.radians(10.4)
                found.append(Criterion.near(f"{word} tilt [rad]", value, tilt, math.radians(0.2), source))
        return tuple(found)

    def _is_nominal(self) -> bool:
        """Return True if all parameters but mode, end time and transverse velocity have their default values."""
        declared = rules(type(self)).items()
        changed = {name for name, (field, _) in declared if getattr(self, name) != field.default}
        return changed <= {"mode", "t_end", "transverse_velocity"}

    def _orbit_gap(self) -> float:
        """Return the largest gap [m] of a ball that flies one plate period from impact to impact."""
        e, f = self._used["restitution"], self.frequency
        phase = math.acos(min(1.0, math.pi * (1.0 - e) / ((1.0 + e) * self.gamma))) if self.gamma > 0.0 else 0.0
        # the largest of 20 001 gaps is the largest gap of the orbit, with a relative error of 1e-9
        t = np.linspace(0.0, 1.0 / f, 20001)
        plate = self.amplitude * (np.sin(phase + 2.0 * math.pi * f * t) - math.sin(phase))
        return float(np.max(GRAVITY / (2.0 * f) * t - 0.5 * GRAVITY * t**2 - plate))

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the published figures of this mode, drawn from this run."""
        return figures.of_run(self, solution)

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return Figs. 2 to 11 of the paper."""
        return figures.of_paper(cls, run)
