"""The rattleback: an ellipsoid with skewed inertia that spins one way only."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from bodies import Ellipsoid, Plate, Rest, RigidBody
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.interfaces import Criterion, Run, Scenario
from nonsmooth.parameters import parameter, rules
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from scenarios.rattleback.rolling import contact_point, roll

Floats = NDArray[np.float64]

GRAVITY = 9.81
_SAMPLES = 4000
_REVERSED = 10.0
"""After which the published body spins the other way [s]."""
_SIZE: Mapping[str, Any] = {"unit": "m", "above": 0.0, "usual": (1e-3, 1.0)}
_MOMENT: Mapping[str, Any] = {"unit": "kg m^2", "above": 0.0}


@final
@dataclass(frozen=True)
class Rattleback(Scenario):
    """An ellipsoid on a plane whose principal axes of inertia are turned against those of its surface.

    Spun against its sense it begins to rattle, stops and spins back.  The body is that of Kane and Levinson; friction
    is Coulomb's, so that the body need not roll.

    References
    ----------
    T. R. Kane, D. A. Levinson, "Realistic mathematical modeling of the rattleback", Int. J. Non-Linear Mechanics 17
    (1982) 175-186.
    """

    title: ClassVar[str] = "Rattleback"
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

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    @property
    def sample_interval(self) -> float:
        """A four-thousandth of the run [s]."""
        return self.t_end / _SAMPLES

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
        """Return plane and ellipsoid at their start, which is one of rolling."""
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
        """Return the upward normal in body axes, in states of the run, shape [n, 7] -> [n, 3]."""
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

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return {q, u} at the end: position and quaternion, velocity and angular velocity in body axes."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

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
            normals, turning = roll(
                self.semi, self.offset, self.mass, self.tensor, GRAVITY, n, self.spin * n, solution.t[few]
            )
            spin = np.sum(normals * turning, axis=1)
            worst = float(np.max(np.abs(spin - self.spins(solution.q, solution.u)[few])) / abs(self.spin))
            found.append(
                Criterion("deviation of the spin from the equations of rolling", worst, 0.0, 1e-3, "scipy, DOP853")
            )
        if self == Rattleback(t_end=self.t_end) and self.t_end >= _REVERSED:
            most = self.summarise(solution)["spin_most"]
            source = "Kane and Levinson (1982): it spins back"
            found.append(Criterion("largest spin the other way [rad/s]", most, 4.5, 5.01, source))
        return tuple(found)

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return spin, pitch and roll over time."""
        from scenarios.rattleback.figures import history

        return {"history": history(self, solution)}

    @classmethod
    def gallery(cls, run: Run) -> Mapping[str, Any]:
        """Return the history of the published body, and the spin for either sense and other friction."""
        from scenarios.rattleback.figures import gallery

        return gallery(cls, run)
