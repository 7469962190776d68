"""The tippe top: a spinning body of two spheres that friction turns over."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Plate, Rest, RigidBody, Sphere
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Criterion, FrictionLaw, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from .friction import SpinningCoulomb

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

GRAVITY = 9.81
_INVERTED = 8.0
"""Time after which the published top, the default, stands on its stem [s]."""
_SHORT = 5.0
"""End time of the gallery's runs with other friction or spin [s]."""


@final
@dataclass(frozen=True)
class TippeTop(Scenario):
    """A tippe top turns over and stands on its stem.

    The mass centre is below the centre of the large sphere.  Friction acts in a small contact disc that spins
    (:class:`SpinningCoulomb`), or by Coulomb's law at a point if the disc's radius is zero.  Leine and Glocker
    also have a friction moment of the disc against drilling, which this model omits.

    References
    ----------
    R. I. Leine, Ch. Glocker, "A set-valued force law for spatial Coulomb-Contensou friction", Eur. J. Mech. A/Solids
    22 (2003) 193-216.
    """

    title: ClassVar[str] = "Tippe top"
    samples: ClassVar[int] = 4000
    coordinate_units: ClassVar[Mapping[str, str]] = {
        "x": "m",
        "y": "m",
        "z": "m",
        "tilt": "rad",
        "spin_vertical": "rad/s",
        "spin_axis": "rad/s",
        "slip_body": "m/s",
        "slip_stem": "m/s",
    }
    units: ClassVar[Mapping[str, str]] = {
        "stem_down": "s",
        "body_up": "s",
        "tilt": "rad",
        "spin_vertical": "rad/s",
        "spin_axis": "rad/s",
        "energy_lost": "J",
    }

    mass: float = parameter(6e-3, doc="mass", unit="kg", above=0.0, usual=(1e-4, 10.0))
    across: float = parameter(8e-7, doc="moment of inertia I_1 across the axis", unit="kg m^2", above=0.0)
    along: float = parameter(7e-7, doc="moment of inertia I_3 about the axis", unit="kg m^2", above=0.0)
    body_offset: float = parameter(3e-3, doc="centre of the large sphere over the mass centre, a_1", unit="m")
    stem_offset: float = parameter(16e-3, doc="centre of the small sphere over the mass centre, a_2", unit="m")
    body_radius: float = parameter(15e-3, doc="radius of the large sphere, r_1", unit="m", above=0.0)
    stem_radius: float = parameter(5e-3, doc="radius of the small sphere, r_2", unit="m", above=0.0)
    friction: float = parameter(0.3, doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), law="friction")
    contact_radius: float = parameter(
        0.5e-3,
        doc="radius R of the contact disc, 0 for a point",
        unit="m",
        minimum=0.0,
        usual=(1e-6, 1e-2),
        law="friction",
    )
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    tilt: float = parameter(0.1, doc="angle of the axis from the vertical at the start", unit="rad")
    spin: float = parameter(180.0, doc="spin about the axis at the start", unit="rad/s", usual=(1.0, 1e3))
    t_end: float = parameter(8.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e4))

    def _check(self) -> None:
        body = self.body_radius - self.body_offset * math.cos(self.tilt)
        stem = self.stem_radius - self.stem_offset * math.cos(self.tilt)
        if stem > body:
            raise InvalidInput(
                "TippeTop.tilt",
                "must let the top start on its large sphere",
                self.tilt,
                f"The small sphere would reach {stem - body:.3g} m deeper: take a smaller angle [rad].",
            )

    def friction_law(self) -> FrictionLaw:
        """Return the law of friction on the plane: at a point, or over a contact disc that spins as at the start."""
        if self.friction == 0.0:
            return Frictionless()
        if self.contact_radius == 0.0 or self.spin == 0.0:
            return Coulomb(self.friction)
        return SpinningCoulomb(self.friction, 8.0 / (3.0 * math.pi) * self.contact_radius * abs(self.spin))

    def build(self) -> System:
        """Return plane and top at their start."""
        spheres = Sphere(self.body_radius, z=self.body_offset), Sphere(self.stem_radius, z=self.stem_offset)
        top = RigidBody(self.mass, (self.across, self.across, self.along), spheres)
        plane = Plate(Rest())
        system = System([plane, top], gravity=GRAVITY)
        friction, impact = self.friction_law(), EnergeticImpact(self.restitution)
        system.contact(top, plane, normal=Unilateral(), friction=friction, impact=impact)
        system.place(
            top,
            position=(0.0, 0.0, self.body_radius - self.body_offset * math.cos(self.tilt)),
            orientation=(math.cos(self.tilt / 2.0), math.sin(self.tilt / 2.0), 0.0, 0.0),
            angular_velocity=(0.0, 0.0, self.spin),
        )
        return system

    def axes(self, q: Floats) -> Floats:
        """Return the top's axis, from body to stem, shape [n, 3], at coordinates of shape [n, 7]."""
        a, b, c, d = q[:, 3:].T
        axis: Floats = np.column_stack([2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a - b * b - c * c + d * d])
        axis /= np.sum(q[:, 3:] ** 2, axis=1)[:, None]
        return axis

    def tilts(self, q: Floats) -> Floats:
        """Return the angle of the axis from the vertical [rad], shape [n]."""
        axis = self.axes(q)
        tilt: Floats = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
        return tilt

    def momentum(self, q: Floats, u: Floats) -> Floats:
        """Return the angular momentum about the mass centre, in world axes [kg m^2/s], shape [n, 3]."""
        along = u[:, 5:6] * self.axes(q)
        momentum: Floats = self.across * (self._turning(q, u) - along) + self.along * along
        return momentum

    def jellett(self, q: Floats, u: Floats) -> Floats:
        """Return Jellett's quantity L . (r_1 e_z - a_1 axis) [kg m^3/s], shape [n].

        The vector goes from the contact point of the large sphere to the mass centre, so that no force in that point
        has a moment along it; the quantity stays as long as the large sphere alone touches the plane.
        """
        lever = np.array([0.0, 0.0, self.body_radius]) - self.body_offset * self.axes(q)
        integral: Floats = np.sum(self.momentum(q, u) * lever, axis=1)
        return integral

    def slips(self, q: Floats, u: Floats) -> Floats:
        """Return the slip speeds of large and small sphere at their lowest points [m/s], shape [n, 2]."""
        turning, axis = self._turning(q, u), self.axes(q)
        found = []
        for offset, radius in ((self.body_offset, self.body_radius), (self.stem_offset, self.stem_radius)):
            lowest = offset * axis - np.array([0.0, 0.0, radius])
            velocity = u[:, :3] + np.cross(turning, lowest)
            found.append(np.hypot(velocity[:, 0], velocity[:, 1]))
        return np.column_stack(found)

    def gaps(self, q: Floats) -> Floats:
        """Return the gaps of large and small sphere [m], shape [n, 2]."""
        height = self.axes(q)[:, 2]
        body = q[:, 2] + self.body_offset * height - self.body_radius
        stem = q[:, 2] + self.stem_offset * height - self.stem_radius
        return np.column_stack([body, stem])

    def _turning(self, q: Floats, u: Floats) -> Floats:
        """Return the angular velocity in world axes [rad/s], shape [n, 3]."""
        a, vector, own = q[:, 3:4], q[:, 4:7], u[:, 3:]
        scale = np.sum(q[:, 3:] ** 2, axis=1)[:, None]
        turned: Floats = own + 2.0 * np.cross(vector, np.cross(vector, own) + a * own) / scale
        return turned

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y, z [m], tilt [rad], spins about vertical and axis [rad/s], slips [m/s] over the samples."""
        q, u = solution.q, solution.u
        slips = self.slips(q, u)
        return {
            **dict(zip("xyz", q.T, strict=False)),
            "tilt": self.tilts(q),
            "spin_vertical": self._turning(q, u)[:, 2],
            "spin_axis": u[:, 5],
            "slip_body": slips[:, 0],
            "slip_stem": slips[:, 1],
        }

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return whether and when [s] the top inverted, its last tilt [rad] and spins [rad/s], and the energy lost [J].

        ``inverted`` is True if the axis points down within 0.1 rad at the end.  ``stem_down`` is the time at which the
        stem first touches, ``body_up`` the time at which the large sphere leaves for good.
        """
        events = solution.events
        touching = events.after & 1
        q, u = solution.q_end[None], solution.u_end[None]
        stem = events.time[touching[:, 1] == 1]
        leaves = np.flatnonzero((touching[:-1, 0] == 1) & (touching[1:, 0] == 0)) + 1
        tilt = float(self.tilts(q)[0])
        return {
            "inverted": bool(tilt > math.pi - 0.1),
            "stem_down": float(stem[0]) if len(stem) > 0 else None,
            "body_up": float(events.time[leaves[-1]]) if len(leaves) > 0 and touching[-1, 0] == 0 else None,
            "tilt": tilt,
            "spin_vertical": float(self._turning(q, u)[0, 2]),
            "spin_axis": float(u[0, 5]),
            "energy_lost": solution.energy.loss,
        }

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return criteria: change of Jellett's quantity before the stem touches; last tilt of the published top."""
        summary = self.summarise(solution)
        before = solution.t < (math.inf if summary["stem_down"] is None else summary["stem_down"])
        jellett = self.jellett(solution.q[before], solution.u[before])
        change = float(np.ptp(jellett) / abs(jellett[0]))
        source = "Jellett's integral: no moment along the line from the contact point to the mass centre"
        found = [Criterion("change of Jellett's quantity before the stem touches", change, 0.0, 1e-7, source)]
        if self.t_end >= _INVERTED and dataclasses.replace(self, t_end=_INVERTED) == TippeTop(t_end=_INVERTED):
            source = "Leine and Glocker (2003): the top turns over"
            found.append(Criterion("tilt at the end [rad]", summary["tilt"], math.pi - 0.1, math.pi, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return tilt, spins and slip over time."""
        return {"history": _history(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return tilt, spins and slip of the published top over time, and tilts for other contact radii and spins."""
        top = cls()
        discs = {"friction at a point": cls(contact_radius=0.0, t_end=_SHORT)}
        discs |= {f"R = {1e3 * r:g} mm": cls(contact_radius=r, t_end=_SHORT) for r in (0.05e-3, 0.1e-3, 0.5e-3, 2e-3)}
        spins = {f"{spin:g} rad/s": cls(spin=spin, t_end=_SHORT) for spin in (20.0, 60.0, 100.0, 150.0, 180.0)}
        rolls = "Friction at a point makes the top roll, and it stays upright; a spinning disc lets it slip"
        rises = "A fast top rises onto its stem, slower ones come to lean, a slow one does not turn"
        return {
            "history": _history(top, run(top)),
            "contact_radius": _tilts(discs, run, rolls),
            "spin": _tilts(spins, run, rises),
        }


def _history(top: TippeTop, solution: Solution) -> Figure:
    """Draw tilt, spins and slip speeds over time, and when the stem touches."""
    found, summary, t = top.coordinates(solution), top.summarise(solution), solution.t
    touching = np.abs(top.gaps(solution.q)) < 1e-9
    title = "The top does not turn over"
    if summary["inverted"]:
        title = "The top turns over and stands on its stem: the spin about its axis changes sign"
    figure, axes = charts.panels(3, 1, title, (7.2, 7.2), sharex=True)
    spins = {"about the vertical": (t, found["spin_vertical"]), "about the top's axis": (t, found["spin_axis"])}
    slips = {
        f"{name} on the plane": (t, np.where(touching[:, i], found[f"slip_{name}"], np.nan))
        for i, name in enumerate(("body", "stem"))
    }
    tilt = {"": (t, np.degrees(found["tilt"]))}
    panels = {"tilt of the axis [deg]": tilt, "angular velocity [rad/s]": spins, "slip speed [m/s]": slips}
    charts.histories(panels, axes=axes)
    axes[0].set_yticks(range(0, 181, 45))
    for ax in axes:
        if summary["stem_down"] is not None:
            ax.axvline(summary["stem_down"], color="0.5", linewidth=0.8, linestyle=":", label="the stem touches")
    for ax in axes[1:]:
        ax.legend(fontsize=8, frameon=False, loc="upper right")
    return figure


def _tilts(tops: Mapping[str, TippeTop], run: Run, title: str) -> Figure:
    """Draw the tilt of several tops over time."""
    runs = {label: (top, run(top)) for label, top in tops.items()}
    tilts = {label: (found.t, np.degrees(top.tilts(found.q))) for label, (top, found) in runs.items()}
    figure = charts.histories({"tilt of the axis [deg]": tilts}, title)
    figure.axes[0].set_yticks(range(0, 181, 45))
    return figure
