"""Balls in a box that slip slowly against walls and each other, together without forces: their slips stop at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball
from nonsmooth.engine.memory.modes import JAM
from tests.benchmarks import mixed_balls, pile

MU, RADIUS = 0.8, mixed_balls.RADIUS


def _twists(solution: ns.Solution, balls: list[Ball], q: Any, u: Any) -> Any:
    """Return velocities and angular velocities in world axes, shape [balls, 6]."""
    twists = []
    for ball in balls:
        first_q, first_u = solution.offsets(ball)
        turn = Rotation.from_quat(np.array(q[first_q + 3 : first_q + 7]), scalar_first=True)
        own = np.array(u[first_u : first_u + 6])
        twists.append([*own[:3], *turn.apply(own[3:])])
    return np.array(twists)


def test_the_impulse_of_a_jam_is_that_of_an_inelastic_impact_on_the_cone() -> None:
    """By geometry and mechanics of balls written here; the run goes on, and balances its energy."""
    system = mixed_balls.build("mu=0.8", 0)
    solution = ns.assemble(system).run(0.2)
    events = solution.events
    (jam,) = np.flatnonzero(events.cause == JAM)
    balls = [body for body in system.bodies if isinstance(body, Ball)]
    centres = np.array([events.q[jam][solution.offsets(ball)[0] :][:3] for ball in balls])
    planes = mixed_balls.planes("mu=0.8")
    found = pile.touches(centres, RADIUS, planes, lambda i, j: MU)
    axes = [pile.frame(touch.normal) for touch in found]
    wrenches = np.array(
        [
            pile.wrench(touch, axis, RADIUS, len(balls))
            for touch, frame in zip(found, axes, strict=True)
            for axis in frame
        ]
    )
    before = _twists(solution, balls, events.q[jam], events.u_before[jam])
    after = _twists(solution, balls, events.q[jam], events.u_after[jam])
    masses = np.array([[ball.total_mass] * 3 + [ball.inertia[0]] * 3 for ball in balls])
    gained = (masses * (after - before)).reshape(-1)
    impulses = np.linalg.lstsq(wrenches.T, gained, rcond=1e-10)[0]
    np.testing.assert_allclose(wrenches.T @ impulses, gained, rtol=0.0, atol=1e-9 * np.max(np.abs(gained)))
    normal, *friction = impulses.reshape(-1, 3).T
    rates = (wrenches @ after.reshape(-1)).reshape(-1, 3)
    slip, rub = np.hypot(rates[:, 1], rates[:, 2]), np.hypot(*friction)
    small = 1e-8 * np.max(normal)
    assert np.count_nonzero(normal > small) > 1
    assert np.all(normal > -small)
    assert np.all(rub <= MU * normal + small)
    assert np.all(rates[:, 0] > -1e-7)
    held = normal > small
    assert np.all(np.abs(rates[held, 0]) < 1e-7)
    # what slips on has all of its friction against it
    slips = held & (slip > 1e-6)
    power = -(friction[0] * rates[:, 1] + friction[1] * rates[:, 2])
    np.testing.assert_allclose(power[slips], MU * normal[slips] * slip[slips], rtol=1e-3)
    assert np.any((slip < 1e-7) & held)
    assert np.sum(masses * after**2) < np.sum(masses * before**2)
    assert solution.t_end == 0.2
    assert solution.energy.residual < 1e-8


@pytest.mark.parametrize(("friction", "balanced"), [(0.2, False), (0.6, True)])
def test_what_tells_a_pile_at_rest(friction: float, balanced: bool) -> None:
    """A ball over two others a bit apart stays if friction holds it: tan(15 deg) = 0.27 at every contact."""
    height = RADIUS * (1.0 + np.sqrt(3.0))
    centres = np.array([[-RADIUS, 0.0, RADIUS], [RADIUS, 0.0, RADIUS], [0.0, 0.0, height]])
    floor = [(np.zeros(3), np.array([0.0, 0.0, 1.0]))]
    found = pile.touches(centres, RADIUS, floor, lambda i, j: friction)
    left = pile.unbalanced(found, RADIUS, np.ones(3), 9.81)
    assert (left < 1e-9) == balanced
