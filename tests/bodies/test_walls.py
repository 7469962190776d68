"""Bodies without coordinates by name: a wall by its normal, an open box, a bare pivot."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Distance, DrivenBody, Harmonic, OpenBox, Plate, Rest, Wall
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.placing.probe import Probe
from nonsmooth.rotations import rotation
from nonsmooth.solution.solution import Solution

LAWS = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5))
TURN = (0.5, 0.5, -0.5, 0.5)


def _slid(plane: Plate | Wall) -> Solution:
    ball = Ball(0.01)
    system = ns.System([plane, ball])
    system.contact(plane, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.5))
    ns.touching(system, ball)
    return ns.simulate(system, 0.5)


def test_a_wall_is_the_slope_of_its_normal() -> None:
    wall = _slid(Wall((math.sin(0.2), 0.0, math.cos(0.2))))
    plate = _slid(Plate(Rest(slope=0.2)))
    np.testing.assert_allclose(wall.q_end, plate.q_end, atol=1e-12)
    np.testing.assert_allclose(
        wall.u_end[:3], 0.5 * 9.81 * math.sin(0.2) * np.array([math.cos(0.2), 0, -math.sin(0.2)])
    )


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0), (0.6, 0.0, -0.8)])
def test_the_normal_points_to_the_bodies(axis: tuple[float, float, float]) -> None:
    """A ball that flies against it turns back at a radius from the plane."""
    normal, point = np.array(axis), np.array([0.3, -0.2, 0.1])
    wall, ball = Wall(axis, (0.3, -0.2, 0.1)), Ball(0.01)
    system = ns.System([wall, ball], gravity=0.0)
    system.contact(wall, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    system.place(ball, position=tuple(point + 0.06 * normal), velocity=tuple(-normal))
    solution = ns.simulate(system, 0.1)
    np.testing.assert_allclose(solution.q_end[:3], point + 0.06 * normal, atol=1e-9)
    np.testing.assert_allclose(solution.u_end[:3], normal, atol=1e-9)


@pytest.mark.parametrize(("place", "turn"), [((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)), ((0.4, -0.3, 0.2), TURN)])
def test_every_plane_of_a_box_is_at_its_place(
    place: tuple[float, float, float], turn: tuple[float, float, float, float]
) -> None:
    """Gaps of a ball inside, seen from the box; its contacts are in the order that the class tells."""
    box, ball = OpenBox(0.03, 0.05, place, turn), Ball(0.01)
    inside = np.array([0.002, -0.004, 0.03])
    system = ns.System([box, ball], gravity=0.0)
    system.contact_all(LAWS)
    system.place(ball, position=tuple(np.array(place) + rotation(turn) @ inside))
    np.testing.assert_allclose(Probe.of(system, ball).gaps(), [0.02, 0.022, 0.018, 0.036, 0.044], atol=1e-12)


def test_balls_stay_in_a_box_that_leans() -> None:
    half = math.sqrt(0.5)
    box = OpenBox(0.03, 0.03, (0.1, 0.0, 0.0), (math.cos(0.1), 0.0, math.sin(0.1), 0.0))
    balls = [Ball(0.01), Ball(0.01)]
    system = ns.System([box, *balls])
    system.contact_all(LAWS)
    for i, ball in enumerate(balls):
        system.place(ball, position=(0.1, 0.0, 0.02 + 0.03 * i), velocity=(half, half * (-1) ** i, 0.0))
    solution = ns.simulate(system, 1.0)
    assert solution.status == "done"
    assert solution.energy.residual < 1e-8
    for ball in balls:
        seen = (solution.of(ball)[0][:, :3] - np.array([0.1, 0.0, 0.0])) @ rotation(box.orientation)
        assert np.all(np.abs(seen[:, :2]) < 0.02 + 1e-9)
        assert np.all(seen[:, 2] > 0.01 - 1e-9)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Wall((0.0, 0.0, 0.0)), "Wall.normal must have a direction"),
        (lambda: Wall((1.0, 0.0, 0.0), (0.0, 0.0)), "Wall.point must be 3 finite numbers"),  # type: ignore[arg-type]
        (lambda: OpenBox(0.0, 1.0), "OpenBox.half_x must be > 0"),
        (lambda: OpenBox(1.0, 1.0, (math.nan, 0.0, 0.0)), "OpenBox.position must be 3 finite numbers"),
        (lambda: OpenBox(1.0, 1.0, orientation=(1.0, 1.0, 0.0, 0.0)), "OpenBox.orientation must be a unit quaternion"),
    ],
)
def test_what_is_no_wall_is_refused(make: object, told: str) -> None:
    with pytest.raises(ns.InvalidInput, match=told):
        make()  # type: ignore[operator]


def test_a_driven_body_without_shapes_is_a_pivot() -> None:
    pivot, bob = DrivenBody(), Ball(0.05)
    system = ns.System([pivot, bob])
    system.joint(Distance(length=0.3), pivot, bob)
    system.contact_all(LAWS)
    system.place(bob, position=(0.3, 0.0, 0.0))
    assert system.contacts == ()
    solution = ns.simulate(system, 1.0)
    # a quarter of the swing is at the bottom: v^2 = 2 g l
    assert np.max(np.abs(solution.u[:, 0])) == pytest.approx(math.sqrt(2.0 * 9.81 * 0.3), rel=1e-4)


def test_nothing_touches_a_pivot() -> None:
    pivot, ball = DrivenBody(Harmonic(1e-3, 25.0)), Ball(0.05)
    with pytest.raises(ns.InvalidInput, match="needs bodies that carry shapes"):
        ns.System([pivot, ball]).contact(pivot, ball, normal=LAWS.normal, friction=LAWS.friction, impact=LAWS.impact)
