"""Evaluations that are kept do not change a run; a lone contact at rest is solved in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest, Spring
from laws import Coulomb, EnergeticImpact, Unilateral

LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.7)}


def _two_balls(held: bool) -> ns.System:
    """Return two balls over a plate, the first one perhaps on a spring."""
    plate, one, two = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, one, two])
    for ball, x in ((one, 0.0), (two, 0.1)):
        system.contact(ball, plate, **LAWS)
        system.place(ball, position=(x, 0.0, 0.02), velocity=(0.1, 0.2, 0.3), angular_velocity=(1.0, 2.0, 3.0))
    if held:
        system.load(Spring(stiffness=2.0, length=0.01), plate, one)
    return system


@pytest.mark.parametrize("held", [False, True])
def test_a_run_does_not_depend_on_what_the_model_evaluated_before(held: bool) -> None:
    """From the same state a model that has run elsewhere and a fresh one end in the same bits."""
    used, fresh = (ns.assemble(_two_balls(held)) for _ in range(2))
    state = used.run(0.03).state
    used.run(0.3)
    one, other = (model.run(0.1, start=state) for model in (used, fresh))
    assert len(one.events) > 1
    np.testing.assert_array_equal(one.events.time, other.events.time)
    np.testing.assert_array_equal(one.q_end, other.q_end)
    np.testing.assert_array_equal(one.u_end, other.u_end)


def test_a_ball_that_rolls_is_held_as_one_beside_a_neighbour_is() -> None:
    """Down a slope, alone and touching another one that rolls with it: by closed form, and by elimination."""
    slope, balls = 0.2, [Ball(0.01) for _ in range(3)]
    normal = math.sin(slope), 0.0, math.cos(slope)
    plate = Plate(Rest(slope=slope))
    system = ns.System([plate, *balls])
    for ball, y in zip(balls, (0.0, 0.1, 0.12), strict=True):
        system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.0))
        system.place(ball, position=(0.01 * normal[0], y, 0.01 * normal[2]))
    system.contact(balls[1], balls[2], normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.0))
    solution = ns.simulate(system, 0.2)
    way = 0.5 * 5.0 / 7.0 * 9.81 * math.sin(slope) * 0.2**2
    for i in range(3):
        x, _, z = solution.q_end[7 * i : 7 * i + 3] - 0.01 * np.array(normal)
        assert math.hypot(x, z) == pytest.approx(way, rel=1e-7)
