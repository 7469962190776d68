"""A tower of prisms, of which the uppermost is pushed."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import HullBody, Plate, Polyhedron, Rest
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from .solids import draw_solids

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_SIDES = (6, 5, 4, 3)
"""Number of sides of each prism, from the lowest to the uppermost."""
_COLOURS = ("#0072b2", "#009e73", "#e69f00", "#cc79a7")


@final
@dataclass(frozen=True)
class PolyhedronStack(Scenario):
    """A tower of four prisms: the uppermost is pushed and slides over the face below.

    Corners on faces and edges across edges carry the prisms.  As the uppermost prism slides, its corners leave the
    face below, and the crossings of its edges carry it.
    """

    title: ClassVar[str] = "Tower of prisms"
    samples: ClassVar[int] = 400
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m"}
    units: ClassVar[Mapping[str, str]] = {"way": "m", "friction_loss": "J"}

    radius: float = parameter(0.03, doc="radius round the lowest prism", unit="m", above=0.0, usual=(1e-3, 10.0))
    height: float = parameter(0.02, doc="height of a prism", unit="m", above=0.0, usual=(1e-3, 10.0))
    taper: float = parameter(0.94, doc="radius of a prism over that under it", above=0.1, maximum=1.0)
    turn: float = parameter(
        0.3, doc="angle of a prism from that under it", unit="rad", minimum=-math.pi, maximum=math.pi
    )
    density: float = parameter(1000.0, doc="density", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    push: float = parameter(
        0.3, doc="speed of the uppermost at the start, along x", unit="m/s", minimum=0.0, usual=(1e-3, 10.0)
    )
    friction: float = parameter(0.5, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(0.2, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        if self.friction == 0.0 and self.push == 0.0:
            raise InvalidInput(
                "PolyhedronStack.push", "must be positive without friction", self.push, "Nothing would happen."
            )

    def prisms(self) -> list[HullBody]:
        """Return the prisms, from the lowest to the uppermost."""
        found = []
        for i, sides in enumerate(_SIDES):
            radius, angles = self.radius * self.taper**i, 2.0 * np.pi * np.arange(sides) / sides
            ring = radius * np.column_stack([np.cos(angles), np.sin(angles)])
            points = [(x, y, z) for x, y in ring.tolist() for z in (-0.5 * self.height, 0.5 * self.height)]
            found.append(HullBody(points, density=self.density))
        return found

    def build(self) -> System:
        """Return ground and tower, the uppermost prism with its speed."""
        prisms = self.prisms()
        bodies = [Plate(Rest()), *prisms]
        system = System(bodies, gravity=_GRAVITY)
        for one, two in itertools.pairwise(bodies):
            system.contact(one, two, normal=Unilateral(), friction=Coulomb(self.friction), impact=EnergeticImpact(0.0))
        for i, prism in enumerate(prisms):
            half = 0.5 * i * self.turn
            system.place(
                prism,
                position=(0.0, 0.0, self.height * (i + 0.5)),
                orientation=(math.cos(half), 0.0, 0.0, math.sin(half)),
                velocity=(self.push if i == len(prisms) - 1 else 0.0, 0.0, 0.0),
            )
        return system

    @property
    def way(self) -> float:
        """Distance over which friction stops the uppermost prism, v^2 / (2 mu g) [m]."""
        return self.push**2 / (2.0 * self.friction * _GRAVITY) if self.friction > 0.0 else math.inf

    @property
    def stands(self) -> bool:
        """True if the tower withstands the push: the uppermost prism does not tip, and no prism below slides or tips.

        The uppermost prism must slide less than half the inner radius of the prism below it.  For the prisms below,
        friction times height must be less than 0.6 of this inner radius.
        """
        inner = self.radius * self.taper ** (len(_SIDES) - 2) * math.cos(math.pi / _SIDES[-2])
        return self.way < 0.5 * inner and self.friction * self.height < 0.6 * inner

    def positions(self, solution: Solution) -> Floats:
        """Return the centres over the samples [m], shape [n_samples, n, 3]."""
        return solution.q.reshape(len(solution.t), -1, 7)[:, :, :3]

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y and z of every prism [m] over the samples."""
        places = self.positions(solution)
        return {f"{c}_{i + 1}": places[:, i, j] for i in range(len(_SIDES)) for j, c in enumerate("xyz")}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the distance of each prism from its start [m], the number of events by cause, and the loss [J]."""
        causes = solution.events.causes()
        ends = solution.q_end.reshape(-1, 7)[:, :3]
        return {
            "way": np.linalg.norm(ends - self.positions(solution)[0], axis=1).tolist(),
            "events": {cause: causes.count(cause) for cause in sorted(set(causes))},
            "friction_loss": solution.energy.friction_loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: balance of energy; if the tower withstands the push, also the distances its prisms slide."""
        account = solution.energy
        start, end = account.kinetic_start + account.potential_start, account.kinetic_end + account.potential_end
        name = "energy less what was lost over that at the start"
        found = [Criterion.near(name, (end + account.loss) / start, 1.0, 1e-9, "balance of energy")]
        if self.stands and self.t_end > self.push / (self.friction * _GRAVITY):
            way = solution.q_end.reshape(-1, 7)[:, :3] - self.positions(solution)[0]
            source = "Coulomb's law: v^2 / (2 mu g)"
            found.append(Criterion.near("way of the uppermost [m]", way[-1, 0], self.way, 1e-9, source))
            rest = float(np.max(np.abs(way[:-1])))
            found.append(Criterion.near("way of those below [m]", rest, 0.0, 1e-9, "friction below bears more weight"))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the tower at the start and at the end, and the distance slid by the uppermost prism."""
        return {"tower": _tower(self, solution)}


def _tower(scenario: PolyhedronStack, solution: Solution) -> Figure:
    """Draw the tower at the start and at the end, and the distance slid by the uppermost prism, with its events."""
    claim = "Pushed, the uppermost prism slides to rest; the tower below stays"
    title = claim if scenario.stands else "The uppermost prism is pushed"
    figure, (start, end, history) = charts.panels(1, 3, title, (9.6, 4.6), width_ratios=(1.0, 1.0, 1.6))
    solids = [shape for prism in scenario.prisms() for shape in prism.shapes if isinstance(shape, Polyhedron)]
    for ax, sample, name in ((start, 0, "start"), (end, -1, f"t = {solution.t[-1]:.2g} s")):
        draw_solids(ax, solids, solution.q[sample].reshape(-1, 7), -1.1, 0.4, _COLOURS)
        ax.set_title(name, fontsize=10)
        ax.set(xticks=[], yticks=[])
    t, way = 1e3 * solution.t, 1e3 * scenario.positions(solution)[:, -1, 0]
    events = solution.events
    left = 1e3 * events.time[np.array(events.causes()) == "end of a feature"]
    expected: dict[str, Any] = {"uppermost prism": (t, way)}
    if scenario.friction > 0.0:
        expected["v² / (2 μ g)"] = t, np.full(len(t), 1e3 * scenario.way)
    marks = {"a corner leaves the face": (left, np.interp(left, t, way))} if len(left) else {}
    charts.comparison(expected, marks, "time [ms]", "way [mm]", ax=history)
    history.set_ylim(bottom=0.0)
    charts.legend(figure)
    return figure
