"""Named starts: touching, at a height, resting."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    ConstantVelocity,
    CylinderBody,
    DrivenBody,
    Dumbbell,
    EllipsoidBody,
    Harmonic,
    LineBody,
    PlanarBody,
    Plate,
    Rest,
    Sphere,
)
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body
from nonsmooth.model.assembly import assemble

turns = st.tuples(*[st.floats(-2.0, 2.0)] * 3).map(lambda v: np.roll(Rotation.from_rotvec(v).as_quat(), 1))


def _gaps(system: ns.System) -> Any:
    return assemble(system, EventDriven()).gaps()


@pytest.mark.fast_cases(2)
@settings(max_examples=10)
@given(turn=turns, slope=st.floats(-1.0, 1.0), height=st.floats(-0.5, 0.5))
@pytest.mark.parametrize("body", [Dumbbell(), BoxBody(0.01, 0.02, 0.03), EllipsoidBody(0.01, 0.02, 0.03)])
def test_touching_in_any_orientation(build: Any, body: Body, turn: Any, slope: float, height: float) -> None:
    """Over a slope, under its surface or far above: the smallest gap is zero, the rest of the start is kept."""
    system = build.over(body, Rest(slope))
    ns.touching(system, body, position=(0.1, 0.2, height), orientation=turn, velocity=(1.0, 2.0, 3.0))
    assert float(np.min(_gaps(system))) == pytest.approx(0.0, abs=1e-15)
    q, u = system.start(body)
    np.testing.assert_array_equal(q[:2], [0.1, 0.2])
    np.testing.assert_array_equal(q[3:], body.state(orientation=turn)[0][3:])
    np.testing.assert_array_equal(u[:3], [1.0, 2.0, 3.0])


@pytest.mark.parametrize("move", [ns.touching, lambda system, body: ns.at_height(system, body, 0.01)])
def test_a_body_that_was_placed_before_keeps_its_start(build: Any, move: Any) -> None:
    """Orientation, velocities and the place across the direction; with a start of its own that replaces them."""
    body = BoxBody(0.01, 0.02, 0.03)
    system = build.over(body, Rest(0.0))
    start = {"orientation": ns.turned_about((1.0, 0.0, 0.0), 0.3), "velocity": (1.0, 2.0, 3.0)}
    system.place(body, position=(0.1, 0.2, 0.5), **start, angular_velocity=(0.0, 0.0, 30.0))
    before = system.start(body)
    move(system, body)
    q, u = system.start(body)
    np.testing.assert_allclose(q[:2], before[0][:2], rtol=0, atol=1e-15)
    assert q[2] < before[0][2]
    np.testing.assert_array_equal(q[3:], before[0][3:])
    np.testing.assert_array_equal(u, before[1])
    ns.touching(system, body, velocity=(1.0, 0.0, 0.0))
    np.testing.assert_array_equal(system.start(body)[1], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_a_body_with_a_velocity_does_not_rest(build: Any) -> None:
    """The velocity that it was given before is not dropped in silence."""
    body = Ball(0.01)
    system = build.over(body, Rest(0.0))
    system.place(body, position=(0.0, 0.0, 0.1), velocity=(1.0, 0.0, 0.0))
    with pytest.raises(ns.InvalidInput, match="must not be given velocities"):
        ns.resting(system, body)


def test_a_ball_touches_where_geometry_says(build: Any) -> None:
    """Beside the middle of another ball, along gravity and along a direction given; from below upwards."""
    ball, other = Ball(0.01), Ball(0.02)
    system = ns.System([ball, other])
    system.contact(ball, other, **build.laws())
    ns.touching(system, ball, position=(0.018, 0.0, 3.0))
    np.testing.assert_allclose(system.start(ball)[0][:3], [0.018, 0.0, 0.024], rtol=0, atol=1e-15)
    ns.touching(system, ball, direction=(2.0, 0.0, 0.0), position=(-7.0, 0.0, 0.018))
    np.testing.assert_allclose(system.start(ball)[0][:3], [-0.024, 0.0, 0.018], rtol=0, atol=1e-14)
    # inside the other, it goes back
    ns.touching(system, ball, position=(0.018, 0.0, 0.01))
    np.testing.assert_allclose(system.start(ball)[0][:3], [0.018, 0.0, 0.024], rtol=0, atol=1e-15)
    # nearly past it
    ns.touching(system, ball, position=(0.03 * (1.0 - 1e-9), 0.0, 1.0))
    assert _gaps(system)[0] == pytest.approx(0.0, abs=1e-15)


def test_equal_bodies_are_not_the_same(build: Any) -> None:
    """Of two equal balls, the one that is asked for is moved, with its own contacts only."""
    one, two, plate = Ball(0.01), Ball(0.01), Plate()
    system = ns.System([plate, one, two])
    for ball in (one, two):
        system.contact(plate, ball, **build.laws())
    system.place(one, position=(0.0, 0.0, 0.5))
    ns.touching(system, two, position=(0.1, 0.0, 1.0))
    np.testing.assert_allclose(_gaps(system), [0.49, 0.0], rtol=0, atol=1e-15)
    assert system.start(one)[0][2] == 0.5


def test_at_height(build: Any) -> None:
    """The smallest gap is the height, also of bodies in a plane and on a line."""
    dumbbell, planar, line = (
        Dumbbell(),
        PlanarBody(1.0, 1e-3, (Sphere(0.01, x=0.05),)),
        LineBody(1.0, carried=(Sphere(0.02),)),
    )
    plate = Plate(Rest(position=(0.0, 0.0, 0.1)))
    system = ns.System([plate, dumbbell, planar, line])
    for body in (dumbbell, planar, line):
        system.contact(plate, body, **build.laws())
    ns.at_height(system, dumbbell, 0.3, orientation=(math.cos(0.1), 0.0, math.sin(0.1), 0.0))
    ns.at_height(system, planar, 0.2, angle=0.3, position=(0.4, 0.0))
    ns.at_height(system, line, 0.1)
    gaps = _gaps(system)
    assert min(gaps[:2]) == pytest.approx(0.3, abs=1e-15)
    np.testing.assert_allclose(gaps[2:], [0.2, 0.1], rtol=0, atol=1e-15)
    q, _ = system.start(planar)
    np.testing.assert_allclose(q, [0.4, 0.1 + 0.01 + 0.2 + 0.05 * math.sin(0.3), 0.3], rtol=0, atol=1e-15)
    assert system.start(line)[0][0] == pytest.approx(0.22, abs=1e-15)


def test_an_inclined_line_goes_its_own_way(build: Any) -> None:
    """Gravity's direction has a part along the guide, and that is where the body goes."""
    along = (0.6, 0.0, 0.8)
    body = LineBody(1.0, along, (Sphere(0.02),), origin=(0.0, 0.0, 1.0))
    system = build.over(body)
    ns.touching(system, body)
    assert system.start(body)[0][0] == pytest.approx((0.02 - 1.0) / 0.8, abs=1e-14)


@pytest.mark.parametrize(
    "motion",
    [
        Harmonic(amplitude=1e-3, frequency=25.0),
        ConstantVelocity((0.3, 0.1, 0.0), 2.0),
        ConstantVelocity((0.3, 0.1, 0.2), 2.0, (0.6, 0.0, 0.8), centre=(0.4, 0.0, 0.0)),
    ],
)
def test_resting_rides_along(build: Any, motion: Any) -> None:
    """No contact with the plate has a relative velocity, and the body turns with it."""
    body = Dumbbell()
    system = build.over(body, motion)
    ns.resting(system, body, position=(0.2, 0.3, 1.0))
    model = assemble(system, EventDriven())
    np.testing.assert_allclose(model.gaps(), 0.0, rtol=0, atol=1e-15)
    np.testing.assert_allclose(model.memory[owners.ContactRecord.rate][:2], 0.0, rtol=0, atol=1e-14)


@pytest.mark.slow
def test_rounded_boxes_rest_on_balls(build: Any) -> None:
    """Solids tell their distance roughly, how roughly depends on last digits: the gap is zero all the same."""
    box, ball = BoxBody(0.004011, 0.005135, 0.005642, rounding=0.0003204), Ball(0.003524)
    system = ns.System([box, ball])
    system.contact(box, ball, **build.laws())
    turn = (-0.24584237067626993, -0.07256437320048659, 0.23220421125129997, 0.938284149284988)
    system.place(ball, position=(-0.01729, -0.00506, 0.01149), orientation=turn)
    turn = (0.4150616085610644, -0.7975420478599287, 0.3200078011916544, -0.29873993735450854)
    for k in range(40):
        ns.resting(system, box, position=(-0.01923, -0.01572 + 1e-5 * k, 0.01747), orientation=turn)
        assert float(np.min(_gaps(system))) == pytest.approx(0.0, abs=1e-15)


def test_resting_stays_on_a_plate_that_travels(build: Any) -> None:
    """A run from there has one mode: both contacts stick."""
    body = Dumbbell()
    system = build.over(body, ConstantVelocity((0.3, 0.1, 0.0)))
    ns.resting(system, body)
    solution = ns.simulate(system, 0.2)
    assert build.lived(solution) == ["{11,00,00}"]
    np.testing.assert_allclose(solution.q_end[:2], [0.06, 0.02], rtol=0, atol=1e-12)


def test_a_line_cannot_follow_a_belt_but_a_lift(build: Any) -> None:
    """Along a vertical line a body can follow a plate that rises, not one that goes sideways."""
    body = LineBody(1.0, carried=(Sphere(0.01),))
    lift = build.over(body, ConstantVelocity((0.0, 0.0, 0.2)))
    ns.resting(lift, body)
    assert lift.start(body)[1][0] == pytest.approx(0.2, abs=1e-15)
    belt = build.over(body, ConstantVelocity((0.2, 0.0, 0.0)))
    with pytest.raises(ns.InvalidInput, match="must be able to follow 'plate'"):
        ns.resting(belt, body)


def _refused(words: tuple[str, ...], call: Any, *arguments: Any, **keywords: Any) -> None:
    with pytest.raises(ns.InvalidInput) as caught:
        call(*arguments, **keywords)
    for word in words:
        assert word in str(caught.value)


def test_what_is_refused(build: Any) -> None:
    """No contact, nothing there, no way to go, a driven body, a stranger; and the start stays as it was."""
    ball, plate, rail = Ball(0.01), Plate(), LineBody(1.0, (1.0, 0.0, 0.0), (Sphere(0.01),))
    system = ns.System([plate, ball, rail])
    system.place(ball, position=(0.0, 0.0, 0.7))
    _refused(("placing 'ball'", "needs a contact"), ns.touching, system, ball)
    system.contact(plate, ball, **build.laws())
    system.contact(plate, rail, **build.laws())
    up = {"direction": (0.0, 0.0, 1.0)}
    _refused(("placing 'ball'", "something to touch along"), ns.touching, system, ball, position=(0, 0, 1), **up)
    level = {"direction": (1.0, 0.0, 0.0)}
    _refused(("placing 'ball'", "something to touch along"), ns.touching, system, ball, position=(0, 0, 1), **level)
    _refused(("placing 'line body'", "without turning"), ns.touching, system, rail)
    _refused(("placing 'plate'", "can be placed"), ns.touching, system, plate)
    _refused(("System.start", "body of this system"), ns.touching, system, Ball(0.02))
    _refused(("placing: direction", "three finite"), ns.touching, system, ball, direction=(0.0, 0.0, 0.0))
    _refused(("placing: direction", "three finite"), ns.touching, system, ball, direction=(0.0, 1.0))
    _refused(("at_height: height", "must be finite and not negative", "-0.1"), ns.at_height, system, ball, -0.1)
    _refused(("resting 'ball'", "velocities"), ns.resting, system, ball, velocity=(1.0, 0.0, 0.0))
    _refused(("velocity of Ball", "3 finite numbers"), ns.touching, system, ball, velocity=1.0)
    np.testing.assert_array_equal(system.start(ball)[0][:3], [0.0, 0.0, 0.7])
    free = ns.System([DrivenBody(Rest(), (Sphere(1.0),)), ball], gravity=0.0)
    _refused(("placing: direction", "Without gravity"), ns.touching, free, ball)


def test_set_start() -> None:
    """Coordinates of the right number, finite."""
    ball = Ball(0.01)
    system = ns.System([ball])
    system.set_start(ball, np.array([1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0]), np.zeros(6))
    assert system.start(ball)[0][2] == 3.0
    _refused(("System.set_start: q", "7 finite"), system.set_start, ball, np.zeros(3), np.zeros(6))
    _refused(("System.set_start: u", "6 finite"), system.set_start, ball, np.zeros(7), np.full(6, np.nan))
    _refused(("System.set_start", "this system"), system.set_start, Ball(0.01), np.zeros(7), np.zeros(6))


@pytest.mark.parametrize("offset", [0.0, 1e-3, 0.03, 0.12])
def test_bodies_on_feet_are_placed_on_feet(offset: float) -> None:
    """Two equal bodies, whose rims are set back by 1e-4 of the radius each: a run accepts the place."""
    low, high = CylinderBody(0.1, 0.02), CylinderBody(0.1, 0.02)
    system = ns.System([Plate(), low, high])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.2)))
    system.place(high, position=(1.0, 0.0, 1.0))
    ns.touching(system, low, position=(0.0, 0.0, 0.3))
    ns.touching(system, high, position=(offset, 0.0, 0.6))
    assert system.start(high)[0][2] == pytest.approx(0.06, abs=1e-12)
    assert ns.simulate(system, 1e-3).status == "done"


def test_a_height_above_a_plane_may_exceed_the_margin_of_the_list(build: Any) -> None:
    """Features of a cylinder and a box are searched for within a margin, to which the gap of the plane is not bound."""
    plate, box, cylinder = Plate(), BoxBody(0.01, 0.02, 0.03), CylinderBody(0.01, 0.02)
    system = ns.System([plate, box, cylinder])
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5)))
    system.place(box, position=(0.0, 0.0, 0.1))
    ns.at_height(system, cylinder, 0.2, position=(0.3, 0.0, 0.5))
    assert system.start(cylinder)[0][2] == pytest.approx(0.22, abs=1e-12)
