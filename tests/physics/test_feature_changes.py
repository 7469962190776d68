"""A contact that stays closed while its features change: a ball that slides over the edge of a box."""

from __future__ import annotations

import math

import pytest

import nonsmooth as ns
from bodies import Ball, CapsuleBody, DrivenBody, Rest
from bodies.free import FreeBody
from bodies.shapes.box import Box
from laws import EnergeticImpact, Frictionless, Unilateral

ALONG = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
RADIUS, HALF, G = 0.02, 0.1, 9.81


BALL, CAPSULE = Ball(RADIUS, density=3000.0), CapsuleBody(RADIUS, 0.03, density=3000.0)
"""The ends of a capsule are contacts that come to an end of their own; it lies along the edge."""


def _over_the_edge(speed: float, start: float, ball: FreeBody) -> ns.Solution:
    """Let a body slide without friction from ``start`` before the edge of a box at rest, over it and off."""
    table = DrivenBody(Rest(), (Box(HALF, HALF, HALF),))
    system = ns.System([table, ball], gravity=G)
    system.contact(table, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.0))
    system.place(ball, position=(HALF - start, 0.0, HALF + RADIUS), velocity=(speed, 0.0, 0.0), orientation=ALONG)
    return ns.simulate(system, start / speed + 0.3)


@pytest.mark.parametrize("body", [BALL, CAPSULE])
@pytest.mark.parametrize("speed", [0.05, 0.2])
def test_a_change_of_feature_is_an_event(speed: float, body: FreeBody) -> None:
    """From face to edge at distance over speed; off the edge at the angle of v^2 / r = g cos, both in closed form."""
    start = 0.013
    solution = _over_the_edge(speed, start, body)
    changes = [i for i, cause in enumerate(solution.events.causes()) if cause == "change of feature"]
    assert changes
    assert solution.events.time[changes] == pytest.approx(start / speed, abs=1e-11)
    lifted = solution.events.causes().index("lift-off")
    across, up = solution.events.q[lifted][0] - HALF, solution.events.q[lifted][2] - HALF
    assert up / RADIUS == pytest.approx(2.0 / 3.0 + speed**2 / (3.0 * G * RADIUS), abs=1e-8)
    assert math.hypot(across, up) == pytest.approx(RADIUS, abs=1e-12)
    assert abs(solution.energy.residual) < 1e-9


@pytest.mark.parametrize("body", [BALL, CAPSULE])
def test_too_fast_it_leaves_the_face_at_its_end(body: FreeBody) -> None:
    """With v^2 > g r the ball does not turn about the edge: the change of feature is where it lifts off."""
    speed, start = 1.2 * math.sqrt(G * RADIUS), 0.013
    solution = _over_the_edge(speed, start, body)
    words = solution.events.causes()
    lifted = solution.events.time[words.index("lift-off")]
    assert lifted == pytest.approx(start / speed, abs=1e-11)
    # free flight from there
    fallen = solution.t_end - lifted
    assert solution.q_end[2] == pytest.approx(HALF + RADIUS - 0.5 * G * fallen**2, abs=1e-9)
