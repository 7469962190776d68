"""A rigid triangle of three balls that bounces on a vibrating plate, wanders and turns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.bodies import Ball, Compound, Harmonic, Part, Plate
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import figures as draw
from .motion import GRAVITY, NAMES, TrimerMotion, summary

Floats = NDArray[np.float64]

_SAMPLES_PER_PERIOD = 20
_SAMPLES = 40000
"""Largest number of samples of a run, so that it fits into memory; long runs take fewer than 20 a period."""


@final
@dataclass(frozen=True)
class BouncingTrimer(Scenario):
    """Three rigidly joined balls bounce, turn and wander on a vibrating plate.

    The plate moves as A sin(2 pi f t).  The paper below has centimetric steel beads and 25 to 100 Hz; sizes and
    coefficients here are assumed.  The links between the balls have no mass and no contacts.

    References
    ----------
    S. Dorbolo, F. Ludewig, N. Vandewalle, "Bouncing trimer: a random self-propelled particle, chaos and periodical
    motions", New J. Phys. 11 (2009) 033016.
    """

    title: ClassVar[str] = "Bouncing trimer"
    coordinate_units: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("x", "y", "z", "gap"), "m"),
        **dict.fromkeys(("turning", "tilt"), "rad"),
    }
    units: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("drift", "wandering"), "m/s"),
        **dict.fromkeys(("rotation", "turning"), "rad/s"),
        "largest_gap": "m",
        "largest_tilt": "rad",
    }
    words: ClassVar[Mapping[str, tuple[str, ...]]] = {"attractor": NAMES}

    gamma: float = parameter(2.0, doc="peak acceleration of the plate over gravity", minimum=0.0, usual=(0.0, 20.0))
    frequency: float = parameter(50.0, doc="frequency f of the plate", unit="Hz", above=0.0, usual=(1.0, 1e3))
    restitution: float = parameter(
        0.6, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, assumed=True, law="impact"
    )
    friction: float = parameter(
        0.2, doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), assumed=True, law="friction"
    )
    radius: float = parameter(5e-3, doc="radius of the balls", unit="m", above=0.0, usual=(1e-4, 1.0), assumed=True)
    spacing: float = parameter(
        0.02, doc="distance between the centres of two balls", unit="m", above=0.0, usual=(2e-4, 10.0), assumed=True
    )
    density: float = parameter(
        7800.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4), assumed=True
    )
    height: float = parameter(1e-3, doc="height of the lowest ball over the plate at the start", unit="m", minimum=0.0)
    tilt: float = parameter(0.02, doc="tilt of the triangle at the start", unit="rad", minimum=-1.5, maximum=1.5)
    direction: float = parameter(0.3, doc="azimuth of the axis of the tilt", unit="rad", minimum=-7.0, maximum=7.0)
    contact_time: float = parameter(
        2e-5,
        doc="contact time T_c that ends an accumulation",
        unit="s",
        minimum=0.0,
        usual=(1e-12, 1e-2),
        assumed=True,
        law="impact",
    )
    t_end: float = parameter(10.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e4))

    def _check(self) -> None:
        if self.spacing < 2.0 * self.radius:
            raise InvalidInput(
                "BouncingTrimer.spacing",
                f"must be at least the diameter {2.0 * self.radius:g} m of the balls",
                self.spacing,
                "Move the balls apart, or make them smaller.",
            )

    @property
    def sample_interval(self) -> float:
        """Time between samples [s]: the plate period divided by an integer, 20 in short runs, 1 in very long ones."""
        fraction = max(1, min(_SAMPLES_PER_PERIOD, int(_SAMPLES / max(1.0, self.t_end * self.frequency))))
        return 1.0 / (self.frequency * fraction)

    @property
    def amplitude(self) -> float:
        """Amplitude A of the plate [m]."""
        return self.gamma * GRAVITY / (2.0 * math.pi * self.frequency) ** 2

    @property
    def corners(self) -> Floats:
        """The balls' centres in the axes of the body [m], shape [3, 3]."""
        angles = 2.0 * math.pi / 3.0 * np.arange(3)
        distance = self.spacing / math.sqrt(3.0)
        return np.asarray(distance * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(3)]))

    def body(self) -> Compound:
        """Return the three balls as one body."""
        ball = Ball(self.radius, self.density)
        return Compound(tuple(Part(ball, (float(x), float(y), float(z))) for x, y, z in self.corners))

    def build(self) -> System:
        """Return plate and trimer at their start."""
        plate = Plate(Harmonic(self.amplitude, self.frequency))
        trimer = self.body()
        friction = Frictionless() if self.friction == 0.0 else Coulomb(self.friction)
        impact = EnergeticImpact(self.restitution, duration=self.contact_time)
        system = System([plate, trimer], gravity=GRAVITY)
        system.contact(trimer, plate, normal=Unilateral(), friction=friction, impact=impact)
        c, s = math.cos(self.tilt / 2.0), math.sin(self.tilt / 2.0)
        orientation = (c, s * math.cos(self.direction), s * math.sin(self.direction), 0.0)
        lowest = float(np.min(_heights(np.array([orientation]), self.corners)))
        system.place(trimer, position=(0.0, 0.0, self.radius + self.height - lowest), orientation=orientation)
        return system

    def plate(self, t: Floats) -> Floats:
        """Return the height of the plate [m] at times [s]."""
        return np.asarray(self.amplitude * np.sin(2.0 * math.pi * self.frequency * t))

    def centres(self, q: Floats) -> Floats:
        """Return the balls' centres [m] in one state, shape [3, 3]."""
        a, vector = q[3], q[4:7]
        turned = self.corners + 2.0 * np.cross(vector, np.cross(vector, self.corners) + a * self.corners)
        return np.asarray(q[:3] + turned)

    def gaps(self, t: Floats, q: Floats) -> Floats:
        """Return the three gaps [m] of states [n, 7] at times [n], shape [n, 3]."""
        return np.asarray(q[:, 2:3] + _heights(q[:, 3:], self.corners) - self.radius - self.plate(t)[:, None])

    def motion(self, solution: Solution) -> TrimerMotion:
        """Return gaps, path, turning and tilt over the samples."""
        q = solution.q
        up = _third_row(q[:, 3:])
        turning = np.sum(up * solution.u[:, 3:], axis=1)
        tilt = np.arctan2(np.hypot(up[:, 0], up[:, 1]), up[:, 2])
        return TrimerMotion(solution.t, 1.0 / self.frequency, self.gaps(solution.t, q), q[:, :2], turning, tilt)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y, z [m], turning [rad/s], tilt [rad] and the three gaps [m] over the samples."""
        motion = self.motion(solution)
        gaps = {f"gap_{i + 1}": gap for i, gap in enumerate(motion.gaps.T)}
        places = {name: solution.q[:, i] for i, name in enumerate("xyz")}
        return places | {"turning": motion.turning, "tilt": motion.tilt} | gaps

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the attractor and its numbers over the second half of the run: see :mod:`.motion`."""
        return {**summary(self.motion(solution)), "impacts": solution.counters.impacts}

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: the gap at the first impact, and the largest ratio of tangential to normal impulse."""
        events = solution.events
        impacts = np.flatnonzero(events.cause == Cause.IMPACT)
        gap, ratio = math.nan, 0.0
        if len(impacts) > 0:
            t = float(events.time[impacts[0]])
            gap = self.height - 0.5 * GRAVITY * t * t - float(self.plate(np.array([t]))[0])
        for i in impacts:
            normal, *across = events.impulse[i].T
            pressed = normal > 0.0
            ratio = max(ratio, float(np.max(np.hypot(*across)[pressed] / normal[pressed], initial=0.0)))
        name, bound = "largest ratio of tangential to normal impulse", self.friction * (1.0 + 1e-6) + 1e-9
        return (
            Criterion.near("gap of the lowest ball at the first impact [m]", gap, 0.0, 1e-9, "free fall on a sine"),
            Criterion(name, ratio, 0.0, bound, "Coulomb: no more than mu"),
        )

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return path and heading, and the gaps over the last plate periods."""
        return {"path": draw.path(self, solution), "gaps": draw.last_bounces(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return figures: gaps and speeds over Gamma at 25, 50 and 100 Hz; path and gaps of a run at Gamma = 3.

        Gamma is the peak acceleration of the plate over gravity.
        """
        gammas = np.round(np.arange(0.9, 6.01, 0.3), 6).tolist()
        one = cls(gamma=3.0)
        regimes = draw.regimes(draw.survey(cls(), gammas, (25.0, 50.0, 100.0), 150, run))
        return {"regimes": regimes, **one.figures(run(one))}


def _third_row(quaternions: Floats) -> Floats:
    """Return the vertical in body axes, shape [n, 3]."""
    a, b, c, d = quaternions.T
    scale = a * a + b * b + c * c + d * d
    row = np.column_stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d])
    return np.asarray(row / scale[:, None])


def _heights(quaternions: Floats, corners: Floats) -> Floats:
    """Return the heights of the corners above the mass centre [m], shape [n, 3]."""
    return np.asarray(_third_row(quaternions) @ corners.T)
