"""A column of beads that touch, dropped together on a wall: one multiple impact, then many."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Ball, Plate, Rest
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81


@final
@dataclass(frozen=True)
class BeadColumn(Scenario):
    """A column of touching beads drops on a wall: all contacts act in one impact.

    References
    ----------
    N. S. Nguyen, B. Brogliato, *Multiple Impacts in Dissipative Granular Chains*, Springer (2014).
    """

    title: ClassVar[str] = "Column of beads on a wall"
    coordinate_units: ClassVar[Mapping[str, str]] = {"z": "m"}

    n_beads: int = parameter(10, doc="number of beads", minimum=1, maximum=100, integer=True)
    radius: float = parameter(5e-3, doc="radius of the beads", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(7780.0, doc="density of the beads", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    height: float = parameter(0.05, doc="height of the fall", unit="m", above=0.0, usual=(1e-6, 10.0))
    restitution: float = parameter(
        1.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    exponent: float = parameter(
        1.5, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0, law="impact"
    )
    wall_stiffness: float = parameter(
        2.0**0.5,
        doc="stiffness at the wall over that between beads; by Hertz sqrt(2) for one material",
        above=0.0,
        usual=(1e-3, 1e3),
        law="impact",
    )
    t_end: float = parameter(0.3, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    @property
    def fall_speed(self) -> float:
        """Speed at the first impact [m/s]."""
        return float((2.0 * _GRAVITY * self.height) ** 0.5)

    def build(self) -> System:
        """Return wall, beads and contacts at their start."""
        wall = Plate(Rest())
        beads = [Ball(self.radius, self.density) for _ in range(self.n_beads)]
        system = System([wall, *beads], gravity=_GRAVITY)
        for one, two in itertools.pairwise((wall, *beads)):
            impact = EnergeticImpact(self.restitution, self.wall_stiffness if one is wall else 1.0, self.exponent)
            system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=impact)
        for i, bead in enumerate(beads):
            system.place(bead, position=(0.0, 0.0, self.height + (2 * i + 1) * self.radius))
        return system

    def heights(self, solution: Solution) -> Floats:
        """Return the beads' centres above the wall [m], shape [n_samples, n_beads]."""
        return solution.q[:, 2::7]

    def rebound(self, solution: Solution) -> Floats:
        """Return the beads' velocities after the first impact [m/s], shape [n_beads]; zeros if there was none."""
        after = solution.events.u_after[solution.events.cause == Cause.IMPACT]
        return np.asarray(after[0, 2::6]) if len(after) else np.zeros(self.n_beads)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return z_1 ... z_n [m] over the samples."""
        return {f"z_{i + 1}": z for i, z in enumerate(self.heights(solution).T)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: heights [m] and velocities [m/s] at the end."""
        return {"q": solution.q_end[2::7].tolist(), "u": solution.u_end[2::6].tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return velocities after the first impact / speed of the fall, number of impacts, loss by restitution [J]."""
        return {
            "relative_rebound": (self.rebound(solution) / self.fall_speed).tolist(),
            "impacts": solution.counters.impacts,
            "restitution_loss": solution.energy.restitution_loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: time of the first impact; for e = 1 the energy after it; for one bead its rebound."""
        times = solution.events.time[solution.events.cause == Cause.IMPACT]
        fall = self.fall_speed / _GRAVITY
        first = float(times[0]) if len(times) else None
        found = [Criterion.near("time of the first impact [s]", first, fall, 1e-9, "free fall, sqrt(2 h / g)")]
        after = self.rebound(solution) / self.fall_speed
        if self.restitution == 1.0:
            kept, name = float(np.mean(after**2)), "energy after the first impact over that before"
            found.append(Criterion.near(name, kept, 1.0, 1e-6, "nothing is lost where e = 1"))
        if self.n_beads == 1:
            name, source = "speed after the first impact over that before", "one contact gives back e of the speed"
            found.append(Criterion.near(name, after[0], self.restitution, 1e-6, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the heights of all beads over time."""
        return {"heights": _heights(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the heights over time of an elastic and of a dissipative column."""
        columns = {"elastic": cls(restitution=1.0), "dissipative": cls(restitution=0.9)}
        return {f"heights_{word}": _heights(column, run(column)) for word, column in columns.items()}


def _heights(scenario: BeadColumn, solution: Solution) -> Figure:
    """Draw the height of every bead above its place in a column at rest, lower beads darker."""
    title = f"The column falls as one and comes apart in its first impact (e = {scenario.restitution:g})"
    figure, (ax,) = charts.panels(title=title, size=(7.2, 4.8))
    n = scenario.n_beads
    for i, z in enumerate(scenario.heights(solution).T):
        lift, label = z - (2 * i + 1) * scenario.radius, {0: "lowest bead", n - 1: "highest bead"}.get(i)
        ax.plot(1e3 * solution.t, 1e3 * lift, color=str(0.75 * np.sqrt(i / n)), linewidth=1.2, label=label)
    ax.set(xlabel="time [ms]", ylabel="height above the place in a column at rest [mm]")
    charts.legend(figure)
    return figure
