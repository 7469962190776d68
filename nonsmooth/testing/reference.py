"""References for the checks: simple laws, impact problems, and independent integrations of motion."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from scipy.integrate import solve_ivp

from nonsmooth.interfaces import (
    FrictionLaw,
    ImpactLaw,
    ImpactMap,
    ImpactProcess,
    RigidNormalLaw,
    StatefulFrictionLaw,
    TractionLaw,
)
from nonsmooth.parameters import parameter
from nonsmooth.problems.impact import solve_impact
from nonsmooth.rotations import cross
from nonsmooth.testing.functions import compiled_caller, written
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber
from nonsmooth.testing.outcome import NotChecked
from nonsmooth.types import Array

_TOLERANCE = 1e-11
"""Relative tolerance of the integration of impacts, well below the deviations that the checks allow."""
StatefulLaw = StatefulFrictionLaw | TractionLaw
_EXACT, _STIFFLY = 1e-10, 1e-8
"""Relative tolerances of an explicit and of a stiff integration, below the deviations that the checks allow."""
_MOST_CALLS = 50_000
_STEP = 1e-6
"""Step of the differences that give the Jacobian of a motion, relative to the scales of its velocities and states."""
_SAME, _STEPS = 1e-5, 1e-7
"""Allowed difference of the velocities of two motions, relative to their change and relative to the speed; the sum of
both is allowed. The part relative to the speed allows for errors of the engine's steps if velocities hardly change."""


def _force(indentation: float) -> float:
    return indentation


def _efficiency(rate: float, share: float) -> float:
    return 1.0 if rate <= 0.0 else share


@final
@dataclass(frozen=True)
class ReferenceImpact(ImpactProcess):
    """A linear spring that gives back a share of the energy that it stores."""

    share: float = parameter(0.5, doc="share", minimum=0.0, maximum=1.0)
    contact_time = 2e-5
    force, efficiency = staticmethod(_force), staticmethod(_efficiency)

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """True if the returned energy is the law's share of the stored energy [J]."""
        return abs(returned - self.share * stored) <= tolerance


def _constant(speed: float, level: float) -> float:
    return level


@final
@dataclass(frozen=True)
class ReferenceFriction(FrictionLaw):
    """Friction with the same coefficient at every speed."""

    level: float = parameter(0.3, doc="coefficient", minimum=0.0)
    coefficient = staticmethod(_constant)

    def is_fulfilled(
        self, slip: tuple[float, float], normal_force: float, tangential_force: tuple[float, float], tolerance: float
    ) -> bool:
        """True if the friction force is at most mu times the normal force, within ``tolerance`` [N]."""
        return math.hypot(*tangential_force) <= self.level * normal_force + tolerance


@final
@dataclass(frozen=True)
class ReferenceContact(RigidNormalLaw):
    """A rigid contact by Signorini's law."""

    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        """True if acceleration and force are not negative, and at least one of them is zero."""
        return acceleration >= -tolerance and force >= -tolerance and min(abs(acceleration), abs(force)) <= tolerance


@final
@dataclass(frozen=True)
class ImpactProblem:
    """An impact of a rigid body with n contacts and n_u velocities.

    Attributes
    ----------
    mass : array
        Mass matrix M, shape [n_u, n_u].
    normal, tangential : array
        Generalised directions of the contacts: W of the normals, shape [n_u, n], and N of two tangents each, shape
        [n_u, n, 2].
    velocity : array
        Velocity before the impact, shape [n_u].
    """

    mass: Array
    normal: Array
    tangential: Array
    velocity: Array

    @property
    def n(self) -> int:
        """Number of contacts."""
        return int(self.normal.shape[1])

    @property
    def columns(self) -> Array:
        """Generalised directions of normal and two tangents of each contact in turn, shape [n_u, 3 n]."""
        joined = np.concatenate([self.normal[:, :, None], self.tangential], axis=2)
        return np.asarray(joined.reshape(len(self.mass), 3 * self.n))

    @property
    def delassus(self) -> Array:
        """Delassus matrix of all contacts, shape [3 n, 3 n]."""
        return np.asarray(self.columns.T @ np.linalg.solve(self.mass, self.columns))

    @property
    def rates(self) -> Array:
        """Gap rates and slip velocities before the impact [m/s], shape [3 n]."""
        return np.asarray(self.columns.T @ self.velocity)

    def energy(self, velocity: Array) -> float:
        """Kinetic energy at a velocity [J]."""
        return 0.5 * float(velocity @ self.mass @ velocity)

    def turned(self, angle: float) -> ImpactProblem:
        """Return the same problem with the tangents of all contacts turned by an angle [rad]."""
        c, s = math.cos(angle), math.sin(angle)
        tangential = self.tangential @ np.array([[c, -s], [s, c]])
        return ImpactProblem(self.mass, self.normal, tangential, self.velocity)


def problem_of(n_contacts: int) -> Drawn:
    """Return the inputs of an impact problem with ``n_contacts``; in the simplest the body falls straight down."""
    numbers = [DrawnNumber(f"velocity_{c}", -2.0, 2.0) for c in "xy"]
    numbers.append(DrawnNumber("velocity_z", -2.0, -0.1, -1.0))
    numbers += [DrawnNumber(f"spin_{c}", -1.0, 1.0) for c in "xyz"]
    for i in range(1, n_contacts + 1):
        numbers += [DrawnNumber(f"arm_{c}_{i}", -0.3, 0.3) for c in "xyz"]
        numbers += [DrawnNumber(f"lean_{c}_{i}", -0.4, 0.4) for c in "xy"]
    return Drawn(tuple(numbers), lambda case: problem(case, n_contacts))


def problem(case: Case, n_contacts: int) -> ImpactProblem:
    """Return the impact problem of an input."""
    normal, tangential = np.zeros((6, n_contacts)), np.zeros((6, n_contacts, 2))
    for i in range(n_contacts):
        place = np.array([0.0 if n_contacts == 1 else i - 0.5 * (n_contacts - 1), 0.1 * i, -0.5])
        arm = place + np.array([case[f"arm_{c}_{i + 1}"] for c in "xyz"])
        n = np.array([case[f"lean_x_{i + 1}"], case[f"lean_y_{i + 1}"], 1.0])
        n /= np.linalg.norm(n)
        first = np.array([1.0, 0.0, 0.0]) - n[0] * n
        first /= np.linalg.norm(first)
        columns = np.array([[*axis, *cross(arm, axis)] for axis in (n, first, cross(n, first))]).T
        normal[:, i], tangential[:, i] = columns[:, 0], columns[:, 1:]
    velocity = np.array([case[f"{name}_{c}"] for name in ("velocity", "spin") for c in "xyz"])
    return ImpactProblem(np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5]), normal, tangential, velocity)


def point(velocity: tuple[float, float, float]) -> ImpactProblem:
    """Return the impact of a point mass of 1 kg on a plane whose normal is z, at a velocity [m/s]."""
    return ImpactProblem(np.eye(3), np.eye(3)[:, 2:], np.eye(3)[:, None, :2], np.array(velocity))


@final
@dataclass(frozen=True)
class ImpactResponse:
    """The result of an impact.

    Attributes
    ----------
    velocity : array
        Velocity after the impact, shape [n_u].
    impulse, before, after : array
        Impulses [N s], and gap rates with slip velocities before and after the impact [m/s], shape [n, 3].
    stored, returned : array
        Energies that the contacts store and give back [J], shape [n]; zero if the law is an impact map, which computes
        impulses without energies.
    """

    velocity: Array
    impulse: Array
    before: Array
    after: Array
    stored: Array
    returned: Array

    @property
    def size(self) -> float:
        """Largest speed of the contacts before or after [m/s]."""
        return float(max(np.max(np.abs(self.before)), np.max(np.abs(self.after)), 1e-300))


def respond(laws: Sequence[ImpactLaw], frictions: Sequence[float], p: ImpactProblem) -> ImpactResponse:
    """Solve an impact with a law and a friction coefficient per contact."""
    n, before = p.n, p.rates
    stored, returned = np.zeros(n), np.zeros(n)
    processes = [law for law in laws if isinstance(law, ImpactProcess)]
    if processes:
        friction = [ReferenceFriction(mu) for mu in frictions]
        result = solve_impact(p.mass, p.normal, p.tangential, p.velocity, processes, friction, tolerance=_TOLERANCE)
        impulse = np.column_stack([result.normal_impulse, result.tangential_impulse])
        stored, returned = result.stored, result.returned
    else:
        impulse = map_impulses(laws, frictions, p.delassus, before).reshape(n, 3)
    velocity = p.velocity + np.linalg.solve(p.mass, p.columns) @ impulse.ravel()
    after = (p.columns.T @ velocity).reshape(n, 3)
    return ImpactResponse(velocity, impulse, before.reshape(n, 3), after, stored, returned)


def vectors_of(laws: Sequence[ImpactLaw], frictions: Sequence[float]) -> dict[str, Array]:
    """Return the parameters that the function ``impulses`` of an impact map may take, by name.

    Each is an array with one number per contact.
    """
    own = {name: np.array([float(law.numbers()[name]) for law in laws]) for name in laws[0].parameters()}
    return {"friction": np.array(frictions, dtype=float), **own}


def map_impulses(laws: Sequence[ImpactLaw], frictions: Sequence[float], delassus: Array, rates: Array) -> Array:
    """Return the impulses that an impact map, a law for all contacts at once, computes [N s], shape [3 n].

    It computes them from the Delassus matrix [1/kg] and from ``rates``, the gap rates and slip velocities before the
    impact [m/s].
    """
    law, out = laws[0], np.zeros(len(rates))
    assert isinstance(law, ImpactMap)
    call = compiled_caller(law.impulses, "map", vectors_of(laws, frictions), type(law).__name__)
    call(len(laws), np.ascontiguousarray(delassus).ravel(), np.array(rates, dtype=float), out)
    return out


def start_of(law: StatefulLaw) -> tuple[Array, Array]:
    """Return the initial states of a law, and their scales."""
    return np.array(law.initial_state, dtype=float), np.array(law.state_scale, dtype=float)


def start_fault(law: StatefulLaw) -> str:
    """Return a message if the initial states or scales of a law are invalid; "" if they are valid."""
    initial, scale = law.initial_state, law.state_scale
    if len(initial) != len(scale):
        return f"there are {len(initial)} initial states and {len(scale)} scales"
    if not np.all(np.isfinite(initial)):
        return f"the initial states are {tuple(initial)}"
    if not (np.all(np.isfinite(scale)) and all(one > 0.0 for one in scale)):
        return f"the scales are {tuple(scale)}, not all positive and finite"
    return ""


def require(fault: str) -> None:
    """Raise NotChecked if there is a fault that prevents further checks; "" stands for no fault."""
    if fault:
        raise NotChecked(f"not checked, as {fault}")


def writing_fault(call: Callable[..., Any], given: Sequence[Array], size: int) -> str:
    """Return a message if a function changes its arguments or leaves a number unwritten; "" otherwise."""
    copies = [one.copy() for one in given]
    one, other = (written(lambda out: call(*copies, out), size, old) for old in (0.5, -0.25))
    if any(not np.array_equal(a, b) for a, b in zip(given, copies, strict=True)):
        return "it changes what it is given, and may write to `out` only"
    for i in np.flatnonzero(one != other):
        return f"number {i} of what it writes is left from the call before"
    return ""


def followed(
    slope: Callable[[Array], Array], start: Array, scale: Array, times: Sequence[float], stiff: bool = False
) -> Array:
    """Integrate y' = slope(y) from y(0) = start; return y at ``times``, shape [n_times, n].

    ``times`` are ascending. ``scale`` is the usual size of each y; absolute errors are limited relative to it. If
    ``stiff`` is True, a method for stiff equations is used.
    """
    calls, exact = itertools.count(), _STIFFLY if stiff else _EXACT

    def counted(t: float, y: Array) -> Array:
        if next(calls) > _MOST_CALLS:
            raise ArithmeticError(f"{times[-1]:g} s of motion ask for more than {_MOST_CALLS} calls of the law")
        return slope(y)

    method, atol = "LSODA" if stiff else "DOP853", 1e-2 * exact * scale
    found = solve_ivp(counted, (0.0, times[-1]), start, method=method, rtol=exact, atol=atol, t_eval=times)
    if not found.success:
        raise ArithmeticError(f"the states cannot be integrated: {found.message}")
    return np.asarray(found.y.T)


def fastest(slope: Callable[[Array], Array], at: Array, scale: Array) -> float:
    """Return an upper bound of the rates at which solutions of y' = slope(y) change near a point [1/s].

    It is the largest row sum of the absolute Jacobian of ``slope``, computed by differences. Each number of y is
    measured in units of its entry of ``scale``.
    """
    if len(at) == 0:
        return 0.0
    base = slope(at)
    columns = [(slope(at + _STEP * scale * unit) - base) / (_STEP * scale) for unit in np.eye(len(at))]
    return float(np.max(np.sum(np.abs(columns), axis=0)))


def is_same_motion(given: Any, wanted: Any, start: Any, size: float) -> bool:
    """True if velocities ``given`` by the engine agree with velocities ``wanted`` of an independent integration.

    ``start`` holds the velocities at the start, ``size`` is their size.
    """
    change = float(np.max(np.abs(np.asarray(wanted) - start)))
    return bool(np.max(np.abs(np.asarray(given) - wanted)) <= _SAME * change + _STEPS * size)
