"""The woodpecker toy: one fall, two jams and a peck per cycle."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Coordinate, GeneralisedBody, Plate, Point, PointFrame, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, NewtonImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from . import toy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_LAWS = {"newton": NewtonImpact, "energetic": EnergeticImpact}
_LENGTH: Mapping[str, Any] = {"unit": "m", "above": 0.0}
_BEAK = 0
"""Index of the beak's contact."""
_SETTLED = 2.0
"""Time after which the cycles are close to the limit cycle [s]."""
_SHOWN = 3
"""Number of cycles that a figure shows."""


@final
@dataclass(frozen=True)
class Woodpecker(Scenario):
    """The woodpecker toy: a bird on a spring pecks its way down a pole (Glocker's model).

    In the published start the sleeve overlaps the pole by 0.9 micrometres, because numbers were rounded; here it just
    touches.

    References
    ----------
    C. Glocker, *Dynamik von Starrkoerpersystemen mit Reibung und Stoessen*, VDI-Verlag (1995).
    C. Glocker, C. Studer, "Formulation and preparation for numerical evaluation of linear complementarity systems in
    dynamics", Multibody System Dynamics 13 (2005) 447-463.
    """

    title: ClassVar[str] = "Woodpecker toy"
    coordinate_units: ClassVar[Mapping[str, str]] = {"y": "m", "phi_m": "rad", "phi_s": "rad"}
    units: ClassVar[Mapping[str, str]] = {"cycle_duration": "s", "cycle_descent": "m"}

    pole_radius: float = parameter(2.5e-3, doc="radius r_O of the pole", usual=(1e-4, 1.0), **_LENGTH)
    sleeve_radius: float = parameter(3.1e-3, doc="inner radius r_M of the sleeve", usual=(1e-4, 1.0), **_LENGTH)
    sleeve_height: float = parameter(5.8e-3, doc="half height h_M of the sleeve", **_LENGTH)
    sleeve_arm: float = parameter(1e-2, doc="distance l_M of the spring from the pole's axis", **_LENGTH)
    bird_arm: float = parameter(1.5e-2, doc="distance l_G of the bird's mass centre from the spring", **_LENGTH)
    beak_height: float = parameter(2e-2, doc="height h_S of the beak over the bird's mass centre", **_LENGTH)
    beak_arm: float = parameter(2.01e-2, doc="distance l_S of the beak from the bird's mass centre", **_LENGTH)
    sleeve_mass: float = parameter(3e-4, doc="mass m_M of the sleeve", unit="kg", above=0.0)
    bird_mass: float = parameter(4.5e-3, doc="mass m_S of the bird", unit="kg", above=0.0)
    sleeve_inertia: float = parameter(5e-9, doc="moment of inertia J_M of the sleeve", unit="kg m^2", above=0.0)
    bird_inertia: float = parameter(7e-7, doc="moment of inertia J_S of the bird", unit="kg m^2", above=0.0)
    spring: float = parameter(5.6e-3, doc="torsional stiffness c_phi", unit="N m/rad", minimum=0.0)
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), law="friction")
    beak_restitution: float = parameter(0.5, doc="restitution of the beak", minimum=0.0, maximum=1.0, law="impact")
    sleeve_restitution: float = parameter(0.0, doc="restitution of the sleeve", minimum=0.0, maximum=1.0, law="impact")
    law: str = parameter("newton", doc="impact law", unit="", choices=("newton", "energetic"), law="impact")
    t_end: float = parameter(2.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    @property
    def sample_interval(self) -> float:
        """Time between samples [s]: a tenth of a millisecond, or less in a short run."""
        return min(1e-4, self.t_end / 400)

    def build(self) -> System:
        """Return toy and pole at their start."""
        jammed = -(self.sleeve_radius - self.pole_radius) / self.sleeve_height
        points = (
            (toy.beak, toy.beak_jacobian),
            (toy.lower_edge, toy.lower_edge_jacobian),
            (toy.upper_edge, toy.upper_edge_jacobian),
        )
        body = GeneralisedBody(
            coordinates=(
                Coordinate("y", "m", 0.0, -0.3411, scale=0.01, rate_scale=0.1),
                Coordinate("phi_m", "rad", jammed, 0.0, scale=0.1),
                Coordinate("phi_s", "rad", -0.2788, -7.4583, scale=0.1),
            ),
            mass=toy.mass,
            force=toy.force,
            potential=toy.potential,
            drawn=toy.outlines,
            moving_frames=tuple(PointFrame(pose, jacobian, toy.no_bias, (Point(),)) for pose, jacobian in points),
            constants=self.numbers(),
        )
        half = math.sqrt(0.5)
        front = Plate(Rest(orientation=(half, 0.0, half, 0.0)))  # its normal is x
        side = Plate(Rest(orientation=(half, -half, 0.0, 0.0)))  # its normal is y
        system = System([body, front, side], gravity=_GRAVITY)
        for near, face, e in (((0,), front, self.beak_restitution), ((1, 2), side, self.sleeve_restitution)):
            friction, impact = Coulomb(self.friction), _LAWS[self.law](e)
            system.contact(body, face, normal=Unilateral(), friction=friction, impact=impact, shapes=(near, None))
        return system

    def pecks(self, solution: Solution) -> tuple[Floats, Floats]:
        """Return times [s] and heights y [m] at which the beak hits the pole."""
        events = solution.events
        hits = (events.cause == Cause.IMPACT) & (events.impulse[:, _BEAK, 0] > 0.0)
        return events.time[hits], events.q[hits, 0]

    def cycle(self, solution: Solution) -> tuple[float, float]:
        """Return the mean duration [s] and descent [m] of the last two cycles; nan before the third peck.

        Near the limit cycle pecks are early and late by turns, which cancels in the mean of two cycles.
        """
        times, heights = self.pecks(solution)
        if len(times) < 3:
            return math.nan, math.nan
        return float(times[-1] - times[-3]) / 2.0, float(heights[-3] - heights[-1]) / 2.0

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return y [m], phi_m and phi_s [rad] over the samples."""
        return dict(zip(self.coordinate_units, solution.q.T, strict=True))

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the numbers of pecks and impacts, and mean duration [s] and descent [m] of the last two cycles."""
        duration, descent = self.cycle(solution)
        return {
            "pecks": len(self.pecks(solution)[0]),
            "impacts": solution.counters.impacts,
            "cycle_duration": duration,
            "cycle_descent": descent,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return duration and descent of the last cycle of the source's toy."""
        if self.t_end < _SETTLED or dataclasses.replace(self, t_end=_SETTLED) != Woodpecker(t_end=_SETTLED):
            return ()
        duration, descent = self.cycle(solution)
        source = "Glocker (1995): a limit cycle of about 0.146 s and 19.5 mm"
        return (
            Criterion.near("duration of the last cycle [s]", duration, 0.146, 5e-4, source),
            Criterion.near("descent of the last cycle [m]", descent, 19.5e-3, 1e-4, source),
        )

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return height and angles over the last cycles."""
        return {"cycles": _cycles(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the cycles with Newton's law, and the limit cycles of both laws in the bird's phase plane."""
        toys = {law: cls(law=law, t_end=6.0) for law in _LAWS}
        runs = {law: (one, run(one)) for law, one in toys.items()}
        return {"cycles": _cycles(*runs["newton"]), "limit_cycles": _limit_cycles(runs)}


def _cycles(scenario: Woodpecker, solution: Solution) -> Figure:
    """Draw the height of the sleeve and both angles over the last cycles; dotted lines mark the pecks."""
    shown = _last_cycles(scenario, solution)
    t, q = 1e3 * (solution.t[shown] - solution.t[shown][0]), solution.q[shown]
    duration, descent = scenario.cycle(solution)
    title = f"The woodpecker on its way down, with the law {scenario.law!r}"
    if np.isfinite(duration):
        title = f"From peck to peck (dotted) {1e3 * duration:.1f} ms and {1e3 * descent:.2f} mm, law {scenario.law!r}"
    figure, axes = charts.panels(2, 1, title, (7.2, 5.4), sharex=True)
    height = {"": (t, 1e3 * (q[:, 0] - q[0, 0]))}
    angles = {"sleeve": (t, q[:, 1]), "bird": (t, q[:, 2])}
    charts.histories({"height of the sleeve [mm]": height, "angle [rad]": angles}, xlabel="time [ms]", axes=axes)
    pecks = 1e3 * (scenario.pecks(solution)[0] - solution.t[shown][0])
    for peck in pecks[(pecks >= -1.0) & (pecks <= t[-1] + 1.0)]:
        for ax in axes:
            ax.axvline(peck, color="0.6", linewidth=0.8, linestyle=":")
    charts.legend(figure)
    return figure


def _limit_cycles(runs: Mapping[str, tuple[Woodpecker, Solution]]) -> Figure:
    """Draw the bird's rate over its angle in the last cycles, a panel for each law."""
    title = "The impact law decides how far the bird swings, and how fast it comes down"
    figure, axes = charts.panels(1, len(runs), title, (7.2, 4.2), sharex=True, sharey=True)
    for ax, (law, (scenario, solution)) in zip(axes, runs.items(), strict=True):
        shown, (duration, descent) = _last_cycles(scenario, solution), scenario.cycle(solution)
        cycles = {"": (solution.q[shown, 2], solution.u[shown, 2])}
        rate = "rate of the bird [rad/s]" if ax is axes[0] else ""
        charts.portrait(cycles, "angle of the bird [rad]", rate, ax=ax)
        ax.set_title(f"{law}: {1e3 * duration:.1f} ms, {1e3 * descent:.2f} mm per cycle", fontsize=9)
    return figure


def _last_cycles(scenario: Woodpecker, solution: Solution) -> NDArray[np.bool_]:
    """Return True for samples in the last cycles, or for all if the run has too few cycles, shape [n_samples]."""
    times, _ = scenario.pecks(solution)
    start, stop = (times[-_SHOWN - 1], times[-1]) if len(times) > _SHOWN else (0.0, solution.t_end)
    return np.asarray((solution.t >= start) & (solution.t <= stop))
