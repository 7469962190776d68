"""Compliant contacts against closed forms: restitution, duration, chains, cohesion, friction within an impact."""

from __future__ import annotations

import contextlib
import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

import nonsmooth as ns
from bodies import Ball, Box, BoxBody, CapsuleBody, DrivenBody, Plate, Rest, Sphere
from laws import (
    Cohesive,
    Coulomb,
    Directional,
    EnergeticImpact,
    Frictionless,
    HertzCompliant,
    HuntCrossley,
    LankaraniNikravesh,
    LinearCompliant,
    Unilateral,
)
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import CompliantNormalLaw, FrictionLaw

RADIUS = 0.01
MASS = Ball(RADIUS).total_mass
G = 9.81
TIGHT = ns.EventDriven(tolerance=1e-12)


def _drop(
    law: CompliantNormalLaw,
    speed: float,
    t_end: float,
    *,
    friction: FrictionLaw | None = None,
    slip: float = 0.0,
    gap: float = 1e-4,
    gravity: float = 0.0,
    engine: ns.EventDriven = TIGHT,
) -> ns.Solution:
    """Run a ball that comes down on a plate."""
    plate, ball = Plate(), Ball(RADIUS)
    system = ns.System([plate, ball], gravity)
    system.contact(plate, ball, normal=law, friction=friction or Frictionless())
    system.place(ball, position=(0.0, 0.0, RADIUS + gap), velocity=(slip, 0.0, -speed))
    return ns.simulate(system, t_end, sample_interval=t_end, engine=engine)


def _chain(law: CompliantNormalLaw, count: int, engine: ns.EventDriven = TIGHT) -> Any:
    """Return the velocities after a ball at 1 m/s has hit a row of touching ones."""
    balls = [Ball(RADIUS) for _ in range(count)]
    system = ns.System(balls, 0.0)
    for i, ball in enumerate(balls):
        first = {"position": (-1e-4, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0)}
        system.place(ball, **(first if i == 0 else {"position": (2.0 * RADIUS * i, 0.0, 0.0)}))
    for one, other in itertools.pairwise(balls):
        system.contact(one, other, normal=law, friction=Frictionless())
    return ns.simulate(system, 3e-3, sample_interval=3e-3, engine=engine).u_end[::6]


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.3, 0.6, 0.9])
def test_linear_restitution(ratio: float) -> None:
    """The spring leaves the ball alone where its force vanishes, which is before the gap does (Schwager, Poeschel)."""
    stiffness = 1e6
    omega = math.sqrt(stiffness / MASS)
    decay, damped = ratio * omega, omega * math.sqrt(1.0 - ratio**2)
    end = math.pi / damped
    if ratio > 0.0:
        # F = 0 where tan(w t) = 2 b w / (b^2 - w^2)
        end = (math.atan2(2.0 * decay * damped, decay**2 - damped**2) % math.pi) / damped
    restitution = math.exp(-decay * end) * (decay / damped * math.sin(damped * end) - math.cos(damped * end))
    solution = _drop(LinearCompliant(stiffness, 2.0 * decay * MASS), 0.7, 4e-3)
    assert solution.u_end[2] == pytest.approx(0.7 * restitution, rel=1e-8)
    assert solution.energy.residual < 1e-9


def test_hertz_duration() -> None:
    """The time of contact by quadrature of the energy, and nothing lost."""
    stiffness, speed = 1e9, 0.3
    depth = (5.0 * MASS * speed**2 / (4.0 * stiffness)) ** 0.4
    # x = depth (1 - s^2) takes the root out of the integrand
    duration = 2.0 * depth / speed * quad(lambda s: 2.0 * s / math.sqrt(1.0 - (1.0 - s * s) ** 2.5), 0.0, 1.0)[0]
    solution = _drop(HertzCompliant(stiffness), speed, 2e-3)
    events = solution.events
    assert list(events.cause[1:]) == [Cause.TOUCH, Cause.LIFT_OFF]
    assert events.time[1] == pytest.approx(1e-4 / speed, rel=1e-12)
    assert events.time[2] - events.time[1] == pytest.approx(duration, rel=1e-9)
    assert solution.u_end[2] == pytest.approx(speed, rel=1e-10)


def _damped(d: float) -> float:
    """Return e of (1 + e) d = ln((1 + d) / (1 - e d)), d being the damping times the speed."""
    return float(
        brentq(lambda e: (1.0 + e) * d - math.log((1.0 + d) / (1.0 - e * d)), 1e-12, min(1.0, 1.0 / d - 1e-14))
    )


@settings(max_examples=25, deadline=None)
@given(
    d=st.floats(0.01, 5.0),
    speed=st.floats(0.05, 2.0),
    exponent=st.floats(1.0, 2.5),
    stiffness=st.floats(1e6, 1e10),
)
def test_hunt_crossley_restitution(d: float, speed: float, exponent: float, stiffness: float) -> None:
    """The same for every stiffness and exponent."""
    depth = (0.5 * (exponent + 1.0) * MASS * speed**2 / stiffness) ** (1.0 / (exponent + 1.0))
    law = HuntCrossley(stiffness, d / speed, exponent)
    solution = _drop(law, speed, 1e-4 / speed + 40.0 * (1.0 + d) * depth / speed)
    assert solution.u_end[2] == pytest.approx(_damped(d) * speed, rel=1e-7)


@pytest.mark.parametrize("restitution", [0.5, 0.9, 1.0])
@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_lankarani_nikravesh_restitution(restitution: float, speed: float) -> None:
    """One restitution at all speeds, above the nominal one where that is small."""
    d = 0.75 * (1.0 - restitution**2)
    expected = 1.0 if d == 0.0 else _damped(d)
    solution = _drop(LankaraniNikravesh(1e9, restitution), speed, 1e-4 / speed + 2e-3)
    assert solution.u_end[2] == pytest.approx(expected * speed, rel=1e-8)


@pytest.mark.parametrize("part", [1.0 - 1e-6, 1.0 + 1e-6])
def test_cohesion_lets_go_of_the_faster(part: float) -> None:
    """A ball gets away iff its kinetic energy exceeds that of the spring at its largest tension."""
    stiffness, tension = 1e6, 20.0
    speed = part * tension / math.sqrt(MASS * stiffness)
    solution = _drop(Cohesive(stiffness, tension), speed, 0.02)
    assert (solution.events.count(Cause.LIFT_OFF) == 1) == (part > 1.0)
    if part > 1.0:
        assert solution.u_end[2] ** 2 == pytest.approx(speed**2 - (speed / part) ** 2, abs=1e-10 * speed**2)


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (HertzCompliant(1e9), (-0.07095235, 0.07640304, 0.99454931)),
        (LinearCompliant(1e7), (-0.13026170, 0.15022957, 0.98003213)),
        (HertzCompliant(1e9), (-0.07108502, -0.03027376, -0.01446363, 0.12704499, 0.98877742)),
    ],
)
def test_rows_of_balls(law: CompliantNormalLaw, expected: tuple[float, ...]) -> None:
    """A ball into a touching row at rest, in real time: the values of the impact law without restitution loss."""
    np.testing.assert_allclose(_chain(law, len(expected)), expected, rtol=0, atol=1e-8)


def test_order() -> None:
    """The error of a row falls with the tolerance."""
    truth = np.array((-0.07095235, 0.07640304, 0.99454931))
    errors = [
        np.max(np.abs(_chain(HertzCompliant(1e9), 3, ns.EventDriven(tolerance=t)) - truth)) for t in (1e-3, 1e-5, 1e-7)
    ]
    assert errors[0] < 1e-2
    assert errors[1] < 0.1 * errors[0]
    assert errors[2] < 0.1 * errors[1]


@pytest.mark.parametrize("part", [0.999, 1.001])
@pytest.mark.parametrize("law", [HertzCompliant(1e9), LinearCompliant(1e6)])
def test_oblique(law: CompliantNormalLaw, part: float) -> None:
    """A ball without spin sticks within the impact iff |v_t| <= 7 mu |v_n|, and rolls off; else Coulomb's impulse."""
    mu = 0.15
    slip = part * 7.0 * mu
    solution = _drop(law, 1.0, 3e-3, friction=Coulomb(mu), slip=slip)
    sticks = Cause.SLIP_TO_STICK in solution.events.cause
    assert sticks == (part < 1.0)
    expected = 5.0 / 7.0 * slip if sticks else slip - 2.0 * mu
    assert solution.u_end[0] == pytest.approx(expected, rel=1e-8)


def test_what_starts_in_touch_is_damped_by_no_rate_of_round_off() -> None:
    """A ball that spins on a slope is there from the start; the law's damping was scaled by its 1e-16 m/s."""
    ends = []
    for law in (LankaraniNikravesh(2e7, 0.75), HertzCompliant(2e7)):
        plate, ball = Plate(Rest(slope=0.05005)), Ball(RADIUS)
        system = ns.System([plate, ball], G)
        system.contact(plate, ball, normal=law, friction=Frictionless())
        spin = (70.9921, -303.3826, -176.9651)
        ns.touching(system, ball, position=(-0.02764, -0.01549, 0.08441), angular_velocity=spin)
        ends.append(ns.simulate(system, 1e-3, sample_interval=1e-3))
    assert np.array_equal(ends[0].q_end, ends[1].q_end)


def test_it_comes_to_rest_on_its_indentation() -> None:
    """Bounces die out, and gravity holds the balance of k x^(3/2)."""
    stiffness = 1e7
    solution = _drop(HuntCrossley(stiffness, 30.0), 0.05, 0.6, gap=1e-5, gravity=G)
    assert RADIUS - solution.q_end[2] == pytest.approx((MASS * G / stiffness) ** (2.0 / 3.0), rel=1e-6)
    assert abs(solution.u_end[2]) < 1e-8


@settings(max_examples=40)
@given(
    stiffness=st.floats(4.0, 8.0),
    beside=st.floats(0.0, 0.8),
    height=st.floats(2.1, 6.0),
    speed=st.floats(0.0, 2.0),
    t_end=st.floats(0.05, 0.3),
)
def test_no_long_step_goes_through(stiffness: float, beside: float, height: float, speed: float, t_end: float) -> None:
    """A ball comes no nearer to a held one than its energy takes it, however long the steps before they touch."""
    stiffness = 10.0**stiffness
    held, ball = DrivenBody(carried=(Sphere(radius=RADIUS),)), Ball(RADIUS)
    system = ns.System([held, ball], gravity=G)
    system.contact(held, ball, normal=HertzCompliant(stiffness), friction=Frictionless())
    system.place(ball, position=(beside * RADIUS, 0.0, height * RADIUS), velocity=(0.0, 0.0, -speed))
    solution = ns.simulate(system, t_end)
    energy = MASS * (0.5 * speed**2 + G * height * RADIUS)
    nearest = float(np.min(np.linalg.norm(solution.q[:, :3], axis=1)))
    assert nearest >= 2.0 * RADIUS - (2.5 * energy / stiffness) ** 0.4
    end = MASS * (0.5 * np.sum(solution.u_end[:3] ** 2) + G * solution.q_end[2])
    stored = stiffness * max(0.0, 2.0 * RADIUS - float(np.linalg.norm(solution.q_end[:3]))) ** 2.5 / 2.5
    assert end + stored == pytest.approx(energy, rel=1e-6)


@pytest.mark.parametrize("t_end", [0.02, 0.1, 1.0])
@pytest.mark.parametrize("beside", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("stiffness", [1e6, 1e8, 1e10])
def test_no_first_step_goes_through_from_a_touch(stiffness: float, beside: float, t_end: float) -> None:
    """A ball that starts in touch with a held one and moves into it is thrown back, however long steps may be."""
    speed = 3.0
    held, ball = DrivenBody(carried=(Sphere(radius=RADIUS),)), Ball(RADIUS)
    system = ns.System([held, ball], gravity=0.0)
    system.contact(held, ball, normal=HertzCompliant(stiffness), friction=Frictionless())
    start = (2.0 * RADIUS * beside, 0.0, 2.0 * RADIUS * math.sqrt(1.0 - beside**2))
    system.place(ball, position=start, velocity=(0.0, 0.0, -speed))
    solution = ns.simulate(system, t_end, sample_interval=2e-4)
    nearest = float(np.min(np.linalg.norm(solution.q[:, :3], axis=1)))
    assert nearest >= 2.0 * RADIUS - (2.5 * 0.5 * MASS * speed**2 / stiffness) ** 0.4
    assert np.linalg.norm(solution.u_end[:3]) == pytest.approx(speed, rel=1e-7)
    if beside == 0.0:
        assert solution.u_end[2] == pytest.approx(speed, rel=1e-7)


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_slips_that_turn_round_at_once() -> None:
    """Of a guard that jumps where a step begins the root is there: the search for it did not come back."""
    plate, capsule = Plate(), CapsuleBody(radius=0.01364, half_length=0.01221, density=1200.0)
    friction = Directional(forward=0.1068, backward=0.5881, across=0.4556, axis=(-0.16, -1.691, 1.274), body="first")
    system = ns.System([plate, capsule], 9.81)
    system.contact(plate, capsule, normal=HuntCrossley(5.39e6, 0.8088), friction=friction)
    orientation = (-0.15532624011010426, 0.5238866768694691, 0.41275372006699157, -0.728732375775073)
    ns.resting(system, capsule, position=(0.0088, 0.00386, 0.04957), orientation=orientation)
    solution = ns.simulate(system, 0.2285, sample_interval=0.0005)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-7


def test_among_rigid_contacts() -> None:
    """A rigid impact on a ball that lies on a compliant plate: the impact first, then the plate, the energy kept."""
    plate, lower, upper = Plate(), Ball(RADIUS), Ball(RADIUS)
    system = ns.System([plate, lower, upper], 0.0)
    system.contact(plate, lower, normal=HertzCompliant(1e9), friction=Coulomb(0.3))
    system.contact(lower, upper, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(1.0))
    system.place(lower, position=(0.0, 0.0, RADIUS))
    system.place(upper, position=(0.0, 0.0, 3.0 * RADIUS + 1e-3), velocity=(0.0, 0.0, -1.0))
    solution = ns.simulate(system, 3e-3, engine=TIGHT)
    assert solution.events.causes()[1] == "impact"
    # the balls exchange their velocities, the plate turns the lower one's, and they exchange again
    np.testing.assert_allclose(solution.u_end[[2, 8]], [0.0, 1.0], rtol=0, atol=1e-9)
    assert solution.energy.residual < 1e-10


def test_a_start_in_contact_and_overlap() -> None:
    """Compliant bodies may start with an indentation, which no rigid ones may."""
    depth, stiffness = 1e-5, 1e6
    solution = _drop(LinearCompliant(stiffness), 0.0, 3e-3, gap=-depth)
    assert solution.u_end[2] == pytest.approx(depth * math.sqrt(stiffness / MASS), rel=1e-9)
    plate, ball = Plate(), Ball(RADIUS)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, RADIUS - depth))
    with pytest.raises(ns.InvalidInput, match="must not overlap"):
        ns.simulate(system, 1e-3)


def box_on_an_edge(seed: int, stiffness: float) -> ns.System:
    """Return a box that falls on the edge of one that is held, turned by chance, without friction and losses."""
    random = np.random.default_rng(seed)
    held, box = DrivenBody(Rest(), (Box(0.01, 0.01, 0.01),)), BoxBody(0.008, 0.006, 0.01)
    system = ns.System([held, box], G)
    system.contact(held, box, normal=LinearCompliant(stiffness), friction=Frictionless())
    turn = random.normal(size=4)
    system.place(
        box,
        position=(0.009, 0.008, 0.03),
        orientation=tuple(turn / np.linalg.norm(turn)),
        velocity=(0.0, 0.0, -1.0),
        angular_velocity=tuple(30.0 * random.normal(size=3)),
    )
    return system


def _gained(solution: ns.Solution) -> float:
    """Return by how much the energy of the bodies, which are apart again, has grown, as a part of the kinetic one."""
    kinetic, potential = solution.history("kinetic_energy", "potential_energy").values()
    total = kinetic + potential
    return float((total[-1] - total[0]) / kinetic[0])


@pytest.mark.parametrize("seed", range(6))
def test_boxes_on_stiff_springs_part_with_the_energy_they_had(seed: int) -> None:
    """Shallow overlaps keep to the features that met."""
    solution = ns.simulate(box_on_an_edge(seed, 3e6), 0.05)
    assert solution.status == "done"
    assert Cause.TOUCH in solution.events.cause
    assert abs(_gained(solution)) < 1e-5


@pytest.mark.parametrize("seed", range(6))
def test_deep_overlaps_keep_the_energy_or_tell_that_they_jump(seed: int) -> None:
    """Of millimetres the features may change, and no edge may begin to push at the depth of a whole body."""
    with contextlib.suppress(ns.RunFailed):
        solution = ns.simulate(box_on_an_edge(seed, 3e3), 0.05)
        assert solution.status == "suspect" or abs(_gained(solution)) < 1e-5


def test_energy_of_springs_that_begin_inside_is_told() -> None:
    """An edge begins to push next to a deeper one: less deep, so that the run goes on, but it is suspect."""
    solution = ns.simulate(box_on_an_edge(11, 3e4), 0.05)
    assert _gained(solution) > 0.1
    assert solution.status == "suspect"
    assert "springs that began inside of bodies" in solution.message
    assert "stiffer or rounded ones do not" in solution.message
    assert "tolerance=" not in solution.message
