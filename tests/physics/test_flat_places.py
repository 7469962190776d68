"""Flat places that roll over a plane: contact points without bound in speed, faces that land, faces that lie."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import CylinderBody, Plate, Superellipsoid, SuperellipsoidBody
from bodies.shapes.frustum import LEAST
from laws import Coulomb, EnergeticImpact, Frictionless, PlasticImpact, Unilateral
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.interfaces.impact_law import ImpactLaw


def _on_a_plate(body: SuperellipsoidBody | CylinderBody, friction: FrictionLaw, impact: ImpactLaw) -> ns.System:
    plate = Plate()
    system = ns.System([plate, body])
    system.contact(plate, body, normal=Unilateral(), friction=friction, impact=impact)
    return system


@pytest.mark.slow
@pytest.mark.parametrize(("exponent", "tilt"), [(0.4, 0.0), (0.85, 0.0), (0.85, -0.02)])
def test_a_boxy_body_rolls_over_the_middle_of_its_face(exponent: float, tilt: float) -> None:
    """Without friction it keeps (m h'^2 + I) omega^2 / 2 + m g h, h(angle) being its support function.

    In the middle of the face the curvature is none and the force has no bound; the speed of the point neither.
    """
    body = SuperellipsoidBody(0.01, 0.012, 0.009, exponent_along=exponent, exponent_across=exponent, density=1000.0)
    shape = Superellipsoid(0.01, 0.012, 0.009, exponent_along=exponent, exponent_across=exponent)
    system = _on_a_plate(body, Frictionless(), PlasticImpact())
    start = (np.cos(tilt / 2.0), np.sin(tilt / 2.0), 0.0, 0.0)
    ns.touching(system, body, position=(0.0, 0.0, 0.02), orientation=start, angular_velocity=(8.0, 0.0, 0.0))
    solution = ns.simulate(system, 0.01, sample_interval=1e-3)
    energies, angles = [], []
    for q, u in zip(solution.q[1:], solution.u[1:], strict=True):
        turn = Rotation.from_quat(np.roll(q[3:], -1))
        point = turn.apply(shape.support(turn.inv().apply([0.0, 0.0, -1.0])))
        mass, spin = body.total_mass, u[3]
        energies.append(0.5 * (mass * point[1] ** 2 + body.inertia[0]) * spin**2 - mass * 9.81 * point[2])
        angles.append(turn.as_rotvec()[0])
    assert angles[0] < 0.0 or tilt == 0.0
    assert angles[-1] > 0.02
    assert np.ptp(energies) < 2e-7 * energies[0]
    assert solution.energy.residual < 1e-7


def test_a_face_that_starts_flat_lands_where_it_turns_down() -> None:
    """Its three feet touch; the first impact is at the one that goes down fastest."""
    body = CylinderBody(0.01, 0.01, density=1000.0, foot_height=0.0)
    system = _on_a_plate(body, Frictionless(), EnergeticImpact(0.5))
    spin = (3.0, -4.0, 20.0)
    ns.touching(system, body, position=(0.0, 0.0, 0.02), orientation=(1.0, 0.0, 0.0, 0.0), angular_velocity=spin)
    events = ns.simulate(system, 1e-3).events
    change = events.u_after[0] - events.u_before[0]
    assert events.time[0] == 0.0
    # the arm of the impulse, which is vertical
    arm = np.cross(change[3:] * body.inertia, [0.0, 0.0, 1.0]) / (body.total_mass * change[2])
    feet = np.array(body.centred_shape.feet[:3])
    lowest = feet[np.argmin(np.cross(spin, feet)[:, 2])]
    np.testing.assert_allclose(-arm, [*lowest[:2], 0.0], atol=1e-12)


SIZES = (2e-4, 0.02, 0.2)
"""Radii of cylinders on feet of the least height [m]."""


@pytest.mark.parametrize("radius", SIZES)
@pytest.mark.parametrize("lean", [3e-10, 2e-9, 1e-8, 1e-6])
def test_a_face_on_the_least_feet_next_to_flat_gains_no_energy(radius: float, lean: float) -> None:
    """The cylinder rocks on rim and feet.  What it gains is less than its weight times the height of the feet."""
    body = CylinderBody(radius, 0.5 * radius, density=1000.0, foot_height=0.0)
    system = _on_a_plate(body, Frictionless(), PlasticImpact())
    turn = np.roll(Rotation.from_rotvec([0.0, lean, 0.0]).as_quat(), 1)
    ns.touching(system, body, position=(0.0, 0.0, 2.0 * radius), orientation=turn)
    span = 20.0 * np.sqrt(max(lean, LEAST) * radius / 9.81)
    solution = ns.simulate(system, span, sample_interval=span / 300.0)
    kinetic = 0.5 * solution.u**2 @ [*[body.total_mass] * 3, *body.inertia]
    energies = kinetic + body.total_mass * 9.81 * (solution.q[:, 2] - 0.5 * radius)
    assert solution.status == "done"
    assert np.max(energies) < energies[0] + LEAST * body.total_mass * 9.81 * radius
    leans = 2.0 * np.hypot(solution.q[:, 4], solution.q[:, 5])
    assert np.max(leans) < max(lean, 3.0 * LEAST) * (1.0 + 1e-6)


def test_a_cylinder_on_the_least_feet_stands() -> None:
    """Nothing moves."""
    body = CylinderBody(0.01, 0.017, density=1200.0, foot_height=0.0)
    system = _on_a_plate(body, Coulomb(0.6), EnergeticImpact(0.5))
    ns.resting(system, body, position=(0.0, 0.0, 0.02), orientation=(1.0, 0.0, 0.0, 0.0))
    solution = ns.simulate(system, 0.1, sample_interval=0.01)
    assert np.max(np.abs(solution.q - solution.q[0])) < 1e-9
    assert np.max(np.abs(solution.u)) < 1e-6
