"""Gaps, normal velocities and slip of open and closed contacts, and rates of coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate
from laws import Bristle, Coulomb, Directional, EnergeticImpact, HuntCrossley, Unilateral
from nonsmooth.plugins import registry
from tests.histories.closed import closed_contacts

_MOTION = ("gap", "normal_velocity", "slip_speed")
_LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.2), "impact": EnergeticImpact(0.5)}


def test_two_balls_that_pass_in_the_air() -> None:
    """Their gap is the distance of the centres less the radii, its rate that of the distance; the rest is slip."""
    one, two = Ball(0.02), Ball(0.03)
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, **_LAWS)
    system.place(one, position=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 5.0))
    system.place(two, position=(-0.2, 0.1, 0.0), velocity=(1.0, 0.0, 0.0))
    solution = ns.simulate(system, 0.4)
    times = np.array([0.31, 0.2, 0.0])
    motion = solution.history(*_MOTION, times=times)
    way = np.column_stack([times - 0.2, np.full(3, 0.1), np.zeros(3)])
    far = np.linalg.norm(way, axis=1)
    np.testing.assert_allclose(motion["gap"][:, 0], far - 0.05, rtol=1e-9)
    np.testing.assert_allclose(motion["normal_velocity"][:, 0], way[:, 0] / far, atol=1e-9)
    # along (-y, x) over the distance: the second moves by -y of its way, the surface of the first by 5 * 0.02
    np.testing.assert_allclose(motion["slip_speed"][:, 0], np.abs(-way[:, 1] / far - 0.1), rtol=1e-9)
    assert motion.labels == {"contact": ("ball 1 - ball 2",)}
    assert solution.history("gap", times=0.2)["gap"].shape == (1,)
    data = motion.to_xarray()
    assert data["gap"].sel(contact="ball 1 - ball 2").attrs["units"] == "m"


def test_what_is_far_apart_among_many_is_no_number() -> None:
    plate, balls = Plate(), [Ball(0.01) for _ in range(20)]
    system = ns.System([plate, *balls])
    for i, ball in enumerate(balls):
        system.contact(plate, ball, **_LAWS)
        for other in balls[:i]:
            system.contact(other, ball, **_LAWS)
        system.place(ball, position=(0.1 * i, 0.0, 0.012))
    solution = ns.simulate(system, 0.05)
    motion = solution.history("gap", times=[0.01, 0.0], of=["ball 1 - ball 20", "plate - ball 3"])
    assert np.all(np.isnan(motion["gap"][:, 0]))
    np.testing.assert_allclose(motion["gap"][:, 1], 0.002 - 9.81 / 2 * np.array([0.01, 0.0]) ** 2, rtol=1e-9)


def test_they_are_those_of_forces_and_change_none() -> None:
    """Of closed contacts gap and slip are told twice, of bristles and of friction that faces a way, too."""
    plate, soft, hard = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, soft, hard])
    bristles = Bristle(0.3, 0.4, stiffness=1e3)
    system.contact(soft, plate, normal=HuntCrossley(stiffness=1e6, dissipation=0.5), friction=bristles)
    system.contact(hard, plate, **{**_LAWS, "friction": Directional(forward=0.05, backward=0.4, across=0.2)})
    system.place(soft, position=(0.0, 0.0, 0.0101), velocity=(0.2, 0.1, 0.0))
    system.place(hard, position=(0.0, 0.1, 0.0101), velocity=(0.2, 0.1, 0.0), angular_velocity=(5.0, -30.0, 0.0))
    solution = ns.simulate(system, 0.12)
    times = np.linspace(0.0, 0.12, 61)
    before, motion, after = (
        closed_contacts(solution, times),
        solution.history(*_MOTION, times=times),
        closed_contacts(solution, times),
    )
    np.testing.assert_array_equal(before.normal_force, after.normal_force)
    np.testing.assert_array_equal(before.friction_force, after.friction_force)
    assert {*before.contact.tolist()} == {0, 1}
    entries = np.repeat(np.arange(len(times)), np.diff(before.first)), before.contact
    np.testing.assert_allclose(motion["gap"][entries], before.gap, rtol=0, atol=1e-12)
    slip = np.linalg.norm(before.slip_velocity, axis=1)
    np.testing.assert_allclose(motion["slip_speed"][entries], slip, rtol=0, atol=1e-9)


def test_contacts_of_a_mesh_keep_their_features() -> None:
    """Closed ones are those that forces are told of."""
    scenario = registry.load("scenarios", "mesh_drop")()
    solution = ns.simulate(scenario.build(), scenario.t_end)
    times = np.linspace(0.1, scenario.t_end, 40)
    forces, motion = closed_contacts(solution, times), solution.history("gap", times=times)
    assert len(forces.contact) > 40
    entries = np.repeat(np.arange(len(times)), np.diff(forces.first)), forces.contact
    np.testing.assert_allclose(motion["gap"][entries], forces.gap, rtol=0, atol=1e-12)


def test_rates_of_coordinates_are_their_slopes() -> None:
    """Of a box that tumbles, whose quaternion has rates that are no velocities."""
    box = BoxBody(0.1, 0.2, 0.3, density=100.0)
    system = ns.System([box])
    system.place(box, position=(0.0, 0.0, 1.0), velocity=(1.0, 0.0, 0.0), angular_velocity=(3.0, 2.0, 1.0))
    solution = ns.simulate(system, 0.3)
    times, half = np.array([0.1, 0.2]), 1e-5
    slope = (solution.at(times + half)["q"] - solution.at(times - half)["q"]) / (2.0 * half)
    np.testing.assert_allclose(
        solution.history("coordinate_rate", times=times)["coordinate_rate"], slope, rtol=0, atol=1e-7
    )
