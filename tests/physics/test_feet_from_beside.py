"""Feet of a flat face that come over the rim of another flat face from beside, below its feet."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Box, ConeBody, Cylinder, CylinderBody, DiscBody, DrivenBody, Rest
from laws import Coulomb, NewtonImpact, Unilateral
from nonsmooth.interfaces import Shape
from tests.runs.continued import lost_by_stopping

R, FOOT = 0.05, 5e-6
"""Radius of the body, and height of the feet of each body [m]."""
SPEED = 0.4
"""Speed of the body [m/s]."""
EDGE = 0.06
"""Where the table ends behind the rim of the pillar [m]: all feet have come over the rim before."""
BODIES = {
    "cylinder": (CylinderBody(R, 0.3 * R, foot_height=FOOT), 0.3 * R),
    "rounded cylinder": (CylinderBody(R, 0.3 * R, foot_height=FOOT, rounding=0.05 * R), 0.3 * R),
    "cone": (ConeBody(R, R, foot_height=FOOT), 0.25 * R),
    "disc": (DiscBody(R, foot_height=FOOT), FOOT),
}
"""A body that lies flat, and the height of its mass centre over the tips of its feet [m]."""
PILLARS: dict[str, Any] = {
    "cylinder": lambda step: Cylinder(0.2, R, x=0.2, z=step - R, foot_height=FOOT),
    "box": lambda step: Box(0.2, 0.2, R, x=0.2, z=step - R),
}
"""Shapes whose upper flat face, with its feet, is at a height of ``step`` [m]; the rim begins at the origin."""


def _system(body: Any, height: float, edge: float, pillar: Shape) -> ns.System:
    """Return a body that slides on a table, which ends at ``edge`` [m], over the rim of a pillar."""
    table = DrivenBody(Rest(), (Box(0.2, 0.2, R, x=edge - 0.2, z=-R),))
    system = ns.System([table, DrivenBody(Rest(), (pillar,)), body])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.0), NewtonImpact(0.3)))
    system.place(body, position=(-0.07, 0.004, height), velocity=(SPEED, 0.0, 0.0))
    return system


@pytest.mark.parametrize("pillar", PILLARS)
@pytest.mark.parametrize("name", BODIES)
def test_a_foot_keeps_the_depth_at_which_it_came_over_the_rim(name: str, pillar: str) -> None:
    """The pillar's face is higher than the table, by less than the feet: the body slides on at its height and speed.

    It passes from the table to the pillar without any jump, foot by foot.
    """
    body, height = BODIES[name]
    step = 0.7 * FOOT if pillar == "box" else 1.4 * FOOT
    t_end = 0.23 / SPEED
    solution = ns.simulate(_system(body, height, EDGE, PILLARS[pillar](step)), t_end)
    assert solution.status == "done"
    place, moved = solution.q[:, :3], np.array([-0.07, 0.004, height]) + np.outer(solution.t, [SPEED, 0.0, 0.0])
    assert np.max(np.abs(place - moved)) < 1e-10
    assert np.max(np.abs(solution.u - [SPEED, 0.0, 0.0, 0.0, 0.0, 0.0])) < 1e-9
    assert abs(solution.energy.residual) < 1e-9


def test_a_run_goes_on_with_feet_at_their_depth() -> None:
    """A run that was stopped while feet are below the pillar's face is the run that was not stopped."""
    body, height = BODIES["cylinder"]
    model = ns.assemble(_system(body, height, EDGE, PILLARS["cylinder"](1.4 * FOOT)))
    whole, before = model.run(0.5), model.run(0.4)
    assert lost_by_stopping(whole, before, model.run(0.5, start=before.state)) == []
    times = [0.4, 0.41237]
    assert np.nanmin(whole.history("gap", times=times)["gap"]) == pytest.approx(-1.4 * FOOT, rel=1e-6)
    forces = np.nansum(whole.history("normal_force", times=times)["normal_force"], axis=-1)
    assert forces == pytest.approx(body.total_mass * 9.81, rel=1e-9)


def test_a_foot_that_is_lifted_out_comes_down_on_the_feet() -> None:
    """A tilted cylinder falls flat on a smaller one, at first with its rim: at the end it stands on the feet."""
    low, high = DrivenBody(Rest(), (Cylinder(0.03, 0.05),)), CylinderBody(0.05, 0.05)
    system = ns.System([low, high])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.3), NewtonImpact(0.2)))
    tilt = ns.turned_about((np.cos(0.7), np.sin(0.7), 0.0), 1e-6)
    system.place(high, position=(0.01, 0.0, 0.101 + 1e-7), orientation=tilt)
    solution = ns.simulate(system, 0.6)
    assert solution.status == "done"
    assert solution.q_end[2] == pytest.approx(0.1, abs=1e-12)
    assert abs(solution.energy.residual) < 1e-8


def test_a_step_higher_than_the_feet_stops_the_body() -> None:
    """It strikes the side of the pillar, whose rim is set back by the feet, with its own rim."""
    body, height = BODIES["cylinder"]
    solution = ns.simulate(_system(body, height, EDGE, PILLARS["cylinder"](3.0 * FOOT)), 0.1)
    assert solution.status == "done"
    assert solution.u_end[0] < 0.0
