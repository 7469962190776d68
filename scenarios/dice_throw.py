"""Dice thrown onto a table: they strike it and each other, and end on a face."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Box, BoxBody, Plate, Rest
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from .solids import draw_solids

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_EYES = np.array([[5, 3, 1], [2, 4, 6]])
"""Eyes on the faces against and along the three axes of a die; opposite ones make seven."""
_AT_REST = 1e-6
"""Speeds below which a die has come to rest [m/s and rad/s]."""
_PIPS = {
    1: ((0, 0),),
    2: ((-1, -1), (1, 1)),
    3: ((-1, -1), (0, 0), (1, 1)),
    4: ((-1, -1), (-1, 1), (1, -1), (1, 1)),
    5: ((-1, -1), (-1, 1), (0, 0), (1, -1), (1, 1)),
    6: ((-1, -1), (-1, 0), (-1, 1), (1, -1), (1, 0), (1, 1)),
}
"""Places of the pips on a face, across and along, by the number of eyes; unit: the distance of two pips."""
_PIP, _APART, _SIDES = 0.16, 0.5, 16
"""Radius of a pip and distance of neighbouring pips, relative to half an edge; number of sides of a drawn pip."""
_SHADES = ("#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#d55e00", "#0072b2")
"""Colours of the dice; black as in ``charts.COLOURS`` would hide the edges."""


@final
@dataclass(frozen=True)
class DiceThrow(Scenario):
    """Sharp or rounded dice are thrown together, collide and come to rest on a table.

    ``throw`` numbers the throws: orientations and spins are drawn at random from it, and always the same.
    """

    title: ClassVar[str] = "Throw of dice"
    coordinate_units: ClassVar[Mapping[str, str]] = {"x": "m", "y": "m", "z": "m"}
    samples: ClassVar[int] = 500
    units: ClassVar[Mapping[str, str]] = {"last_event": "s"}

    number: int = parameter(3, doc="number of dice", minimum=1, maximum=20, integer=True)
    throw: int = parameter(1, doc="number of the throw", minimum=0, maximum=1e9, integer=True)
    edge: float = parameter(0.016, doc="edge of a die", unit="m", above=0.0, usual=(1e-3, 1.0))
    rounding: float = parameter(1e-3, doc="radius of the edges and vertices of a die", unit="m", minimum=0.0)
    density: float = parameter(1200.0, doc="density", unit="kg/m^3", above=0.0, usual=(10.0, 3e4))
    speed: float = parameter(0.6, doc="speed along the table", unit="m/s", minimum=0.0, usual=(1e-2, 1e2))
    spin: float = parameter(15.0, doc="usual angular velocity", unit="rad/s", minimum=0.0, usual=(1e-2, 1e3))
    restitution: float = parameter(
        0.5, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.0, 2.0), law="friction")
    t_end: float = parameter(1.0, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e3))

    def _check(self) -> None:
        _ = self.die  # raises an error if the rounding is larger than half the edge

    @property
    def die(self) -> BoxBody:
        """One of the dice."""
        half = 0.5 * self.edge
        return BoxBody(half, half, half, density=self.density, rounding=self.rounding)

    def build(self) -> System:
        """Return table and dice, in the air one over the other."""
        n = self.number
        table, dice = Plate(Rest()), [self.die for _ in range(n)]
        system = System([table, *dice], gravity=_GRAVITY)
        friction, impact = Coulomb(self.friction), EnergeticImpact(self.restitution)
        for i, die in enumerate(dice):
            for other in [table, *dice[:i]]:
                system.contact(other, die, normal=Unilateral(), friction=friction, impact=impact)
        rng = np.random.default_rng(self.throw)
        for i, die in enumerate(dice):
            turn = rng.normal(size=4)
            aside = i - 0.5 * (n - 1)
            system.place(
                die,
                # farther from each other than the diagonals
                position=(0.0, 1.4 * self.edge * aside, (5.0 + 1.25 * i) * self.edge),
                orientation=turn / np.linalg.norm(turn),
                velocity=(self.speed, -0.4 * self.speed * aside, -0.5 * self.speed),
                angular_velocity=self.spin * rng.normal(size=3),
            )
        return system

    def upright(self, solution: Solution) -> Floats:
        """Return the vertical components of the axes of every die at the end [n, 3]."""
        a, b, c, d = solution.q_end.reshape(-1, 7)[:, 3:].T
        return np.column_stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d])

    def heights(self, solution: Solution) -> Floats:
        """Return the heights of the centres over the samples [m], shape [n_samples, n]."""
        return solution.q[:, 2::7]

    def eyes(self, solution: Solution) -> list[int]:
        """Return the eyes that each die shows at the end, on the face whose normal is nearest to the vertical."""
        upright = self.upright(solution)
        axes = np.argmax(np.abs(upright), axis=1)
        return [int(_EYES[int(up[axis] > 0.0), axis]) for axis, up in zip(axes, upright, strict=True)]

    def on_a_face(self, solution: Solution) -> bool:
        """Return True if all dice have come to rest on the table."""
        low = np.all(np.abs(self.heights(solution)[-1] - 0.5 * self.edge) < 1e-3 * self.edge)
        return bool(low and np.max(np.abs(solution.u_end)) < _AT_REST)

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y and z of every die [m] over the samples."""
        q = solution.q.reshape(len(solution.t), -1, 7)
        return {f"{c}_{i + 1}": q[:, i, j] for i in range(q.shape[1]) for j, c in enumerate("xyz")}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the eyes, whether all lie on a face, the number of impacts, and the time of the last event [s]."""
        return {
            "eyes": self.eyes(solution),
            "at_rest": self.on_a_face(solution),
            "impacts": solution.counters.impacts,
            "last_event": float(solution.events.time[-1]),
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: balance of energy, weight of the dice, and for dice at rest their height and their tilt."""
        account = solution.energy
        start, end = account.kinetic_start + account.potential_start, account.kinetic_end + account.potential_end
        found = []
        if account.loss > 0.0:
            ratio = (start - end) / account.loss
            found.append(Criterion.near("energy lost over losses booked", ratio, 1.0, 1e-6, "balance of energy"))
        # volume by Steiner's formula
        side, r = self.edge - 2.0 * self.rounding, self.rounding
        volume = side**3 + 6.0 * side**2 * r + 3.0 * math.pi * side * r**2 + 4.0 / 3.0 * math.pi * r**3
        weights = self.density * volume * _GRAVITY * float(np.sum(self.heights(solution)[0]))
        name, source = "potential energy at the start over weights times heights", "mass of a cube, rounded or not"
        found.append(Criterion.near(name, account.potential_start / weights, 1.0, 1e-9, source))
        if self.on_a_face(solution):
            lowest = float(np.max(np.abs(self.heights(solution)[-1] / (0.5 * self.edge) - 1.0)))
            tilt = float(np.max(1.0 - np.max(np.abs(self.upright(solution)), axis=1)))
            source = "a cube at rest on a plane lies on a face"
            found += [
                Criterion.near("height of a centre over half an edge, less 1", lowest, 0.0, 1e-9, source),
                Criterion.near("1 - cosine of the tilt", tilt, 0.0, 1e-12, source),
            ]
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the dice at four instants and their heights."""
        return {"throw": _throw(self, solution)}


def _throw(scenario: DiceThrow, solution: Solution) -> Figure:
    """Draw the dice at four instants, and the heights of their centres."""
    from matplotlib.figure import Figure

    kind = "Rounded" if scenario.rounding > 0.0 else "Sharp"
    eyes = " + ".join(str(e) for e in scenario.eyes(solution))
    ends = "come to rest on a face" if scenario.on_a_face(solution) else "still move at the end"
    title = f"{kind} dice strike table and each other, and {ends}: {eyes}"
    figure = Figure(figsize=(7.2, 6.8), layout="constrained")
    *axes, below = figure.subplot_mosaic("AB;CD;EE", height_ratios=(1.0, 1.0, 1.1)).values()
    figure.suptitle(title, fontsize=11)
    n, half = scenario.number, 0.5 * scenario.edge
    shades = [_SHADES[i % len(_SHADES)] for i in range(n)]
    dice = [Box(half, half, half, rounding=scenario.rounding)] * n
    for ax, share in zip(axes, (0.0, 0.1, 0.2, 1.0), strict=True):
        sample = min(int(share * len(solution.t)), len(solution.t) - 1)
        draw_solids(ax, dice, solution.q[sample].reshape(-1, 7), -1.2, 0.45, shades, _pips(half))
        ax.set_title(f"t = {1e3 * solution.t[sample]:.0f} ms", fontsize=9)
        ax.set(xticks=[], yticks=[])
    _to_one_scale(axes)
    heights = {f"die {i + 1}": (1e3 * solution.t, 1e3 * z) for i, z in enumerate(scenario.heights(solution).T)}
    charts.histories({"height of the centre [mm]": heights}, xlabel="time [ms]", axes=[below])
    for line, shade in zip(below.lines, shades, strict=True):
        line.set_color(shade)
    below.axhline(1e3 * half, color="0.5", linewidth=0.8, linestyle="--", label="on a face")
    below.grid(color="0.9", linewidth=0.6)
    below.set_ylim(bottom=0.0)
    charts.legend(figure, columns=4)
    return figure


def _to_one_scale(axes: list[Axes]) -> None:
    """Give all panels the largest width and height of their limits, so that all dice have the same scale."""
    limits = np.array([[ax.get_xlim(), ax.get_ylim()] for ax in axes])
    largest = np.max(limits[:, :, 1] - limits[:, :, 0], axis=0)
    for ax, middle in zip(axes, 0.5 * np.sum(limits, axis=2), strict=True):
        low, high = middle - 0.5 * largest, middle + 0.5 * largest
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))


def _pips(half: float) -> list[tuple[Floats, Floats]]:
    """Return the pips of a die with half-edge ``half`` [m]: for each pip the normal of its face, and its corners."""
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    ring, found = _PIP * np.column_stack([np.cos(turn), np.sin(turn)]), []
    for (side, axis), eyes in np.ndenumerate(_EYES):
        normal = np.roll([2.0 * side - 1.0, 0.0, 0.0], axis)
        for place in _PIPS[int(eyes)]:
            flat = np.column_stack([np.ones(_SIDES) * (2.0 * side - 1.0), ring + _APART * np.array(place)])
            found.append((normal, half * np.roll(flat, axis, axis=1)))
    return found
