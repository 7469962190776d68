"""Two spheres: collisions of whole balls against what is known."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.memory.modes import Cause

RADIUS = 0.01


def _balls(places: Any, velocities: Any, friction: float = 0.0, **impact: float) -> ns.System:
    balls = [Ball(RADIUS) for _ in places]
    system = ns.System(balls, gravity=0.0)
    law = Coulomb(friction) if friction > 0.0 else Frictionless()
    for one, two in itertools.pairwise(balls):
        system.contact(one, two, normal=Unilateral(), friction=law, impact=EnergeticImpact(**impact))
    for ball, place, velocity in zip(balls, places, velocities, strict=True):
        system.place(ball, position=place, velocity=velocity)
    return system


def _speeds(solution: ns.Solution, axis: int = 0) -> Any:
    return solution.u_end.reshape(-1, 6)[:, axis]


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_head_on(restitution: float) -> None:
    """Two equal balls: (1 - e)/2 and (1 + e)/2 of the speed, at the time when they meet."""
    system = _balls([(0, 0, 0), (0.05, 0, 0)], [(0.3, 0, 0), (0, 0, 0)], restitution=restitution)
    solution = ns.simulate(system, 0.3)
    np.testing.assert_allclose(_speeds(solution), [0.15 * (1 - restitution), 0.15 * (1 + restitution)], atol=1e-12)
    assert solution.events.time[solution.events.cause == Cause.IMPACT][0] == pytest.approx(0.1, abs=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 1.5])
@pytest.mark.parametrize("n", [3, 5])
def test_cradle_is_the_impact_on_matrices(exponent: float, n: int) -> None:
    """A ball strikes a row at rest that touches: the run does what the impact does on M and W alone."""
    places = [(-0.01 - 2 * RADIUS, 0, 0)] + [(2 * RADIUS * i, 0, 0) for i in range(n - 1)]
    velocities = [(1.0, 0, 0)] + [(0, 0, 0)] * (n - 1)
    solution = ns.simulate(_balls(places, velocities, restitution=1.0, exponent=exponent), 0.02)
    mass = Ball(RADIUS).total_mass
    normal = np.zeros((n, n - 1))
    for i in range(n - 1):
        normal[i, i], normal[i + 1, i] = -1.0, 1.0
    result = ns.solve_impact(
        np.eye(n) * mass,
        normal,
        np.zeros((n, n - 1, 2)),
        np.array([1.0] + [0.0] * (n - 1)),
        [EnergeticImpact(restitution=1.0, exponent=exponent)] * (n - 1),
        [Frictionless()] * (n - 1),
    )
    np.testing.assert_allclose(_speeds(solution), result.velocity, atol=1e-7)
    assert float(np.sum(_speeds(solution))) == pytest.approx(1.0, abs=1e-12)
    assert solution.energy.residual <= 1e-7
    # the last ball takes most of it, and not all, as no other law finds
    assert 0.9 < _speeds(solution)[-1] < 1.0


@pytest.mark.parametrize("friction", [0.05, 1.0])
def test_oblique(friction: float) -> None:
    """Sliding throughout, friction gives mu times the normal impulse; else 1/7 of the slip goes to each ball."""
    speed, offset = 1.0, RADIUS
    across = offset / (2.0 * RADIUS)
    along = math.sqrt(1.0 - across**2)
    system = _balls([(0, 0, 0), (0.05, offset, 0)], [(speed, 0, 0), (0, 0, 0)], friction, restitution=0.8)
    solution = ns.simulate(system, 0.1)
    normal, tangent = np.array([along, across]), np.array([-across, along])
    after = solution.u_end.reshape(-1, 6)
    closing = speed * along
    assert after[1, :2] @ normal == pytest.approx(0.9 * closing, abs=1e-9)
    slip = -speed * across
    gain = min(friction * 0.9 * closing, abs(slip) / 7.0)
    assert after[1, :2] @ tangent == pytest.approx(math.copysign(gain, slip), abs=1e-9)
    # momentum, and angular momentum about the origin
    ball = Ball(RADIUS)
    mass, inertia = ball.total_mass, ball.inertia[0]
    np.testing.assert_allclose(after[:, :2].sum(axis=0), [speed, 0.0], atol=1e-12)
    q = solution.q_end.reshape(-1, 7)
    turning = sum(mass * (q[i, 0] * after[i, 1] - q[i, 1] * after[i, 0]) + inertia * after[i, 5] for i in range(2))
    assert turning == pytest.approx(0.0, abs=1e-12)
    assert solution.energy.residual <= 1e-8
