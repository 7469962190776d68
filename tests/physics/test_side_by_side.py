"""Two round cylinders side by side: their sides touch along a line."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from bodies import CylinderBody
from laws import EnergeticImpact, Frictionless, Unilateral


@pytest.mark.parametrize("angle", [0.0, 1e-7, 1e-6, 2e-6, 5e-6, 2e-5])
def test_cylinders_collide_with_their_sides(angle: float) -> None:
    """Inelastically and without friction: they go on together, with the momentum that one had, whatever the angle.

    Axes that cross at less than some micro-radians are parallel within the tolerance of gaps. Then the ends of the
    line of contact touch. The crossing would run from one end to the other with the least tilt.
    """
    size = 0.02
    one, two = CylinderBody(size, size, rounding=0.1 * size), CylinderBody(size, size, rounding=0.1 * size)
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.0))
    system.place(one, velocity=(0.0, 1.47, 0.0))
    turned = ns.turned_about((0.0, 1.0, 0.0), angle)
    system.place(two, position=(-1e-12, 2.0 * size + 8.9e-3, 0.0), orientation=turned)
    solution = ns.simulate(system, 0.02)
    assert solution.status == "done"
    first, second = (solution.of(body)[1][-1] for body in (one, two))
    np.testing.assert_allclose(first[:3] + second[:3], [0.0, 1.47, 0.0], rtol=0, atol=1e-12)
    assert second[1] - first[1] == pytest.approx(0.0, abs=2e-3)
    assert len(solution.events) < 50
