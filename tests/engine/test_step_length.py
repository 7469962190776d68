"""How long the first step behind an event is: up to where a gap is to close."""

from __future__ import annotations

import copy
import math

import pytest

import nonsmooth as ns
from bodies import Ball, FreeBody, RigidBody, Sphere
from laws import Frictionless, NewtonImpact, Unilateral

RADIUS, AHEAD, SPEED = 0.01, 0.05, 2.0


FLYING = Ball(RADIUS)
INTEGRATED = RigidBody(1.0, (4e-5, 5e-5, 6e-5), (Sphere(RADIUS),))


def _pass_by(body: FreeBody, offset: float) -> ns.Solution:
    """Return how a body flies past a ball at rest, without gravity, its line so far from the other's centre."""
    still, moving = Ball(RADIUS), copy.copy(body)
    system = ns.System([still, moving], 0.0)
    system.contact(still, moving, normal=Unilateral(), friction=Frictionless(), impact=NewtonImpact(1.0))
    system.place(moving, position=(-AHEAD, offset, 0.0), velocity=(SPEED, 0.0, 0.0))
    return ns.simulate(system, 0.08, sample_interval=0.08)


@pytest.mark.parametrize("share", [0.0, 0.5, 0.95])
@pytest.mark.parametrize("body", [FLYING, INTEGRATED], ids=["flying", "integrated"])
def test_a_first_step_leads_to_where_a_gap_closes(body: FreeBody, share: float) -> None:
    """If the balls nearly pass each other, the gap closes later than its rate at the start predicts."""
    solution = _pass_by(body, share * 2.0 * RADIUS)
    assert solution.events.causes() == ["start", "impact"]
    exact = (AHEAD - 2.0 * RADIUS * math.sqrt(1.0 - share**2)) / SPEED
    assert solution.events.time[1] == pytest.approx(exact, abs=1e-12)


def test_a_first_step_to_a_gap_that_does_not_close_after_all_is_counted() -> None:
    solution = _pass_by(INTEGRATED, 1.05 * 2.0 * RADIUS)
    assert solution.events.causes() == ["start"]
    assert solution.counters.limits["gap about to close"] >= 1
