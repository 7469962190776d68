"""Whether the forces and impulses that a run reports are within the cones of their contacts' laws.

Normal forces push, except those of ``Cohesive``.  Friction is at most the law's coefficient times the normal force; for
``Anisotropic`` and ``Directional`` the largest coefficient counts.  Three laws have no bound here: the coefficient of
``RateAndState`` depends on an age that a run does not report, and the damping of ``Bristle`` and ``CoulombContensou``
may exceed mu N.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from laws import Anisotropic, Cohesive, Coulomb, Directional, Frictionless, Stribeck, Viscous
from nonsmooth import ContactLaws
from nonsmooth.histories.contacts import ClosedContacts
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.interfaces.body import Vector
from nonsmooth.solution.checks import impulses_beyond_cone
from tests.benchmarks.random_systems.case import Case

_SLIPS = 1e-4
"""Slip [m/s] above which Coulomb's kinetic coefficient counts."""
_BEYOND = 1e-6
"""Part of the largest normal force of an instant by which a force may be outside of its cone."""
_FLOOR = 1e-9
"""Part of all weights, and of what stops all bodies during the run, by which it may be as well."""
_MOST = 40
"""Samples whose forces are judged."""

_COEFFICIENTS: dict[type, Callable[[Any, float], float]] = {
    Frictionless: lambda law, speed: 0.0,
    Coulomb: lambda law, speed: law.friction if speed > _SLIPS else max(law.friction, law.static_friction or 0.0),
    Stribeck: lambda law, v: law.fast_friction + (law.static_friction - law.fast_friction) / (1.0 + law.decay * v),
    Viscous: lambda law, speed: min(law.friction + law.growth * speed, law.largest) if law.growth else law.friction,
    Anisotropic: lambda law, speed: max(law.along, law.across),
    Directional: lambda law, speed: max(law.forward, law.backward, law.across),
}
"""Coefficient of a law at a slip speed [m/s]."""


def coefficient(law: Any, speed: float) -> float:
    """Return the coefficient of a law at a slip speed [m/s]; infinity of laws that are left out."""
    return _COEFFICIENTS[type(law)](law, speed) if type(law) in _COEFFICIENTS else math.inf


def strongest(law: Any) -> float:
    """Return the largest coefficient that a law may have during an impact."""
    return max(coefficient(law, 0.0), coefficient(law, math.inf) if type(law) is Viscous else 0.0)


@dataclass(frozen=True)
class Reported:
    """Forces or impulses of a run, in order of the instants.

    Attributes
    ----------
    time : array
        Instant of each entry [s], shape [n].
    contact : array
        Contact of each, shape [n].
    normal : array
        Normal forces [N] or impulses [N s], shape [n].
    friction : array
        Their sizes across the normal, shape [n].
    bound : array
        Coefficient of the law of each, shape [n].
    largest : array
        Largest normal force or impulse at the same instant, shape [n].
    marked : array
        Which entries the run itself says to be outside, shape [n].
    """

    time: Vector
    contact: NDArray[np.int64]
    normal: Vector
    friction: Vector
    bound: Vector
    largest: Vector
    marked: NDArray[np.bool_]

    def outside(self, pulls: NDArray[np.bool_], floor: float) -> tuple[Vector, Vector]:
        """Return by how much each pulls, unless its law may, and exceeds its bound, beyond what round-off explains."""
        allowed = _BEYOND * self.largest + floor
        bounded = np.isfinite(self.bound)
        held = np.where(bounded, np.where(bounded, self.bound, 0.0) * np.maximum(self.normal, 0.0), np.inf)
        return np.where(pulls, -np.inf, -self.normal - allowed), self.friction - held - allowed


def _largest(normal: Vector, first: NDArray[np.int64]) -> Vector:
    """Return the largest normal force of the instant of each entry; ``first`` says where the instants begin."""
    counts = np.diff(first)
    starts = first[:-1][counts > 0]
    most = np.maximum.reduceat(np.abs(normal), starts) if len(starts) else np.zeros(0)
    return np.repeat(most, counts[counts > 0])


def reported(case: Case, solution: ns.Solution) -> tuple[list[ContactLaws], dict[str, Reported]]:
    """Return the laws of each contact as the case has them, the forces at samples and the impulses of events."""
    numbers = {id(body): k for k, body in enumerate(solution.system.bodies)}
    given = {frozenset((i, j)): laws for i, j, laws in case.contacts}
    laws = [given[frozenset((numbers[id(c.first)], numbers[id(c.second)]))] for c in solution.system.contacts]
    times = solution.t[np.unique(np.linspace(0, len(solution.t) - 1, _MOST).astype(int))]
    request = HistoryRequest(solution, times)
    f, p, events = ClosedContacts.of(request), Impulses.of(request), solution.events
    speeds = np.linalg.norm(f.slip_velocity, axis=1).tolist()
    forces = Reported(
        np.repeat(times, np.diff(f.first)),
        f.contact,
        f.normal_force,
        np.linalg.norm(f.friction_force, axis=1),
        np.array([coefficient(laws[c].friction, v) for c, v in zip(f.contact.tolist(), speeds, strict=True)]),
        _largest(f.normal_force, f.first),
        f.beyond_cone,
    )
    impulses = Reported(
        p.time,
        p.impulse_contact,
        p.normal_impulse,
        # where bodies are too far apart nothing is exchanged
        np.nan_to_num(np.linalg.norm(p.friction_impulse, axis=1)),
        np.array([strongest(laws[c].friction) for c in p.impulse_contact.tolist()]),
        _largest(p.normal_impulse, events.first),
        impulses_beyond_cone(solution),
    )
    return laws, {"force": forces, "impulse": impulses}


def cones(case: Case, solution: ns.Solution, weight: float, momentum: float) -> Iterator[str]:
    """Yield which forces at samples and impulses of events are outside of their cones, the worst of each kind.

    Parameters
    ----------
    case, solution : Case, Solution
        The system and its run.
    weight, momentum : float
        Sum of all weights [N] and largest sum of the sizes of all momenta [kg m/s].
    """
    laws, found = reported(case, solution)
    pulling = np.array([type(own.normal) is Cohesive for own in laws], dtype=bool)
    for what, floor in (("force", weight + momentum / case.t_end), ("impulse", momentum)):
        rows = found[what]
        pulls, beyond = rows.outside(pulling[rows.contact], _FLOOR * floor)
        for kind, excess in (("pulls", pulls), ("cone", beyond)):
            # an entry that the run itself marks is not silent
            excess = np.where(rows.marked, -np.inf, excess)
            if np.any(excess > 0.0):
                k = int(np.argmax(excess))
                name = solution.system.contacts[int(rows.contact[k])].name
                yield (
                    f"{what}-{kind}: {name}, {rows.normal[k]:.4g} normal and {rows.friction[k]:.4g} across with a "
                    f"coefficient of {rows.bound[k]:.4g}, at t = {rows.time[k]:.6g} s, where the largest is "
                    f"{rows.largest[k]:.3g}; {np.count_nonzero(excess > 0.0)} of {len(excess)}"
                )
