"""A row of dominoes, the first of which leans so far that it falls."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Box, PlanarBody, Plate, Rest
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_DENSITY = 1000.0
_NARROWER = 0.9
"""Width of every second domino, relative to its neighbours.

Corners then never meet corners of the next domino; a contact of two corners has no unique normal.
"""
_MOVES = 1e-4
"""Angular velocity above which a domino has been struck [rad/s]; round-off is far below."""


@final
@dataclass(frozen=True)
class Dominoes(Scenario):
    """A row of dominoes: the first one falls, and a wave of collisions runs along the row.

    They move in a plane, so that all of them fall straight, but touch as boxes do: the upper edge of one slides down
    the face of the next.  Every second one is a little narrower, so that no two corners meet.

    References
    ----------
    W. J. Stronge, "The domino effect: a wave of destabilizing collisions in a periodic array", Proc. R. Soc. A 409
    (1987) 199-208.
    """

    title: ClassVar[str] = "Dominoes"
    coordinate_units: ClassVar[Mapping[str, str]] = {"tilt": "rad"}
    samples: ClassVar[int] = 650
    units: ClassVar[Mapping[str, str]] = {"strikes": "s", "wave_speed": "m/s"}

    number: int = parameter(14, doc="number of dominoes", minimum=2, maximum=100, integer=True)
    thickness: float = parameter(7.5e-3, doc="thickness", unit="m", above=0.0, usual=(1e-3, 1.0))
    width: float = parameter(24e-3, doc="width", unit="m", above=0.0, usual=(1e-3, 1.0))
    height: float = parameter(48e-3, doc="height", unit="m", above=0.0, usual=(1e-3, 10.0))
    spacing: float = parameter(16e-3, doc="free distance between two", unit="m", above=0.0, usual=(1e-3, 10.0))
    lean: float = parameter(
        0.02, doc="angle of the first past its balance at the start", unit="rad", above=0.0, maximum=1.0
    )
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e between two", minimum=0.0, maximum=1.0, law="impact"
    )
    friction: float = parameter(
        0.2, doc="friction coefficient mu between two", minimum=0.0, usual=(0.0, 2.0), law="friction"
    )
    ground_friction: float = parameter(
        0.8, doc="friction coefficient mu of the ground", minimum=0.0, usual=(0.0, 2.0), law="friction"
    )
    t_end: float = parameter(0.655, doc="end time", unit="s", above=0.0, usual=(1e-6, 1e2))

    def _check(self) -> None:
        if self.height <= self.thickness + self.spacing:
            raise InvalidInput(
                "Dominoes.spacing",
                "must leave a domino within reach of the one before it",
                self.spacing,
                f"Below {self.height - self.thickness:g} m the next one is struck on its face.",
            )

    @property
    def balance(self) -> float:
        """Tilt at which the mass centre of a domino is above its lower edge [rad]."""
        return math.atan2(self.thickness, self.height)

    @property
    def pitch(self) -> float:
        """Distance of two dominoes' centres [m]."""
        return self.thickness + self.spacing

    def build(self) -> System:
        """Return ground and dominoes, of which the first leans."""
        ground = Plate(Rest())
        h, height = self.thickness, self.height
        mass = _DENSITY * h * self.width * height
        moment = mass * (h * h + height * height) / 12.0
        boxes = [Box(0.5 * h, 0.5 * self.width * part, 0.5 * height) for part in (1.0, _NARROWER)]
        dominoes = [PlanarBody(mass, moment, (boxes[i % 2],)) for i in range(self.number)]
        system = System([ground, *dominoes], gravity=_GRAVITY)
        dull, impact = EnergeticImpact(restitution=0.0), EnergeticImpact(self.restitution)
        for domino in dominoes:
            system.contact(ground, domino, normal=Unilateral(), friction=Coulomb(self.ground_friction), impact=dull)
        for one, two in itertools.pairwise(dominoes):
            system.contact(one, two, normal=Unilateral(), friction=Coulomb(self.friction), impact=impact)
        tilt = self.balance + self.lean
        c, s = math.cos(tilt), math.sin(tilt)
        place = 0.5 * (h - h * c + height * s), 0.5 * (h * s + height * c)
        system.place(dominoes[0], position=place, angle=tilt)
        for i, domino in enumerate(dominoes[1:], 1):
            system.place(domino, position=(i * self.pitch, 0.5 * height))
        return system

    def tilts(self, solution: Solution) -> Floats:
        """Return the angles of all dominoes over the samples [rad], shape [n_samples, n]."""
        return solution.q[:, 2::3]

    def strikes(self, solution: Solution) -> Floats:
        """Return when the second, the third, ... domino was struck [s]; dominoes that were not struck are left out."""
        events = solution.events
        moving = np.abs(events.u_after[:, 5::3]) > _MOVES
        struck = np.any(moving, axis=0)
        return np.asarray(events.time[np.argmax(moving[:, struck], axis=0)])

    def speeds(self, solution: Solution) -> Floats:
        """Return the speed of the wave from every domino to the next [m/s]."""
        return np.asarray(self.pitch / np.diff(self.strikes(solution)))

    def first_strike(self) -> float:
        """Return when the first domino, which turns about its edge, strikes the second [s]."""
        from scipy.integrate import quad

        # released at rest: I omega^2 / 2 = m g l (cos a - cos b), a and b the angles past the balance
        length = 0.5 * math.hypot(self.thickness, self.height)
        rate = 1.5 * _GRAVITY / length
        end = math.asin(self.spacing / self.height) - self.balance

        def slowness(x: float) -> float:
            # b = a + x^2 takes the root of the rate out of the start
            square = rate * math.sin(self.lean + 0.5 * x * x) * (math.sin(0.5 * x * x) / (x * x) if x > 0.0 else 0.5)
            return 2.0 / math.sqrt(2.0 * square)

        return float(quad(slowness, 0.0, math.sqrt(max(end - self.lean, 0.0)), epsabs=1e-13)[0])

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return tilt_1 ... tilt_n [rad] over the samples."""
        return {f"tilt_{i + 1}": tilt for i, tilt in enumerate(self.tilts(solution).T)}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return when each domino was struck [s], speeds of the wave [m/s], number of impacts, and losses [J]."""
        wave = {"strikes": self.strikes(solution).tolist(), "wave_speed": self.speeds(solution).tolist()}
        return {**wave, **super().summarise(solution)}

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: balance of energy, time of the first strike, and change of the wave's speed at the end."""
        account, speeds, strikes = solution.energy, self.speeds(solution), self.strikes(solution)
        found = []
        if account.loss > 0.0:
            name, ratio = "height and speed lost over losses booked", -account.change / account.loss
            found.append(Criterion.near(name, ratio, 1.0, 1e-3, "balance of energy"))
        if self.ground_friction >= 0.5:
            first, source = strikes[0] if len(strikes) > 0 else None, "fall of a body about its edge, by quadrature"
            found.append(Criterion.near("first strike [s]", first, self.first_strike(), 1e-9, source))
        if len(speeds) >= 12 and self.restitution == 0.0:
            name, source = (
                "speed of the wave over that one domino before",
                "Stronge 1987: the wave tends to a steady one",
            )
            found.append(Criterion.near(name, speeds[-1] / speeds[-2], 1.0, 5e-3, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return figures: "row", the dominoes at four instants, and "wave", the speed of the wave along the row."""
        return {"row": _row(self, solution), "wave": _wave({"": (self, solution)})}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the row, and the speed of the wave of rows with three distances."""
        rows = {f"distance {1e3 * gap:g} mm": cls(spacing=gap, t_end=0.66) for gap in (0.012, 0.016, 0.022)}
        runs = {label: (row, run(row)) for label, row in rows.items()}
        return {"row": _row(*runs["distance 16 mm"]), "wave": _wave(runs)}


def _row(scenario: Dominoes, solution: Solution) -> Figure:
    """Draw the dominoes from the side at four instants."""
    from matplotlib.patches import Polygon

    title = "Those that have fallen lean on the next and push on"
    figure, axes = charts.panels(4, 1, title, (7.2, 5.6), sharex=True, sharey=True)
    h, height = 1e3 * scenario.thickness, 1e3 * scenario.height
    corners = 0.5 * np.array([(-h, -height), (h, -height), (h, height), (-h, height)])
    right = 1e3 * scenario.pitch * (scenario.number - 1) + height
    for ax, share in zip(axes, (0.3, 0.55, 0.8, 1.0), strict=True):
        sample = min(int(share * len(solution.t)), len(solution.t) - 1)
        for x, z, tilt in solution.q[sample].reshape(-1, 3):
            c, s = np.cos(tilt), np.sin(tilt)
            turned = corners @ np.array([[c, -s], [s, c]]) + 1e3 * np.array([x, z])
            ax.add_patch(Polygon(turned, facecolor="0.85", edgecolor="black", linewidth=0.8))
        ax.axhline(0.0, color="black", linewidth=0.8)
        limits: dict[str, Any] = {"xlim": (-2.0 * h, right + h), "ylim": (-0.05 * height, 1.15 * height)}
        ax.set(aspect="equal", ylabel="z [mm]", **limits)
        ax.set_title(f"t = {1e3 * solution.t[sample]:.0f} ms", fontsize=9, loc="right")
    axes[-1].set_xlabel("x [mm]")
    return figure


def _wave(runs: Mapping[str, tuple[Dominoes, Solution]]) -> Figure:
    """Draw the speed of the wave from each domino to the next."""
    speeds = {name: scenario.speeds(solution) for name, (scenario, solution) in runs.items()}
    waves = {name: (np.arange(len(speed)) + 2, speed) for name, speed in speeds.items()}
    title, ylabel = "The wave grows to a steady speed", "speed from it to the next [m/s]"
    figure = charts.comparison({}, waves, "domino", ylabel, title)
    (ax,) = figure.axes
    for line in ax.lines:
        line.set_linestyle("-")
    ax.set_ylim(bottom=0.0)
    return figure
