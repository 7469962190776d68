"""Impacts on matrices alone, solved by a process or a map alike."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import nonsmooth as ns
from laws import (
    Coulomb,
    EnergeticImpact,
    JohnsonImpact,
    MonoStiffnessImpact,
    MoreauImpact,
    NewtonImpact,
    PlasticImpact,
    PoissonImpact,
    ViscoelasticImpact,
)
from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess

E = 0.6
"""The coefficient of the laws below."""
LAWS: dict[str, ImpactLaw] = {
    "energetic": EnergeticImpact(E),
    "mono-stiffness": MonoStiffnessImpact(E),
    "newton": NewtonImpact(E),
    "poisson": PoissonImpact(E),
    "moreau": MoreauImpact(E, E),
    "plastic": PlasticImpact(),
    "johnson": JohnsonImpact(0.2),
    "viscoelastic": ViscoelasticImpact(5.0),
}
"""All laws for any number of contacts."""


@dataclass(frozen=True)
class Problem:
    """Mass [n_u, n_u], normals [n_u, n], tangents [n_u, n, 2], velocity [n_u], friction coefficients [n]."""

    mass: Any
    normal: Any
    tangential: Any
    velocity: Any
    friction: Any

    @property
    def columns(self) -> Any:
        """W and N side by side, shape [n_u, 3 n]."""
        return np.concatenate([self.normal[:, :, None], self.tangential], axis=2).reshape(len(self.velocity), -1)

    @property
    def rates(self) -> Any:
        """Gap rates and slips before, shape [n, 3]."""
        return (self.columns.T @ self.velocity).reshape(-1, 3)

    def energy(self, velocity: Any) -> float:
        """Kinetic energy."""
        return float(0.5 * velocity @ self.mass @ velocity)


def draw(seed: int, n: int = 2, friction: float = 0.4, approach: bool = False) -> Problem:
    """Return a random problem in which one contact approaches, or all; coupled, but far from Painleve's paradox."""
    random = np.random.default_rng(seed)
    n_u = 3 * n + 2
    mass = np.diag(random.uniform(0.5, 2.0, n_u))
    columns = random.normal(size=(n_u, 3 * n))
    columns = np.linalg.qr(columns)[0] + 0.1 * columns
    rates = random.normal(size=(n, 3))
    rates[0, 0] = -abs(rates[0, 0]) - 0.1
    if approach:
        rates[:, 0] = -np.abs(rates[:, 0])
    velocity = np.linalg.lstsq(columns.T, rates.ravel(), rcond=None)[0]
    blocks = columns.reshape(n_u, n, 3)
    return Problem(mass, blocks[:, :, 0], blocks[:, :, 1:], velocity, random.uniform(0.05, 1.0, n) * friction)


def solve(laws: Sequence[ImpactLaw], problem: Problem) -> tuple[Any, Any]:
    """Return the velocity after and the impulses, shape [n, 3]."""
    if isinstance(laws[0], ImpactMap):
        columns = problem.columns
        response = np.linalg.solve(problem.mass, columns)
        impulse = apply(laws, columns.T @ response, problem.rates, problem.friction)
        return problem.velocity + response @ impulse.ravel(), impulse
    friction = [Coulomb(float(mu)) for mu in problem.friction]
    processes = [law for law in laws if isinstance(law, ImpactProcess)]
    result = ns.solve_impact(
        problem.mass, problem.normal, problem.tangential, problem.velocity, processes, friction, tolerance=1e-11
    )
    return result.velocity, np.column_stack([result.normal_impulse, result.tangential_impulse])


def apply(laws: Sequence[Any], delassus: Any, rates: Any, friction: Any) -> Any:
    """Return the impulses [n, 3] of a map, called as plain Python."""
    n = len(laws)
    out = np.full(3 * n, 7.0)
    names = list(inspect.signature(laws[0].impulses).parameters)[5:]
    values = [np.array([law.parameters()[name] for law in laws]) for name in names]
    laws[0].impulses(
        n, np.ascontiguousarray(delassus).ravel(), np.ravel(rates).copy(), out, np.array(friction, float), *values
    )
    return out.reshape(n, 3)
