"""A slider-crank mechanism with clearance: the slider rattles in its guide."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Coordinate, GeneralisedBody, Plate, Point, Rest, TurningFrame
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, NewtonImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import mechanism

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_LAWS = {"newton": NewtonImpact, "energetic": EnergeticImpact}


@final
@dataclass(frozen=True)
class SliderCrank(Scenario):
    """A slider-crank with clearance: the slider rattles and slides in a guide that is too wide.

    The crank turns freely.  At the start, crank and rod are in line, and the slider is level and in the middle of its
    guide.  So the slider first hits with two corners at once.

    References
    ----------
    P. Flores, R. Leine, C. Glocker, "Modeling and analysis of planar rigid multibody systems with translational
    clearance joints based on the non-smooth dynamics approach", Multibody System Dynamics 23 (2010) 165-190.
    """

    title: ClassVar[str] = "Slider-crank mechanism with clearance"
    samples: ClassVar[int] = 4000
    coordinate_units: ClassVar[Mapping[str, str]] = {"theta": "rad", "height": "m"}
    units: ClassVar[Mapping[str, str]] = {"first_impact": "s", "crank_rate": "rad/s"}

    crank_length: float = parameter(0.153, doc="length l_1 of the crank", unit="m", above=0.0, usual=(1e-3, 10.0))
    rod_length: float = parameter(0.306, doc="length l_2 of the rod", unit="m", above=0.0, usual=(1e-3, 10.0))
    slider_length: float = parameter(0.1, doc="length 2 a of the slider", unit="m", above=0.0, usual=(1e-3, 10.0))
    slider_height: float = parameter(0.05, doc="height 2 b of the slider", unit="m", above=0.0, usual=(1e-3, 10.0))
    clearance: float = parameter(1e-3, doc="clearance c on either side", unit="m", above=0.0, usual=(1e-6, 0.1))
    crank_mass: float = parameter(0.038, doc="mass of the crank", unit="kg", above=0.0)
    rod_mass: float = parameter(0.038, doc="mass of the rod", unit="kg", above=0.0)
    slider_mass: float = parameter(0.076, doc="mass of the slider", unit="kg", above=0.0)
    crank_inertia: float = parameter(7.4e-5, doc="central moment of inertia of the crank", unit="kg m^2", above=0.0)
    rod_inertia: float = parameter(5.9e-4, doc="central moment of inertia of the rod", unit="kg m^2", above=0.0)
    slider_inertia: float = parameter(2.7e-6, doc="central moment of inertia of the slider", unit="kg m^2", above=0.0)
    crank_rate: float = parameter(150.0, doc="angular velocity of the crank at the start", unit="rad/s")
    rod_rate: float = parameter(-75.0, doc="angular velocity of the rod at the start", unit="rad/s")
    restitution: float = parameter(0.4, doc="restitution of the corners", minimum=0.0, maximum=1.0, law="impact")
    friction: float = parameter(0.01, doc="friction coefficient mu", minimum=0.0, usual=(0.001, 2.0), law="friction")
    law: str = parameter("newton", doc="impact law", unit="", choices=("newton", "energetic"), law="impact")
    t_end: float = parameter(0.1, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def build(self) -> System:
        """Return mechanism and guide at their start."""
        x, z = 0.5 * self.slider_length, 0.5 * self.slider_height
        corners = tuple(Point(i * x, 0.0, j * z) for j in (-1.0, 1.0) for i in (-1.0, 1.0))
        rates = {"theta_1": self.crank_rate, "theta_2": self.rod_rate, "theta_3": 0.0}
        body = GeneralisedBody(
            coordinates=tuple(
                Coordinate(name, "rad", 0.0, rate, scale=0.1, rate_scale=10.0) for name, rate in rates.items()
            ),
            mass=mechanism.mass,
            force=mechanism.force,
            potential=mechanism.potential,
            drawn=mechanism.links,
            moving_frames=(TurningFrame(mechanism.slider, mechanism.slider_jacobian, mechanism.slider_bias, corners),),
            constants=self.numbers(),
        )
        half = z + self.clearance
        floor = Plate(Rest(position=(0.0, 0.0, -half)))
        ceiling = Plate(Rest(position=(0.0, 0.0, half), orientation=(0.0, 1.0, 0.0, 0.0)))
        system = System([body, floor, ceiling], gravity=_GRAVITY)
        friction, impact = Coulomb(self.friction), _LAWS[self.law](self.restitution)
        for side, near in ((floor, (0, 1)), (ceiling, (2, 3))):
            system.contact(body, side, normal=Unilateral(), friction=friction, impact=impact, shapes=(near, None))
        return system

    def height(self, solution: Solution) -> Floats:
        """Return the height of the slider's centre above the middle of its guide [m], shape [n_samples]."""
        return np.asarray(self.crank_length * np.sin(solution.q[:, 0]) + self.rod_length * np.sin(solution.q[:, 1]))

    def first_impact(self, solution: Solution) -> float:
        """Return the time of the first impact [s]; nan without one."""
        times = solution.events.time[solution.events.cause == Cause.IMPACT]
        return float(times[0]) if len(times) > 0 else math.nan

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return the three angles [rad] and the slider's height [m] over the samples."""
        angles = {f"theta_{i + 1}": solution.q[:, i] for i in range(3)}
        return {**angles, "height": self.height(solution)}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the time of the first impact, the number of impacts, turns of the crank and its rate at the end."""
        return {
            "first_impact": self.first_impact(solution),
            "impacts": solution.counters.impacts,
            "turns": float(solution.q_end[0]) / (2.0 * math.pi),
            "crank_rate": float(solution.u_end[0]),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: number of corners that the first impact hits; with Newton's law, velocities after it."""
        events = solution.events
        first = np.flatnonzero(events.cause == Cause.IMPACT)[:1]
        hit, ratio, turning = (math.nan,) * 3
        for i in first:
            hit = float(np.sum(events.impulse[i, :, 0] > 0.0))
            q, before, after = events.q[i], events.u_before[i], events.u_after[i]
            row = np.array([self.crank_length * math.cos(q[0]), self.rod_length * math.cos(q[1]), 0.0])
            ratio, turning = -float(row @ after) / float(row @ before), float(after[2])
        source = "Flores, Leine, Glocker (2010): the slider is level until it hits"
        found = [Criterion.near("corners that the first impact hits", hit, 2.0, 0.0, source)]
        if self.law == "newton":
            words = "Newton's law at both corners"
            found.append(Criterion.near("speed of the slider after over before", ratio, self.restitution, 1e-6, words))
            size = 1e-6 * abs(self.crank_rate)
            found.append(Criterion.near("turning of the slider after it [rad/s]", turning, 0.0, size, words))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the slider's height in its guide."""
        found = self.summarise(solution)
        title = f"The slider strikes its guide {found['impacts']} times in {found['turns']:.3g} turns of the crank"
        return {"height": _heights({self.law: (self, solution)}, title)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the slider's height with either impact law."""
        by_law = {law: cls(law=law) for law in _LAWS}
        runs = {law: (one, run(one)) for law, one in by_law.items()}
        return {"heights": _heights(runs, "The slider crosses its clearance, rattles at the guide, and lets go again")}


def _heights(runs: Mapping[str, tuple[SliderCrank, Solution]], title: str) -> Figure:
    """Draw the slider's height over the turns of the crank, in a panel for each impact law; the guide is grey."""
    figure, axes = charts.panels(len(runs), 1, title, (7.2, 1.2 + 2.1 * len(runs)), sharex=True)
    for ax, (law, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        c = 1e3 * scenario.clearance
        heights = {"": (solution.q[:, 0] / (2.0 * np.pi), 1e3 * scenario.height(solution))}
        charts.histories({"height of the slider [mm]": heights}, xlabel="", axes=[ax])
        for low, high in ((c, 1.15 * c), (-1.15 * c, -c)):
            ax.axhspan(low, high, color="0.8", linewidth=0.0)
        ax.set_ylim(-1.15 * c, 1.15 * c)
        ax.set_title(f"impact law {law!r}", fontsize=9, loc="right")
    axes[-1].set_xlabel("turns of the crank")
    return figure
