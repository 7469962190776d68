"""The spinning egg: it stands up because it slips, although its mass centre has to rise."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import EllipsoidBody, Plate, Rest
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

GRAVITY = 9.81
_RISEN = 4.0
"""Time after which the egg of the default parameters is upright [s]."""
_UPRIGHT = math.radians(10.0)
"""Largest tilt of an upright egg [rad]."""


@final
@dataclass(frozen=True)
class EggOnTable(Scenario):
    """A hard-boiled egg spins on a table and stands up.

    References
    ----------
    H. K. Moffatt, Y. Shimomura, "Spinning eggs - a paradox resolved", Nature 416 (2002) 385-386.
    Y. Shimomura, M. Branicki, H. K. Moffatt, "Dynamics of an axisymmetric body spinning on a horizontal surface. II.
    Self-induced jumping", Proc. R. Soc. A 461 (2005) 1753-1774.
    """

    title: ClassVar[str] = "Egg on a table"
    samples: ClassVar[int] = 8000
    coordinate_units: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("x", "y", "z", "gap"), "m"),
        "tilt": "rad",
        "spin": "rad/s",
        "slip": "m/s",
        "jellett": "kg m^3/s",
    }
    units: ClassVar[Mapping[str, str]] = {"upright": "s", "tilt": "rad", "spin": "rad/s", "energy_lost": "J"}

    semi_long: float = parameter(0.03, doc="semi-axis of revolution a", unit="m", above=0.0, usual=(1e-3, 1.0))
    semi_across: float = parameter(0.022, doc="semi-axis across b", unit="m", above=0.0, usual=(1e-3, 1.0))
    mass: float = parameter(0.06, doc="mass", unit="kg", above=0.0)
    friction: float = parameter(0.1, doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), law="friction")
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    spin: float = parameter(140.0, doc="spin about the vertical at the start", unit="rad/s", usual=(1.0, 1e3))
    tilt: float = parameter(
        math.radians(85.0), doc="angle of the axis from the vertical at the start", unit="rad", minimum=0.0, maximum=3.2
    )
    t_end: float = parameter(4.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e4))

    def body(self) -> EllipsoidBody:
        """Return the egg, its long axis the third."""
        return EllipsoidBody(self.semi_across, self.semi_across, self.semi_long, mass=self.mass)

    def build(self) -> System:
        """Return table and egg at their start: it spins about the vertical through its mass centre at rest."""
        egg, table = self.body(), Plate(Rest())
        friction = Coulomb(self.friction) if self.friction > 0.0 else Frictionless()
        system = System([table, egg], gravity=GRAVITY)
        system.contact(egg, table, normal=Unilateral(), friction=friction, impact=EnergeticImpact(self.restitution))
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        system.place(
            egg,
            position=(0.0, 0.0, math.hypot(self.semi_across * s, self.semi_long * c)),
            orientation=(math.cos(0.5 * self.tilt), math.sin(0.5 * self.tilt), 0.0, 0.0),
            angular_velocity=(0.0, self.spin * s, self.spin * c),
        )
        return system

    def normals(self, q: Floats) -> Floats:
        """Return the upward normal in body axes, shape [n, 3], for coordinates of shape [n, 7]."""
        a, b, c, d = q[:, 3:].T
        n = np.column_stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d])
        return np.asarray(n / np.sum(q[:, 3:] ** 2, axis=1)[:, None])

    def tilts(self, q: Floats) -> Floats:
        """Return the angle between axis and vertical [rad], 0 to pi/2, the same for either end up, shape [n]."""
        n = self.normals(q)
        return np.asarray(np.arctan2(np.hypot(n[:, 0], n[:, 1]), np.abs(n[:, 2])))

    def levers(self, q: Floats) -> Floats:
        """Return the vector from the lowest point to the mass centre in body axes [m], shape [n, 3]."""
        stretched = self.normals(q) * np.array([self.semi_across, self.semi_across, self.semi_long]) ** 2
        return np.asarray(stretched / np.sqrt(np.sum(stretched * self.normals(q), axis=1))[:, None])

    def jellett(self, q: Floats, u: Floats) -> Floats:
        """Return L_z h, angular momentum about the vertical times height of the mass centre [kg m^3/s], shape [n].

        For a fast spin it is the quantity A Omega h of Moffatt and Shimomura, which is constant while the egg rises.
        """
        n = self.normals(q)
        heights = np.sum(self.levers(q) * n, axis=1)
        return np.asarray(np.sum(u[:, 3:] * np.array(self.body().inertia) * n, axis=1) * heights)

    def upright_spin(self) -> float:
        """Return the spin of the egg [rad/s] when it is upright, if L_z h (:meth:`jellett`) remains constant.

        For an egg that starts on its side (tilt of 90 degrees) it is A b / (C a) times the spin at the start.  A and C
        are the moments of inertia across and along the long axis, b and a the semi-axes across and along.
        """
        across, _, along = self.body().inertia
        height = math.hypot(self.semi_across * math.sin(self.tilt), self.semi_long * math.cos(self.tilt))
        start = across * math.sin(self.tilt) ** 2 + along * math.cos(self.tilt) ** 2
        return self.spin * start * height / (along * self.semi_long)

    def gaps(self, q: Floats) -> Floats:
        """Return the gap between egg and table [m], shape [n]."""
        return np.asarray(q[:, 2] - np.sum(self.levers(q) * self.normals(q), axis=1))

    def slips(self, q: Floats, u: Floats) -> Floats:
        """Return the slip speed of the lowest point [m/s], shape [n]."""
        a, vector = q[:, 3:4], q[:, 4:7]
        own = np.cross(u[:, 3:], -self.levers(q))
        scale = np.sum(q[:, 3:] ** 2, axis=1)[:, None]
        velocity = u[:, :3] + own + 2.0 * np.cross(vector, np.cross(vector, own) + a * own) / scale
        return np.asarray(np.hypot(velocity[:, 0], velocity[:, 1]))

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y, z [m], tilt [rad], vertical spin [rad/s], slip [m/s], gap [m], L_z h over the samples."""
        q, u = solution.q, solution.u
        return {
            **{name: q[:, i] for i, name in enumerate("xyz")},
            "tilt": self.tilts(q),
            "spin": np.sum(self.normals(q) * u[:, 3:], axis=1),
            "slip": self.slips(q, u),
            "gap": self.gaps(q),
            "jellett": self.jellett(q, u),
        }

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return when the egg is upright [s], tilt [rad] and spin [rad/s] at the end, number of flights, losses [J].

        It is upright from the time at which its axis remains within 10 degrees of the vertical.
        """
        tilt = self.tilts(solution.q)
        leaning = np.flatnonzero(tilt > _UPRIGHT)
        last = int(leaning[-1]) if len(leaning) > 0 else -1
        touching = solution.events.after[:, 0] & 1
        return {
            "upright": float(solution.t[last + 1]) if last + 1 < len(tilt) else None,
            "tilt": float(tilt[-1]),
            "spin": float(np.sum(self.normals(solution.q_end[None]) * solution.u_end[None, 3:])),
            "flights": int(np.count_nonzero((touching[:-1] == 1) & (touching[1:] == 0))),
            "energy_lost": solution.energy.loss,
        }

    def balance(self, solution: Solution) -> float:
        """Return the largest deviation of L . r from its balance over the samples, relative to L . r at the start.

        L is the angular momentum about the mass centre, r the vector from the contact point to the mass centre.  A
        force in the contact point has no moment along r, so that L . r changes only by the integral of L . r' over
        time.  The integral is taken of a spline through the samples.
        """
        from scipy.interpolate import CubicSpline

        lever = self.levers(solution.q)
        momentum = solution.u[:, 3:] * np.array(self.body().inertia)
        product = np.sum(momentum * lever, axis=1)
        # both in body axes, in which a fixed vector turns against the body
        rate = CubicSpline(solution.t, lever).derivative()(solution.t) + np.cross(solution.u[:, 3:], lever)
        gained = CubicSpline(solution.t, np.sum(momentum * rate, axis=1)).antiderivative()(solution.t)
        return float(np.max(np.abs(product - product[0] - gained)) / abs(product[0]))

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: the balance of angular momentum; for the default egg also tilt and spin at the end."""
        source = "no moment along the line from the contact point to the mass centre"
        found = [Criterion("change of L . r that is none of r", self.balance(solution), 0.0, 1e-4, source)]
        if self.t_end >= _RISEN and dataclasses.replace(self, t_end=_RISEN) == EggOnTable(t_end=_RISEN):
            summary = self.summarise(solution)
            source = "Moffatt and Shimomura (2002): the egg rises"
            found.append(Criterion("tilt at the end [rad]", summary["tilt"], 0.0, _UPRIGHT, source))
            source = "A Omega h stays: A b / (C a) of that at the start"
            part = summary["spin"] / self.upright_spin()
            found.append(Criterion("spin at the end over that of Jellett's constant", part, 0.97, 1.03, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return tilt, spin, slip and Jellett's constant over time."""
        return {"history": _history(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the history of the default egg, the tilt for other friction and spins, and the jumps of a fast egg."""
        frictions = {f"μ = {mu:g}": cls(friction=mu) for mu in (0.0, 0.05, 0.1, 0.2)}
        spins = {f"{spin:g} rad/s": cls(spin=spin) for spin in (40.0, 80.0, 140.0, 250.0)}
        fast, egg = cls(spin=250.0, t_end=2.0), cls()
        return {
            "history": _history(egg, run(egg)),
            "friction": _tilts(frictions, run, "Without friction it keeps its tilt; with more of it it rises faster"),
            "spin": _tilts(spins, run, "A slow egg stays down, a fast one rises"),
            "jumps": _jumps(fast, run(fast)),
        }


def _history(scenario: EggOnTable, solution: Solution) -> Figure:
    """Draw tilt, spin, slip and Jellett's constant over time."""
    numbers = scenario.coordinates(solution)
    values = {
        "tilt of the axis [deg]": np.degrees(numbers["tilt"]),
        "spin about\nthe vertical [rad/s]": numbers["spin"],
        "slip [m/s]": numbers["slip"],
        "$L_z h$ over its start": numbers["jellett"] / numbers["jellett"][0],
    }
    upright = scenario.summarise(solution)["upright"]
    title = "The egg does not stand up" if upright is None else f"The egg stands up within {upright:.1f} s"
    figure = charts.histories({label: {"": (solution.t, value)} for label, value in values.items()}, title)
    tilt, spin, _, constant = figure.axes
    tilt.set(ylim=(0.0, 90.0), yticks=range(0, 91, 30))
    spin.axhline(scenario.upright_spin(), label="upright, by constant $A\\Omega h$", **charts.line(1))
    low, high = constant.get_ylim()
    constant.set_ylim(min(0.95, low), max(1.05, high))
    charts.legend(figure)
    return figure


def _tilts(eggs: Mapping[str, EggOnTable], run: Run, title: str) -> Figure:
    """Draw the tilts of several eggs over time."""
    runs = {label: run(egg) for label, egg in eggs.items()}
    tilts = {label: (solution.t, np.degrees(eggs[label].tilts(solution.q))) for label, solution in runs.items()}
    figure = charts.histories({"tilt of the axis [deg]": tilts}, title)
    figure.axes[0].set(ylim=(0.0, 92.0), yticks=range(0, 91, 30))
    return figure


def _jumps(scenario: EggOnTable, solution: Solution) -> Figure:
    """Draw gap and tilt over time."""
    gaps, tilts = 1e3 * scenario.gaps(solution.q), np.degrees(scenario.tilts(solution.q))
    flights = scenario.summarise(solution)["flights"]
    title = f"Spun at {scenario.spin:g} rad/s the egg leaves the table {flights} times while it rises"
    panels = {"gap [mm]": {"": (solution.t, gaps)}, "tilt of the axis [deg]": {"": (solution.t, tilts)}}
    return charts.histories(panels, title)
