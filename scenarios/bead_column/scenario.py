"""A column of beads that touch, dropped together on a wall: one multiple impact, then many."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import Ball, Plate, Rest
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

Floats = NDArray[np.float64]

_SAMPLES = 1000
_GRAVITY = 9.81


@final
@dataclass(frozen=True)
class BeadColumn(Scenario):
    """Equal beads in a vertical column, the lowest at ``height`` above a wall, released together.

    References
    ----------
    N. S. Nguyen, B. Brogliato, *Multiple Impacts in Dissipative Granular Chains*, Springer (2014).
    """

    title: ClassVar[str] = "Column of beads on a wall"
    coordinate_units: ClassVar[Mapping[str, str]] = {"z": "m"}
    units: ClassVar[Mapping[str, str]] = {"restitution_loss": "J"}

    n_beads: float = parameter(10.0, doc="number of beads", minimum=1.0, maximum=100.0)
    radius: float = parameter(5e-3, doc="radius of the beads", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(7780.0, doc="density of the beads", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    height: float = parameter(0.05, doc="way of the fall", unit="m", above=0.0, usual=(1e-6, 10.0))
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

    def _check(self) -> None:
        if self.n_beads != int(self.n_beads):
            raise InvalidInput(
                "BeadColumn.n_beads", "must be a whole number", self.n_beads, "Beads do not come in parts."
            )

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A thousandth of the run [s]."""
        return self.t_end / _SAMPLES

    @property
    def fall_speed(self) -> float:
        """Speed at the first impact [m/s]."""
        return float((2.0 * _GRAVITY * self.height) ** 0.5)

    def build(self) -> System:
        """Return wall, beads and contacts at their start."""
        wall = Plate(Rest())
        beads = [Ball(self.radius, self.density) for _ in range(int(self.n_beads))]
        system = System([wall, *beads], gravity=_GRAVITY)
        for one, two in itertools.pairwise((wall, *beads)):
            impact = EnergeticImpact(self.restitution, self.wall_stiffness if one is wall else 1.0, self.exponent)
            system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=impact)
        for i, bead in enumerate(beads):
            system.place(bead, position=(0.0, 0.0, self.height + (2 * i + 1) * self.radius))
        return system

    def heights(self, solution: Solution) -> Floats:
        """Return the beads' centres above the wall [m], shape [n_samples, n_beads]."""
        return solution.q.reshape(len(solution.t), -1, 7)[:, :, 2]

    def rebound(self, solution: Solution) -> Floats:
        """Return the beads' velocities after the first impact [m/s], shape [n_beads]; zeros if there was none."""
        events = solution.events
        first = np.flatnonzero(events.cause == Cause.IMPACT)[:1]
        velocities: Floats = events.u_after[first].reshape(-1, 6)[:, 2]
        return velocities if len(first) > 0 else np.zeros(int(self.n_beads))

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return z_1 ... z_n [m] over the samples."""
        return {f"z_{i + 1}": z for i, z in enumerate(self.heights(solution).T)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: heights [m] and velocities [m/s] at the end."""
        u = solution.u_end.reshape(-1, 6)[:, 2]
        return {"q": solution.q_end.reshape(-1, 7)[:, 2].tolist(), "u": u.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the velocities after the first impact over the speed of the fall, the impacts, the energy kept."""
        account = solution.energy
        return {
            "relative_rebound": (self.rebound(solution) / self.fall_speed).tolist(),
            "impacts": solution.counters.impacts,
            "restitution_loss": account.restitution_loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the time of the first impact, and what its energy or the rebound of one bead must be."""
        times = solution.events.time[solution.events.cause == Cause.IMPACT]
        fall = self.fall_speed / _GRAVITY
        first = float(times[0]) if len(times) else None
        found = [Criterion.near("time of the first impact [s]", first, fall, 1e-9, "free fall, sqrt(2 h / g)")]
        after = self.rebound(solution) / self.fall_speed
        if self.restitution == 1.0:
            kept = float(np.mean(after**2))
            name = "energy after the first impact over that before"
            found.append(Criterion.near(name, kept, 1.0, 1e-6, "nothing is lost where e = 1"))
        if self.n_beads == 1.0:
            source = "one contact gives back e of the speed"
            found.append(
                Criterion.near(
                    "speed after the first impact over that before", after[0], self.restitution, 1e-6, source
                )
            )
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the heights of all beads over time."""
        from scenarios.bead_column.figures import heights

        return {"heights": heights(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the heights over time of an elastic and of a dissipative column."""
        from scenarios.bead_column.figures import heights

        drawn = {}
        for restitution, word in ((1.0, "elastic"), (0.9, "dissipative")):
            scenario = cls(restitution=restitution)
            drawn[f"heights_{word}"] = heights(scenario, run(scenario))
        return drawn
