"""A body that precesses within a long step meets what it is next to in the middle of it."""

from __future__ import annotations

import math

import pytest

import nonsmooth as ns
from bodies import Ball
from tests.engine.test_clearance import LAWS
from tests.engine.tops import Top


def test_a_top_that_precesses_into_a_ball_is_not_missed() -> None:
    """Its axis comes next to that about which it turned at the start, where a ball is; the step is a whole period.

    At both ends of it the ball is on the axis of the spin, and its origin seen from the top is at rest.
    """
    top, ball, period, lean = Top(), Ball(0.03), 0.1, math.radians(60.0)
    system = ns.System([top, ball], gravity=0.0)
    system.contact(top, ball, **LAWS)
    tilt, rate = math.atan(0.5 * math.tan(lean)), 2.0 * math.pi / period
    system.place(top, angular_velocity=(rate * math.sin(tilt), 0.0, 0.5 * rate * math.cos(tilt)))
    system.place(ball, position=(0.1 * math.sin(lean), 0.0, 0.1 * math.cos(lean)))
    near = math.cos(2.0 * math.asin(0.3))
    turned = (math.cos(tilt) * math.cos(lean - tilt) - near) / (math.sin(tilt) * math.sin(lean - tilt))
    events = ns.simulate(system, period, sample_interval=period).events
    assert len(events) > 1
    assert events.time[1] == pytest.approx(math.acos(turned) / rate, abs=1e-10)
