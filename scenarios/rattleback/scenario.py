"""The rattleback: an ellipsoid with skewed inertia that reverses its spin in one sense."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth import charts
from nonsmooth.bodies import Ellipsoid, Plate, Rest, RigidBody
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.parameters import parameter
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

from .rolling import contact_point, roll

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

GRAVITY = 9.81
_REVERSED = 10.0
"""Time after which the published body spins in the opposite sense [s]."""
_SIZE: Mapping[str, Any] = {"unit": "m", "above": 0.0, "usual": (1e-3, 1.0)}
_MOMENT: Mapping[str, Any] = {"unit": "kg m^2", "above": 0.0}


@final
@dataclass(frozen=True)
class Rattleback(Scenario):
    """Spun one way, an ellipsoid rattles, stops and spins back; spun the other way, it spins on.

    Its principal axes of inertia are turned against the axes of its surface.  Kane and Levinson let the same body roll;
    here it has Coulomb friction, so that it can slip.

    References
    ----------
    T. R. Kane, D. A. Levinson, "Realistic mathematical modeling of the rattleback", Int. J. Non-Linear Mechanics 17
    (1982) 175-186.
    """

    title: ClassVar[str] = "Rattleback"
    samples: ClassVar[int] = 4000
    coordinate_units: ClassVar[Mapping[str, str]] = {
        "x": "m",
        "y": "m",
        "z": "m",
        "pitch": "rad",
        "roll": "rad",
        "spin": "rad/s",
        "energy": "J",
    }
    units: ClassVar[Mapping[str, str]] = {
        "reversed": "s",
        "spin_start": "rad/s",
        "spin_least": "rad/s",
        "spin_most": "rad/s",
        "energy_lost": "J",
    }

    semi_x: float = parameter(0.2, doc="long semi-axis a", **_SIZE)
    semi_y: float = parameter(0.03, doc="semi-axis b across", **_SIZE)
    semi_z: float = parameter(0.02, doc="semi-axis c, upright", **_SIZE)
    offset: float = parameter(0.01, doc="centre of the ellipsoid over the mass centre h", unit="m")
    mass: float = parameter(1.0, doc="mass", unit="kg", above=0.0)
    moment_x: float = parameter(2e-4, doc="moment of inertia J_xx", **_MOMENT)
    moment_y: float = parameter(1.6e-3, doc="moment of inertia J_yy", **_MOMENT)
    moment_z: float = parameter(1.7e-3, doc="moment of inertia J_zz", **_MOMENT)
    product: float = parameter(-2e-5, doc="element J_xy of the tensor, the skew", unit="kg m^2")
    friction: float = parameter(1.0, doc="friction coefficient mu", minimum=0.0, usual=(0.01, 2.0), law="friction")
    restitution: float = parameter(
        0.0, doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0, law="impact"
    )
    spin: float = parameter(-5.0, doc="spin about the vertical at the start", unit="rad/s", usual=(0.1, 100.0))
    tilt: float = parameter(math.radians(0.5), doc="turn about the long axis at the start", unit="rad")
    t_end: float = parameter(20.0, doc="end time", unit="s", above=0.0, usual=(1e-3, 1e4))

    @property
    def semi(self) -> Floats:
        """Semi-axes [m], shape [3]."""
        return np.array([self.semi_x, self.semi_y, self.semi_z])

    @property
    def tensor(self) -> Floats:
        """Inertia tensor in body axes [kg m^2], shape [3, 3]."""
        return np.array(
            [[self.moment_x, self.product, 0.0], [self.product, self.moment_y, 0.0], [0.0, 0.0, self.moment_z]]
        )

    def build(self) -> System:
        """Return plane and ellipsoid at their start; the contact point has no velocity, as in rolling."""
        surface = Ellipsoid(self.semi_x, self.semi_y, self.semi_z, z=self.offset)
        body = RigidBody(self.mass, self.tensor.tolist(), (surface,))
        plane = Plate(Rest())
        friction = Coulomb(self.friction) if self.friction > 0.0 else Frictionless()
        system = System([plane, body], gravity=GRAVITY)
        system.contact(body, plane, normal=Unilateral(), friction=friction, impact=EnergeticImpact(self.restitution))
        n = self._normal
        low = contact_point(self.semi, self.offset, n)[0]
        velocity = -self.spin * np.cross(n, low)
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        system.place(
            body,
            position=(0.0, 0.0, -float(low @ n)),
            orientation=(math.cos(0.5 * self.tilt), math.sin(0.5 * self.tilt), 0.0, 0.0),
            velocity=(velocity[0], c * velocity[1] - s * velocity[2], 0.0),
            angular_velocity=tuple((self.spin * n).tolist()),
        )
        return system

    @property
    def _normal(self) -> Floats:
        """The upward normal in body axes at the start, shape [3]."""
        return np.array([0.0, math.sin(self.tilt), math.cos(self.tilt)])

    def normals(self, q: Floats) -> Floats:
        """Return the upward normal in body axes, shape [n, 3], at coordinates of shape [n, 7]."""
        a, b, c, d = q[:, 3:].T
        n: Floats = np.column_stack([2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d])
        n /= np.sum(q[:, 3:] ** 2, axis=1)[:, None]
        return n

    def spins(self, q: Floats, u: Floats) -> Floats:
        """Return the angular velocity about the vertical [rad/s], shape [n]."""
        spins: Floats = np.sum(self.normals(q) * u[:, 3:], axis=1)
        return spins

    def energies(self, q: Floats, u: Floats) -> Floats:
        """Return kinetic and potential energy, 0 at the height of the plane [J], shape [n]."""
        turning = np.sum(u[:, 3:] @ self.tensor * u[:, 3:], axis=1)
        energies: Floats = 0.5 * (self.mass * np.sum(u[:, :3] ** 2, axis=1) + turning) + self.mass * GRAVITY * q[:, 2]
        return energies

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return x, y, z [m], pitch of the long axis and roll [rad], spin [rad/s], energy [J] over the samples."""
        q, u = solution.q, solution.u
        n = self.normals(q)
        return {
            **{name: q[:, i] for i, name in enumerate("xyz")},
            "pitch": np.arcsin(n[:, 0]),
            "roll": np.arctan2(n[:, 1], n[:, 2]),
            "spin": self.spins(q, u),
            "energy": self.energies(q, u),
        }

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return when the spin is turned round first [s], its extremes [rad/s], oscillations of pitch, energy lost [J].

        ``oscillations`` are half the passes of the long axis through the horizontal.
        """
        spin, pitch = self.spins(solution.q, solution.u), self.normals(solution.q)[:, 0]
        turned = np.flatnonzero(spin * spin[0] < 0.0)
        return {
            "reversed": float(solution.t[turned[0]]) if len(turned) > 0 else None,
            "spin_start": float(spin[0]),
            "spin_least": float(np.min(spin)),
            "spin_most": float(np.max(spin)),
            "oscillations": int(np.count_nonzero(pitch[1:] * pitch[:-1] < 0.0)) // 2,
            "energy_lost": solution.energy.loss,
        }

    def rolls(self, solution: Solution) -> bool:
        """Return whether the body has rolled without slipping or leaving the plane all the time."""
        return bool(np.all(solution.events.after == 1))

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """Return energy and deviation from the equations of rolling while it rolls; the published body's reversal."""
        found = []
        if self.rolls(solution):
            energy = self.energies(solution.q, solution.u)
            change = float(np.ptp(energy) / abs(energy[0]))
            found.append(Criterion("change of the energy", change, 0.0, 1e-7, "rolling does no work"))
            few = slice(None, None, 20)
            n = self._normal
            body = (self.semi, self.offset, self.mass, self.tensor)
            normals, turning = roll(*body, GRAVITY, n, self.spin * n, solution.t[few])
            spin = np.sum(normals * turning, axis=1)
            worst = float(np.max(np.abs(spin - self.spins(solution.q, solution.u)[few])) / abs(self.spin))
            name = "deviation of the spin from the equations of rolling"
            found.append(Criterion(name, worst, 0.0, 1e-3, "scipy, DOP853"))
        if self == Rattleback(t_end=self.t_end) and self.t_end >= _REVERSED:
            most = self.summarise(solution)["spin_most"]
            source = "Kane and Levinson (1982): it spins back"
            found.append(Criterion("largest spin the other way [rad/s]", most, 4.5, 5.01, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return spin, pitch and roll over time."""
        return {"history": _history(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the history of the published body, and its spin for starts in either sense and for less friction."""
        published = cls()
        senses = {f"{spin:+g} rad/s": cls(spin=spin, t_end=60.0) for spin in (-5.0, 5.0)}
        frictions = {f"mu = {mu:g}": cls(friction=mu) for mu in (1.0, 0.5, 0.3, 0.2)}
        return {
            "history": _history(published, run(published)),
            "sense": _spins(senses, run, "In one sense it rattles and reverses, in the other it spins on for long"),
            "friction": _spins(frictions, run, "If it slips while it rattles, it comes back slower"),
        }


def _history(scenario: Rattleback, solution: Solution) -> Figure:
    """Draw spin, pitch and roll over time."""
    reversed_at = scenario.summarise(solution)["reversed"]
    title = "The spin is not reversed" if reversed_at is None else f"The spin is reversed after {reversed_at:.1f} s"
    found = scenario.coordinates(solution)
    values = {
        "spin [rad/s]": found["spin"],
        "pitch of the\nlong axis [deg]": np.degrees(found["pitch"]),
        "roll about the\nlong axis [deg]": np.degrees(found["roll"]),
    }
    figure = charts.histories({label: {"": (solution.t, x)} for label, x in values.items()}, title)
    figure.axes[0].axhline(0.0, color="0.6", linewidth=0.8)
    for ax in figure.axes[1:]:
        ax.lines[0].set_linewidth(0.7)  # a hundred oscillations can only be distinguished in thin lines
    return figure


def _spins(scenarios: Mapping[str, Rattleback], run: Run, title: str) -> Figure:
    """Draw the spin of several bodies over time."""
    runs = {label: (one, run(one)) for label, one in scenarios.items()}
    spins = {label: (found.t, one.coordinates(found)["spin"]) for label, (one, found) in runs.items()}
    figure = charts.histories({"spin about the vertical [rad/s]": spins}, title)
    figure.axes[0].axhline(0.0, color="0.6", linewidth=0.8)
    return figure
