"""Newton's cradle: a row of balls at rest, struck by further balls in one multiple impact."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Ball
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_ON_SPRINGS: Mapping[tuple[int, float], tuple[float, ...]] = MappingProxyType(
    {
        (3, 1.5): (-0.07095235, 0.07640304, 0.99454931),
        (3, 1.0): (-0.13026170, 0.15022957, 0.98003213),
        (5, 1.5): (-0.07108502, -0.03027376, -0.01446363, 0.12704499, 0.98877742),
    }
)
"""Velocities after one ball struck others at rest, by number of balls and exponent, to eight digits."""


@final
@dataclass(frozen=True)
class NewtonsCradle(Scenario):
    """Newton's cradle: balls strike a row of touching balls, and balls leave at the other end.

    There is no gravity; ``n_strikers`` touching balls strike at ``speed``.

    References
    ----------
    C. Liu, Z. Zhao, B. Brogliato, "Frictionless multiple impacts in multibody systems. II. Numerical algorithm and
    simulation results", Proc. R. Soc. A 465 (2009) 1-23.
    """

    title: ClassVar[str] = "Newton's cradle"
    samples: ClassVar[int] = 400
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m"}

    n_balls: int = parameter(5, doc="number of balls, strikers included", minimum=2, maximum=1000, integer=True)
    n_strikers: int = parameter(1, doc="number of balls that strike", minimum=1, maximum=999, integer=True)
    radius: float = parameter(0.01, doc="radius of the balls", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float = parameter(7780.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    mass_ratio: float = parameter(1.0, doc="mass of a striker over that of another ball", above=0.0, usual=(1e-3, 1e3))
    stiffness_ratio: float = parameter(
        1.0, doc="stiffness of a contact over that of the one before it", above=0.0, usual=(1e-3, 1e3), law="impact"
    )
    restitution: float = parameter(
        1.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    exponent: float = parameter(
        1.5, doc="exponent eta of F = k x^eta (3/2 Hertz, 1 linear)", minimum=1.0, maximum=10.0, law="impact"
    )
    speed: float = parameter(1.0, doc="speed of the strikers", unit="m/s", above=0.0, usual=(1e-3, 1e2))
    distance: float = parameter(0.01, doc="way to the strike", unit="m", above=0.0, usual=(1e-6, 10.0))
    t_end: float = parameter(0.04, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        if self.n_strikers >= self.n_balls:
            raise InvalidInput(
                "NewtonsCradle.n_strikers",
                f"must be less than the number of balls {self.n_balls}",
                self.n_strikers,
                "Leave at least one ball to be struck.",
            )

    def build(self) -> System:
        """Return balls and contacts at their start."""
        strikers = self.n_strikers
        strikes = [i < strikers for i in range(self.n_balls)]
        balls = [Ball(self.radius, self.density * (self.mass_ratio if striker else 1.0)) for striker in strikes]
        system = System(balls, gravity=0.0)
        stiffness = 1.0
        for one, two in itertools.pairwise(balls):
            impact = EnergeticImpact(self.restitution, stiffness, self.exponent)
            system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=impact)
            stiffness *= self.stiffness_ratio
        for i, ball in enumerate(balls):
            place = 2.0 * self.radius * (i - strikers) - (self.distance if strikes[i] else 0.0)
            system.place(ball, position=(place, 0.0, 0.0), velocity=(self.speed if strikes[i] else 0.0, 0.0, 0.0))
        return system

    def velocities(self, solution: Solution) -> Floats:
        """Return the balls' velocities along the row at the end [m/s], shape [n_balls]."""
        return solution.u_end.reshape(-1, 6)[:, 0]

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x_1 ... x_n, the centres along the row [m]."""
        return {f"x_{i + 1}": x for i, x in enumerate(solution.q[:, ::7].T)}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u}: centres [m] and velocities [m/s] along the row at the end."""
        return {"q": solution.q_end[::7].tolist(), "u": self.velocities(solution).tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return velocities over the strikers' speed, kinetic energy at the end over that at the start, impacts."""
        account = solution.energy
        return {
            "relative_velocity": (self.velocities(solution) / self.speed).tolist(),
            "energy_kept": account.kinetic_end / account.kinetic_start,
            "impacts": solution.counters.impacts,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return the momentum and, of one ball that strikes two or four others like it without loss, all velocities."""
        after = self.velocities(solution) / self.speed
        masses = np.where(np.arange(len(after)) < self.n_strikers, self.mass_ratio, 1.0)
        total, before = float(masses @ after), self.mass_ratio * self.n_strikers
        name = "momentum over that of a struck ball at the speed"
        found = [Criterion.near(name, total, before, 1e-9, "balance of momentum")]
        if self.restitution == 1.0:
            kept = float(masses @ after**2) / before
            found.append(Criterion.near("energy kept", kept, 1.0, 1e-6, "nothing is lost where e = 1"))
        alike = (self.n_strikers, self.mass_ratio, self.stiffness_ratio, self.restitution) == (1, 1.0, 1.0, 1.0)
        source = "springs k x^eta in real time, whatever their stiffness"
        for i, value in enumerate(_ON_SPRINGS.get((self.n_balls, self.exponent), ()) if alike else ()):
            name = f"velocity of ball {i + 1} over that of the striker"
            found.append(Criterion.near(name, after[i], value, 1e-7, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the velocities after the strike."""
        label = f"{self.n_balls} balls, e = {self.restitution:g}, η = {self.exponent:g}"
        return {"velocities": _velocities({label: (self, solution)}, "")}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the velocities after the strike for rows of 3, 5 and 10 balls, linear and Hertzian."""
        drawn = {}
        for exponent, word in ((1.0, "linear"), (1.5, "hertz")):
            rows = {f"{n} balls": cls(n_balls=n, exponent=exponent) for n in (3, 5, 10)}
            runs = {label: (row, run(row)) for label, row in rows.items()}
            drawn[f"velocities_{word}"] = _velocities(runs, f" (η = {exponent:g})")
        return drawn


def _velocities(runs: Mapping[str, tuple[NewtonsCradle, Solution]], words: str) -> Figure:
    """Draw the velocity of every ball relative to the speed of the strikers; balls are numbered from the far end."""
    struck = {label: row.velocities(solution)[::-1] / row.speed for label, (row, solution) in runs.items()}
    figure = charts.comparison(
        {},
        {label: (np.arange(len(after)), after) for label, after in struck.items()},
        "ball, counted back from the far end of the row",
        "velocity after the strike / velocity of the strikers",
        f"Not only the last ball flies off: the others follow, or come back{words}",
    )
    (ax,) = figure.axes
    for line in ax.lines:
        line.set_linestyle(":")
    ax.axhline(0.0, color="0.6", linewidth=0.8)
    ax.locator_params(axis="x", integer=True, nbins=10)
    ax.invert_xaxis()
    return figure
