"""Cones with their bases in one plane: they meet rim to rim, and at once another part of them is next to touch."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import ConeBody, Plate
from laws import Bristle, Coulomb, EnergeticImpact, LinearCompliant, Unilateral

RADIUS = 0.006


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("feet", [1e-8, 1e-6, 1e-4])
@pytest.mark.parametrize("seed", range(6, 12))
def test_a_row_of_cones_is_pushed_and_none_passes_another(seed: int, feet: float) -> None:
    """The first one slides into two that touch within the tolerances, turned and shifted by very little."""
    rng = np.random.default_rng(seed)
    friction, restitution = rng.uniform(0.1, 0.8), rng.uniform(0.0, 0.5)
    laws: dict[str, Any] = {
        "normal": Unilateral(),
        "friction": Coulomb(friction),
        "impact": EnergeticImpact(restitution),
    }
    plate, cones = Plate(), [ConeBody(RADIUS, 2.0 * RADIUS, foot_height=feet * RADIUS) for _ in range(3)]
    system, place = ns.System([plate, *cones], gravity=9.81), 0.0
    for i, cone in enumerate(cones):
        for other in (plate, *cones[:i]):
            system.contact(other, cone, **laws)
        yaw = 10.0 ** rng.uniform(-12.0, -2.0) * rng.choice([-1.0, 1.0]) if rng.random() < 0.7 else 0.0
        aside = 10.0 ** rng.uniform(-12.0, -5.0) if rng.random() < 0.5 else 0.0
        speed = rng.uniform(0.1, 0.3) if i == 0 else 0.0
        turn = ns.turned_about((0.0, 0.0, 1.0), yaw)
        system.place(cone, position=(place, aside, 0.5 * RADIUS), orientation=turn, velocity=(speed, 0.0, 0.0))
        room = 10.0 ** (rng.uniform(-4.0, -3.0) if i == 0 else rng.uniform(-12.0, -6.0))
        place += 2.0 * RADIUS + room
    solution = ns.simulate(system, 0.03)
    first, second, third = (solution.of(cone)[0][:, 0] for cone in cones)
    # cones that lean on each other may come nearer than upright ones, which are two radii apart
    assert np.min(second - first) > RADIUS
    assert np.min(third - second) > RADIUS
    assert third[-1] > third[0]


@pytest.mark.parametrize("seed", range(6))
def test_cones_meet_rim_to_rim_on_one_spring_at_a_place(seed: int) -> None:
    """The rim of either cone is over the side of the other.  A second spring would begin at the depth of the first one.

    It would bring in energy that no work accounts for, which ends the run.
    """
    rng = np.random.default_rng(seed)
    laws: dict[str, Any] = {
        "normal": LinearCompliant(stiffness=10.0 ** rng.uniform(4.0, 5.5), damping=rng.uniform(0.0, 3.0)),
        "friction": Bristle(0.5, 0.6),
    }
    plate, cones = Plate(), [ConeBody(RADIUS, 2.0 * RADIUS) for _ in range(2)]
    system = ns.System([plate, *cones], gravity=9.81)
    for one, other in ((plate, cones[0]), (plate, cones[1]), (cones[0], cones[1])):
        system.contact(one, other, **laws)
    speed, room = rng.uniform(0.5, 1.5), rng.uniform(1e-4, 5e-4)
    system.place(cones[0], position=(0.0, 0.0, 0.5 * RADIUS), velocity=(speed, 0.0, 0.0))
    system.place(cones[1], position=(2.0 * RADIUS + room, 0.0, 0.5 * RADIUS))
    solution = ns.simulate(system, 0.004)
    assert solution.status == "done"
    assert solution.of(cones[1])[1][-1, 0] > 0.0
