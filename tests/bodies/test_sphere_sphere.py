"""Two spheres: kinematics against finite differences, and collisions of whole balls against what is known."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, Dumbbell
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.kernel import call_room
from nonsmooth.engine.modes import IMPACT
from nonsmooth.model.assembly import assemble
from nonsmooth.model.options import Options

RADIUS = 0.01
vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3)


def _turn(q: Any, omega: Any, dt: float) -> Any:
    turned = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(np.asarray(omega) * dt)
    return np.roll(turned.as_quat(), 1)


@settings(max_examples=25)
@given(
    place=vectors,
    turns=st.tuples(vectors, vectors),
    moves=st.tuples(vectors, vectors),
    spins=st.tuples(vectors, vectors),
)
def test_rates_and_bias_are_derivatives(build: Any, place: Any, turns: Any, moves: Any, spins: Any) -> None:
    """The rate is dg/dt, the normal bias d(g')/dt with u' = 0; the slip's, whose axes may spin, by d(v.v)/dt / 2."""
    assume(np.linalg.norm(place) > 0.3)
    bodies = Dumbbell(0.05), Ball(0.07)
    system = ns.System(bodies)
    system.contact(*bodies, **build.laws())
    system.place(bodies[0], position=(0.0, 0.0, 5.0))
    model = assemble(system, Options())
    memory, n = model.memory, len(system.contacts)
    assert n == 2
    starts = [
        (np.zeros(3), _turn([1.0, 0, 0, 0], turns[0], 1.0)),
        (np.asarray(place), _turn([1.0, 0, 0, 0], turns[1], 1.0)),
    ]
    u = np.concatenate([np.concatenate([moves[i], 3.0 * np.asarray(spins[i])]) for i in range(2)])

    def at(dt: float) -> Any:
        q = [
            np.concatenate([p + dt * u[6 * i : 6 * i + 3], _turn(o, u[6 * i + 3 : 6 * i + 6], dt)])
            for i, (p, o) in enumerate(starts)
        ]
        memory.array("y", 26)[:] = np.concatenate([*q, u])
        call_room("evaluate_at", memory)
        return model.gaps(), memory.array("rate", 3 * n).reshape(n, 3).copy()

    h = 1e-3
    parts = [(w / (12.0 * h), *at(dt)) for dt, w in ((-2 * h, 1.0), (-h, -8.0), (h, 8.0), (2 * h, -1.0))]
    gap, rate = at(0.0)
    bias = memory.array("bias", 3 * n).reshape(n, 3).copy()
    assume(np.min(gap) > -0.1)
    scale = 1.0 + float(np.max(np.abs(bias)))
    np.testing.assert_allclose(rate[:, 0], sum(w * g for w, g, _ in parts), rtol=0, atol=1e-6 * scale)
    np.testing.assert_allclose(bias[:, 0], sum(w * r[:, 0] for w, _, r in parts), rtol=0, atol=1e-6 * scale)
    squares = sum(w * np.sum(r[:, 1:] ** 2, axis=1) / 2.0 for w, _, r in parts)
    np.testing.assert_allclose(np.sum(rate[:, 1:] * bias[:, 1:], axis=1), squares, rtol=0, atol=1e-5 * scale**2)


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
    assert solution.events.time[solution.events.cause == IMPACT][0] == pytest.approx(0.1, abs=1e-12)


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
