"""A contact that slides alone is held in registers; the forces are those of the path that any island takes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Dumbbell, Harmonic, Plate
from laws import Anisotropic, Coulomb, NewtonImpact, Unilateral
from nonsmooth.interfaces import FrictionLaw

MU = 0.2
SAME = Anisotropic(MU, MU)
"""The same friction by axes of a body, for which the short path does not care."""


def _slide(friction: FrictionLaw, dumbbell_first: bool) -> ns.Solution:
    """Return the run of a tilted dumbbell that slides over its lower ball, spinning, on a plate that shakes."""
    plate, body = Plate(Harmonic(1e-4, 25.0)), Dumbbell()
    system = ns.System([plate, body])
    pair = (body, plate) if dumbbell_first else (plate, body)
    system.contact(*pair, normal=Unilateral(), friction=friction, impact=NewtonImpact(0.5))
    tilt, half = 0.3, 0.5 * body.centre_distance
    system.place(
        body,
        position=(half * math.cos(tilt), 0.0, body.radius + half * math.sin(tilt)),
        orientation=(math.cos(0.5 * tilt), 0.0, -math.sin(0.5 * tilt), 0.0),
        velocity=(0.2, 0.3, 2.0 * math.pi * 25.0 * 1e-4),
        angular_velocity=(40.0, 0.0, 0.0),
    )
    return ns.simulate(system, 0.01)


@pytest.mark.parametrize("dumbbell_first", [True, False])
def test_forces_are_those_of_any_island(dumbbell_first: bool) -> None:
    """Motion, work of the plate and loss to friction, whichever body comes first."""
    alone, any_island = _slide(Coulomb(MU), dumbbell_first), _slide(SAME, dumbbell_first)
    assert alone.events.causes() == any_island.events.causes() == ["start"]
    np.testing.assert_allclose(alone.q_end, any_island.q_end, rtol=0, atol=1e-12)
    np.testing.assert_allclose(alone.u_end, any_island.u_end, rtol=0, atol=1e-9)
    assert alone.energy.driven_work == pytest.approx(any_island.energy.driven_work, rel=1e-8)
    assert alone.energy.friction_loss == pytest.approx(any_island.energy.friction_loss, rel=1e-8)
    assert abs(alone.energy.driven_work) > 1e-8
    assert alone.energy.friction_loss > 1e-6


def test_either_order_of_the_bodies_moves_alike() -> None:
    """The sign of the rows is that of the side that moves."""
    one, other = _slide(Coulomb(MU), True), _slide(Coulomb(MU), False)
    np.testing.assert_allclose(one.u_end, other.u_end, rtol=0, atol=1e-9)
