"""Joints: rows against finite differences, mechanisms against closed forms and against the body they make up."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    BoxBody,
    Distance,
    DrivenBody,
    Dumbbell,
    Fixed,
    FreeBody,
    Harmonic,
    Hinge,
    PlanarBody,
    Plate,
    Rod,
    Slider,
    Wall,
)
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.model.assembly import lay_out

vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3)
JOINTS = [
    BallJoint((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1)),
    Hinge((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1), (0.6, 0.0, 0.8), (0.0, 1.0, 0.0)),
    Fixed((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1), (0.5, 0.5, 0.5, 0.5)),
    Slider((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1), (0.6, 0.0, 0.8), (0.5, 0.5, -0.5, 0.5)),
    Distance((0.1, 0.2, -0.1), (-0.2, 0.0, 0.1), 2.0),
]


def _turn(q: Any, omega: Any, dt: float) -> Any:
    turned = Rotation.from_quat(np.roll(q, -1)) * Rotation.from_rotvec(np.asarray(omega) * dt)
    return np.roll(turned.as_quat(), 1)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("joint", JOINTS, ids=lambda j: type(j).__name__)
@settings(max_examples=10)
@given(places=st.tuples(vectors, vectors), turns=st.tuples(vectors, vectors), u=st.tuples(*[vectors] * 4))
def test_rates_and_biases_are_derivatives(joint: Any, places: Any, turns: Any, u: Any) -> None:
    """Of every row, the rate is the residual's derivative and A u, the bias the rate's with u' = 0."""
    bodies = Ball(0.05), Ball(0.07)
    system = ns.System(bodies)
    system.joint(joint, *bodies)
    memory = lay_out(system, EventDriven()).memory
    n = joint.n_rows
    starts = [
        (np.add(p, (0.0, 0.0, 3.0 * i)), _turn([1.0, 0, 0, 0], t, 1.0))
        for i, (p, t) in enumerate(zip(places, turns, strict=True))
    ]
    velocities = np.ravel(u)

    def at(dt: float) -> Any:
        q = [
            np.concatenate([p + dt * velocities[6 * i : 6 * i + 3], _turn(o, velocities[6 * i + 3 : 6 * i + 6], dt)])
            for i, (p, o) in enumerate(starts)
        ]
        memory[owners.Island.y][:26] = np.concatenate([*q, velocities])
        call_entry("evaluate_at", memory)
        tied = owners.Articulation
        offsets = [int(memory[one][0]) for one in (tied.residual, tied.rate, tied.bias, tied.jacobian)]
        return [memory.floats[o : o + size].copy() for o, size in zip(offsets, (n, n, n, 12 * n), strict=True)]

    h = 1e-3
    parts = [(weight / (12.0 * h), *at(dt)) for dt, weight in ((-2 * h, 1.0), (-h, -8.0), (h, 8.0), (2 * h, -1.0))]
    _, rate, bias, jacobian = at(0.0)
    np.testing.assert_allclose(rate, sum(w * residual for w, residual, *_ in parts), rtol=0, atol=1e-8)
    np.testing.assert_allclose(bias, sum(w * r for w, _, r, *_ in parts), rtol=0, atol=1e-7)
    np.testing.assert_allclose(jacobian.reshape(n, 12) @ velocities, rate, rtol=0, atol=1e-12)


def _pendulum(length: float, angle: float, joint: Any) -> tuple[ns.System, Ball]:
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball])
    system.joint(joint, plate, ball)
    turned = (math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0)
    system.place(ball, position=(-length * math.sin(angle), 0.0, -length * math.cos(angle)), orientation=turned)
    return system, ball


@pytest.mark.parametrize(
    ("joint", "gyration"),
    [(Hinge(second=(0.0, 0.0, 0.5)), 0.4 * 0.01), (Distance(length=0.5), 0.0)],
    ids=["rod", "string"],
)
def test_pendulum(joint: Any, gyration: float) -> None:
    """A ball on a hinge or on a string swings as its equation says; the joint stays closed."""
    length, angle = 0.5, 1.0
    system, ball = _pendulum(length, angle, joint)
    solution = ns.simulate(system, 3.0, engine=ns.EventDriven(tolerance=1e-11))
    q, _ = solution.of(ball)

    def slope(t: float, y: Any) -> Any:
        return [y[1], -9.81 * length / (length**2 + gyration) * math.sin(y[0])]

    truth = solve_ivp(slope, (0.0, 3.0), [angle, 0.0], t_eval=solution.t, method="DOP853", rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.arctan2(-q[:, 0], -q[:, 2]), truth.y[0], rtol=0, atol=1e-8)
    np.testing.assert_allclose(np.hypot(q[:, 0], q[:, 2]), length, rtol=0, atol=1e-9)
    assert solution.energy.residual <= 1e-9


def test_driven_support() -> None:
    """A pendulum on a vibrating support: its equation, and the work of the support in the account."""
    motion = Harmonic(amplitude=0.05, frequency=7.0)
    plate, ball = Plate(motion), Ball(0.1)
    system = ns.System([plate, ball])
    system.joint(Hinge(second=(0.0, 0.0, 0.5)), plate, ball)
    angle, omega = 0.4, 2.0 * math.pi * 7.0
    system.place(
        ball,
        position=(-0.5 * math.sin(angle), 0.0, -0.5 * math.cos(angle)),
        orientation=(math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0),
        velocity=(0.0, 0.0, 0.05 * omega),
    )
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11))

    def slope(t: float, y: Any) -> Any:
        gravity = 9.81 - 0.05 * omega**2 * math.sin(omega * t)
        return [y[1], -gravity * 0.5 / (0.25 + 0.004) * math.sin(y[0])]

    truth = solve_ivp(slope, (0.0, 1.0), [angle, 0.0], t_eval=solution.t, method="DOP853", rtol=1e-12, atol=1e-12)
    found = np.arcsin(-solution.of(ball)[0][:, 0] / 0.5)
    np.testing.assert_allclose(found, truth.y[0], rtol=0, atol=1e-7)
    assert abs(solution.energy.driven_work) > 0.01
    assert solution.energy.residual <= 1e-9


def test_closed_loop_of_hinges() -> None:
    """A four-bar chain in a plane has redundant hinges; it keeps its energy and stays closed."""
    plate, balls = Plate(), [Ball(0.05) for _ in range(3)]
    system = ns.System([plate, *balls])
    # bars of unit length: ground (0, 0) - (0, 1) - (1, 1) - (1, 0) ground, in the x-z plane
    centres = [(0.0, 0.0, 0.5), (0.5, 0.0, 1.0), (1.0, 0.0, 0.5)]
    system.joint(Hinge((0.0, 0.0, 0.0), (0.0, 0.0, -0.5)), plate, balls[0])
    system.joint(Hinge((0.0, 0.0, 0.5), (-0.5, 0.0, 0.0)), balls[0], balls[1])
    system.joint(Hinge((0.5, 0.0, 0.0), (0.0, 0.0, 0.5)), balls[1], balls[2])
    system.joint(Hinge((0.0, 0.0, -0.5), (1.0, 0.0, 0.0)), balls[2], plate)
    for ball, centre, speed in zip(balls, centres, (0.5, 1.0, 0.5), strict=True):
        spin = 1.0 if speed == 0.5 else 0.0
        system.place(ball, position=centre, velocity=(speed, 0.0, 0.0), angular_velocity=(0.0, spin, 0.0))
    solution = ns.simulate(system, 1.0)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8
    q = solution.q.reshape(-1, 3, 7)
    # the coupler stays parallel to the ground
    np.testing.assert_allclose(q[:, 1, 4:], 0.0, atol=1e-9)
    np.testing.assert_allclose(q[:, 0, :3] + (1.0, 0.0, 0.0), q[:, 2, :3], atol=1e-8)
    np.testing.assert_allclose(q[:, 1, 2], 2.0 * q[:, 0, 2], atol=1e-8)


def test_two_fixed_balls_are_a_dumbbell() -> None:
    """Two balls tied together do what the rigid body of both does: flight, frictional double impacts, slip, stick."""
    dumbbell = Dumbbell(radius=5e-3, rod_mass_fraction=0.0)
    distance = dumbbell.centre_distance
    laws: Any = {
        "normal": Unilateral(),
        "friction": Coulomb(0.3),
        "impact": EnergeticImpact(0.6, duration=1e-4),
    }
    tilt = 0.2
    turned = (math.cos(tilt / 2), 0.0, -math.sin(tilt / 2), 0.0)
    ends = []
    for tied in (False, True):
        plate = Plate(Harmonic(amplitude=3.6e-4, frequency=25.0))
        balls: list[FreeBody] = [Ball(5e-3), Ball(5e-3)] if tied else [dumbbell]
        system = ns.System([plate, *balls])
        for ball in balls:
            system.contact(plate, ball, **laws)
        half = np.array([math.cos(tilt), 0.0, math.sin(tilt)]) * distance / 2.0
        centre = np.array([0.0, 0.0, 0.012])
        if tied:
            system.joint(Fixed((distance, 0.0, 0.0), (0.0, 0.0, 0.0)), *balls)
            spin = (0.0, 2.0, 0.0)
            for ball, sign in zip(balls, (-1.0, 1.0), strict=True):
                velocity = np.array([0.1, 0.02, 0.0]) + np.cross(spin, sign * half)
                system.place(
                    ball, position=centre + sign * half, orientation=turned, velocity=velocity, angular_velocity=spin
                )
        else:
            system.place(
                dumbbell,
                position=centre,
                orientation=turned,
                velocity=(0.1, 0.02, 0.0),
                angular_velocity=(0.0, 2.0, 0.0),
            )
        solution = ns.simulate(system, 0.4, engine=ns.EventDriven(tolerance=1e-11, impact_tolerance=1e-12))
        assert solution.counters.impacts > 5
        assert solution.energy.residual <= 1e-8
        position = solution.q_end.reshape(-1, 7)[:, :3].mean(axis=0)
        ends.append((len(solution.events), position, solution.q_end.reshape(-1, 7)[0, 3:]))
    assert ends[0][0] == ends[1][0]
    np.testing.assert_allclose(ends[1][1], ends[0][1], rtol=0, atol=1e-8)
    np.testing.assert_allclose(ends[1][2], ends[0][2], rtol=0, atol=1e-6)


def test_slider_on_a_slope_of_the_first_body() -> None:
    """A ball that slides along an axis falls with its share of gravity and does not turn."""
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball])
    system.joint(Slider(axis=(0.6, 0.0, 0.8)), plate, ball)
    solution = ns.simulate(system, 1.0)
    np.testing.assert_allclose(solution.q_end[:3], -0.5 * 9.81 * 0.8 * np.array([0.6, 0.0, 0.8]), atol=1e-9)
    np.testing.assert_allclose(solution.q_end[3:], [1.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_wrong_starts_and_wrong_joints() -> None:
    """An open joint, an opening one, contradicting ones, two driven bodies: named before anything runs."""
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball])
    system.joint(BallJoint(second=(0.0, 0.0, 0.5)), plate, ball)
    with pytest.raises(ns.InvalidInput, match=r"start of the joint 'ball joint plate - ball' must have the residual 0"):
        ns.simulate(system, 0.1)
    system.place(ball, position=(0.0, 0.0, -0.5), velocity=(0.0, 0.0, 1.0))
    with pytest.raises(
        ns.InvalidInput, match=r"start of the joint 'ball joint plate - ball' must have the rate 0"
    ) as error:
        ns.simulate(system, 0.1)
    assert "needs velocity [m/s, world axes] and angular_velocity [rad/s, body axes]" in error.value.remedy
    system.place(ball, position=(0.0, 0.0, -0.5))
    system.joint(BallJoint(second=(0.0, 0.0, 0.4)), plate, ball)
    with pytest.raises(ns.InvalidInput, match="contradict"):
        ns.simulate(system, 0.1)
    with pytest.raises(ns.InvalidInput, match="two different bodies"):
        system.joint(BallJoint(), ball, ball)
    other = Plate()
    still = ns.System([plate, other])
    with pytest.raises(ns.InvalidInput, match="both are driven"):
        still.joint(BallJoint(), plate, other)
    with pytest.raises(ns.InvalidInput, match="needs a Joint"):
        system.joint(Unilateral(), plate, ball)  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match=r"frames must be below 1 for ball"):
        system.joint(BallJoint(), plate, ball, frames=(0, 1))
    with pytest.raises(ns.InvalidInput, match=r"Hinge.axis must have a direction"):
        Hinge(axis=(0.0, 0.0, 0.0))
    with pytest.raises(ns.InvalidInput, match=r"BallJoint.first must be 3 finite numbers"):
        BallJoint(first=(0.0, math.nan, 0.0))


def _rod_beside_a_wall(clearance: float, friction: float) -> ns.System:
    """Return a rod of 0.4 m, level, hinged at the middle of its round end, and a wall next to that end."""
    pivot, rod = DrivenBody(), Rod(0.4, 0.005, mass=0.2)
    wall = Wall(normal=(1.0, 0.0, 0.0), point=(-0.005 - clearance, 0.0, 0.0))
    system = ns.System([pivot, rod, wall])
    system.joint(Hinge(second=(-0.2, 0.0, 0.0)), pivot, rod)
    system.contact(wall, rod, normal=Unilateral(), friction=Coulomb(friction), impact=EnergeticImpact(0.7))
    system.place(rod, position=(0.2, 0.0, 0.0))
    return system


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("overlap", [0.0, 1e-7])
def test_a_contact_at_a_pivot_is_refused_by_name(friction: float, overlap: float) -> None:
    """The joint takes any force along the normal, so that nothing determines the force of the contact."""
    with pytest.raises(
        ns.InvalidInput, match=r"the contact 'wall - rod \(1\)' must have some effective inverse mass"
    ) as caught:
        ns.assemble(_rod_beside_a_wall(-overlap, friction))
    assert "the joint 'hinge driven body - rod' holds it there" in str(caught.value)


def test_a_rod_with_a_clearance_at_its_pivot_rebounds_off_the_wall() -> None:
    """The remedy: let go level, it meets the wall where it hangs; the spin comes back by the coefficient."""
    system = _rod_beside_a_wall(1e-3, 0.0)
    solution = ns.simulate(system, 0.5)
    hit = solution.events.causes().index("impact")
    before, after = solution.events.u_before[hit], solution.events.u_after[hit]
    assert solution.status == "done"
    assert -after[4] / before[4] == pytest.approx(0.7, abs=1e-9)


def test_joints_that_come_to_contradict_each_other() -> None:
    """Closed at the start, and then one support vibrates and the other does not: the run ends and says why."""
    plates, ball = (Plate(), Plate(Harmonic(amplitude=1e-3, frequency=5.0, phase=math.pi / 2.0))), Ball(0.1)
    system = ns.System([*plates, ball])
    system.joint(BallJoint(second=(0.0, 0.0, 0.5)), plates[0], ball)
    system.joint(BallJoint(first=(0.0, 0.0, -1e-3), second=(0.0, 0.0, 0.5)), plates[1], ball)
    system.place(ball, position=(0.0, 0.0, -0.5))
    with pytest.raises(ns.RunFailed, match="joints contradict each other"):
        ns.simulate(system, 0.1)


def test_a_joined_point_mass_ends_a_run() -> None:
    """Round-off moves a body of next to no inertia; with the inertia of the message the run reaches its end."""

    def pendulum(moment: float) -> ns.System:
        pivot, upper, lower = DrivenBody(), PlanarBody(1.0, 1e-3), PlanarBody(1e-3, moment)
        system = ns.System([pivot, upper, lower])
        system.joint(Hinge(second=(0.0, 0.0, 1.0)), pivot, upper)
        system.joint(Hinge(second=(0.0, 0.0, 1.0)), upper, lower)
        upper_x, upper_z = -math.sin(0.2), -math.cos(0.2)
        system.place(upper, position=(upper_x, upper_z), angle=0.2)
        system.place(lower, position=(upper_x - math.sin(0.5), upper_z - math.cos(0.5)), angle=0.5)
        return system

    with pytest.raises(ns.RunFailed, match=r"apart by .* let no inertia be below 1e-8"):
        ns.simulate(pendulum(1e-16), 0.05)
    assert ns.simulate(pendulum(1e-8), 0.05).status == "done"
    with pytest.raises(ns.InvalidInput, match=r"moment must be > 0 .* of a point mass 1e-8 m l\^2"):
        pendulum(0.0)


def test_far_from_the_origin() -> None:
    """Where round-off exceeds the tolerance of gaps, the rates of the joints are still kept at zero."""
    plate, ball, away = Plate(), Ball(0.1), 1000.0
    system = ns.System([plate, ball])
    system.joint(Hinge((away, 0.0, 0.0), (0.0, 0.0, 0.5)), plate, ball)
    turned = (math.cos(0.25), 0.0, math.sin(0.25), 0.0)
    system.place(ball, position=(away - 0.5 * math.sin(0.5), 0.0, -0.5 * math.cos(0.5)), orientation=turned)
    solution = ns.simulate(system, 20.0)
    q, u = solution.of(ball)
    radius = q[:, :3] - (away, 0.0, 0.0)
    np.testing.assert_allclose(np.hypot(radius[:, 0], radius[:, 2]), 0.5, rtol=0, atol=1e-9)
    # across the arm only
    np.testing.assert_allclose(np.sum(radius * u[:, :3], axis=1), 0.0, atol=1e-7)
    assert solution.energy.residual <= 1e-7


def test_a_fast_linkage_runs_beside_a_free_body() -> None:
    """The first attempted step overflows; the free body declared within the linkage does not carry this on."""
    plate, arm, free, rod = Plate(), BoxBody(0.05, 0.01, 0.01), Ball(0.01), BoxBody(0.05, 0.01, 0.008)
    system = ns.System((plate, arm, free, rod), gravity=(0.0, 0.0, 0.0))
    rate = 1e4
    system.place(arm, position=(0.0, 0.0, 1.0))
    system.place(free, position=(0.0, 1.0, 1.0), velocity=(1.0, 0.0, 0.0))
    spin, velocity = (rate, 2.0 * rate, 3.0 * rate), (0.0, 0.15 * rate, -0.1 * rate)
    system.place(rod, position=(0.1, 0.0, 1.0), velocity=velocity, angular_velocity=spin)
    system.joint(BallJoint((-0.05, 0.0, 1.0), (-0.05, 0.0, 0.0)), plate, arm)
    system.joint(BallJoint((0.05, 0.0, 0.0), (-0.05, 0.0, 0.0)), arm, rod)
    for pair in itertools.combinations((plate, arm, free, rod), 2):
        system.exclude(*pair)
    solution = ns.simulate(system, 1e-3)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-6
    np.testing.assert_allclose(solution.of(free)[0][-1, :3], (1e-3, 1.0, 1.0), atol=1e-12)
