"""A contact that stays closed while its features change: a ball that slides over the edge of a box."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, CapsuleBody, CylinderBody, DrivenBody, HullBody, Rest
from bodies.free import FreeBody
from bodies.shapes.box import Box
from laws import Cohesive, CoulombContensou, EnergeticImpact, Frictionless, Unilateral

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


def test_a_corner_on_springs_keeps_the_side_of_a_cylinder_while_it_is_deeper_below_the_cap() -> None:
    """No depth jumps: the corner is 0.25 mm below the side, and 0.6 mm below the cap.

    Random system 7200381.
    """
    points = (
        *((-0.009203, 0.006369, 0.009095), (-0.005046, 0.011201, 0.009603), (-0.014307, 0.008368, 0.016232)),
        *((-0.003417, -0.013478, 0.007641), (0.003568, 0.015972, 0.015726), (-0.005342, 0.011166, 0.013996)),
        (0.0037, 0.001801, -0.005161),
    )
    hull, cylinder = HullBody(points, density=2700.0), CylinderBody(0.01895, 0.01532, density=7800.0)
    friction = CoulombContensou(0.2273, 0.0006282, 0.0001694, presliding=1e-5)
    system = ns.System([hull, cylinder], gravity=0.0)
    system.contact(hull, cylinder, normal=Cohesive(5610.0, 0.1693, 3.618), friction=friction)
    system.place(
        hull,
        orientation=(-0.6702058035392506, -0.7355827843749722, 0.060827982169192066, 0.07773097721433334),
        velocity=(0.6355, 0.6785, 0.5649),
        angular_velocity=(-278.9048, -161.9213, -111.972),
    )
    system.place(
        cylinder,
        position=(-0.033449, -0.017072, 0.005414),
        orientation=(-0.06913600146637462, -0.31151800660729706, -0.047674001011165576, 0.9465220200757323),
        velocity=(0.1943, 0.1384, -0.0856),
        angular_velocity=(-103.0197, 215.083, -73.6981),
    )
    solution = ns.simulate(system, 5e-5, sample_interval=5e-5)
    assert solution.status == "done"
    assert "change of feature" not in solution.events.causes()
    history = solution.history("gap", "normal_force", times=np.linspace(2e-5, 5e-5, 31))
    pressed = np.where(history["normal_force"] != 0.0, history["gap"], 0.0)
    assert -3e-4 < np.nanmin(pressed) < -2.5e-4
    assert solution.energy.residual < 1e-10
