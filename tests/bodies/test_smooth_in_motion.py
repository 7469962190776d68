"""Smooth bodies in the engine: what is conserved, what a ball does, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    Box,
    BoxBody,
    CapsuleBody,
    DrivenBody,
    Ellipsoid,
    EllipsoidBody,
    Plate,
    Rest,
    Superellipsoid,
    SuperellipsoidBody,
)
from bodies.shapes.support_function import gauge_of, support_of
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN

Array = NDArray[np.float64]
ELASTIC: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(1.0)}


def _totals(bodies: Any, q: Array, u: Array) -> tuple[float, Array, Array]:
    """Return kinetic energy, momentum and angular momentum about the origin of free bodies."""
    energy, momentum, angular = 0.0, np.zeros(3), np.zeros(3)
    for i, body in enumerate(bodies):
        place, turn = q[7 * i : 7 * i + 3], Rotation.from_quat(np.roll(q[7 * i + 3 : 7 * i + 7], -1))
        v, w = u[6 * i : 6 * i + 3], u[6 * i + 3 : 6 * i + 6]
        moments = np.array(body.inertia)
        energy += 0.5 * body.total_mass * v @ v + 0.5 * w @ (moments * w)
        momentum += body.total_mass * v
        angular += body.total_mass * np.cross(place, v) + turn.apply(moments * w)
    return energy, momentum, angular


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_free_collisions_conserve_momentum_and_energy() -> None:
    """Two ellipsoids, a superellipsoid, a rounded one, a box and a capsule fly at each other, elastic, frictionless."""
    bodies = [
        EllipsoidBody(0.02, 0.03, 0.05),
        EllipsoidBody(0.03, 0.02, 0.02),
        SuperellipsoidBody(0.03, 0.02, 0.04, 1.4, 1.2),
        SuperellipsoidBody(0.02, 0.02, 0.03, 1.2, 1.0, 0.01),
        BoxBody(0.03, 0.02, 0.025),
        CapsuleBody(0.015, 0.03),
    ]
    system = ns.System(bodies, gravity=0.0)
    rng = np.random.default_rng(4)
    for i, one in enumerate(bodies):
        for other in bodies[i + 1 : 6]:
            # all but box and capsule, neither of which is smooth
            if i < 4:
                system.contact(one, other, **ELASTIC)
            else:
                system.exclude(one, other)
        place = 0.2 * np.array([np.cos(i), np.sin(i), 0.3 * rng.normal()])
        turn = np.roll(Rotation.random(random_state=i).as_quat(), 1)
        spin = tuple(rng.normal(size=3).tolist())
        system.place(
            one, position=tuple(place), orientation=tuple(turn), velocity=tuple(-3.0 * place), angular_velocity=spin
        )
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11, impact_tolerance=1e-12))
    assert solution.counters.impacts >= 5
    before, after = (
        _totals(bodies, q, u) for q, u in ((solution.q[0], solution.u[0]), (solution.q_end, solution.u_end))
    )
    assert after[0] == pytest.approx(before[0], rel=1e-9)
    scale = np.linalg.norm(before[1]) + np.sqrt(before[0] * bodies[0].total_mass)
    np.testing.assert_allclose(after[1], before[1], rtol=0, atol=1e-9 * scale)
    np.testing.assert_allclose(after[2], before[2], rtol=0, atol=1e-9 * scale)


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_a_superellipsoid_that_is_a_ball_bounces_like_one() -> None:
    """Round semi-axes, or all of it rounding but little: the events of a ball, oblique and with friction."""
    times = []
    for body in (Ball(0.02), SuperellipsoidBody(0.02, 0.02, 0.02), SuperellipsoidBody(0.01, 0.01, 0.01, rounding=0.01)):
        plate = Plate(Rest())
        system = ns.System([plate, body], gravity=9.81)
        system.contact(body, plate, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.8))
        system.place(body, position=(0.0, 0.0, 0.1), velocity=(0.3, 0.0, 0.0), angular_velocity=(0.0, -3.0, 2.0))
        solution = ns.simulate(system, 0.6, engine=ns.EventDriven(tolerance=1e-11, impact_tolerance=1e-11))
        times.append(solution.events.time)
    assert len(times[0]) > 3
    for other in times[1:]:
        np.testing.assert_allclose(other, times[0], rtol=0, atol=1e-9)


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_an_ellipsoid_rolls_over_a_box_and_its_edge() -> None:
    """The energy stays on the face and round the edge, until it slips off; what it loses then is what friction took."""
    roller, radius = EllipsoidBody(0.03, 0.05, 0.03, mass=0.1), 0.03
    table = DrivenBody(Rest(), (Box(0.1, 0.1, 0.05),))
    system = ns.System([table, roller], gravity=9.81)
    system.contact(table, roller, normal=Unilateral(), friction=Coulomb(2.0), impact=EnergeticImpact(0.0))
    system.place(
        roller, position=(0.08, 0.0, 0.05 + radius), velocity=(0.2, 0.0, 0.0), angular_velocity=(0.0, 0.2 / radius, 0.0)
    )
    solution = ns.simulate(system, 0.25, sample_interval=1e-3, engine=ns.EventDriven(tolerance=1e-12))
    # friction has its bound where the normal force ends, so that it slips a little before it leaves
    slips = solution.events.time[np.flatnonzero(solution.events.after[:, 0] != 1)[0]]
    on = solution.t < slips
    mass, moments = roller.total_mass, np.array(roller.inertia)
    energy = 0.5 * mass * np.sum(solution.u[:, :3] ** 2, axis=1) + 0.5 * np.sum(
        solution.u[:, 3:] ** 2 * moments, axis=1
    )
    energy += mass * 9.81 * solution.q[:, 2]
    assert solution.counters.impacts == 0
    assert np.max(solution.q[on, 0]) > 0.1
    assert np.ptp(energy[on]) <= 1e-9 * energy[0]
    assert energy[-1] == pytest.approx(energy[0] - solution.energy.friction_loss, rel=1e-9)
    assert 0.0 < solution.energy.friction_loss < 1e-4 * energy[0]


def test_exponents_without_curvatures_are_refused() -> None:
    """Too flat, a curvature that jumps, points too sharp, thin with flat points."""
    for along, across, told in ((0.1, 1.0, ">= 0.2"), (1.0, 0.5, "across must be 1"), (1.9, 1.2, "<= 1.8")):
        with pytest.raises(ns.InvalidInput, match=told):
            Superellipsoid(0.1, 0.2, 0.3, along, across)
    with pytest.raises(ns.InvalidInput, match="must be 1 where exponent_along is 1"):
        SuperellipsoidBody(0.1, 0.2, 0.3, 1.0, 1.2)
    with pytest.raises(ns.InvalidInput, match=r"ratio of the longest semi-axis.* at most 10 .*it is 31"):
        Superellipsoid(0.31, 0.2, 0.01, 0.5, 0.5)


@settings(max_examples=50, deadline=None)
@given(st.floats(1.01, 1.8), st.floats(1.0, 1.8), st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_radii_of_curvature_are_derivatives_of_the_support_point(along: float, across: float, way: list[float]) -> None:
    """The second derivative of the support function by differences of the first, at any direction off the axes."""
    n = np.array(way)
    if np.min(np.abs(n)) < 0.05:
        return
    n /= np.linalg.norm(n)
    core = Superellipsoid(0.2, 0.3, 0.4, along, across).core
    h, point, (xx, yy, zz, yz, xz, xy) = support_of(core, n.tolist())
    assert h == pytest.approx(float(n @ point), rel=1e-13)
    second = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    # the point lies on the surface
    assert gauge_of(core, point) == pytest.approx(1.0, rel=1e-13)
    # it does not change along the direction itself
    np.testing.assert_allclose(second @ n, 0.0, rtol=0, atol=1e-12)
    step = 1e-6 * np.eye(3)
    points = [np.subtract(support_of(core, (n + e).tolist())[1], support_of(core, (n - e).tolist())[1]) for e in step]
    np.testing.assert_allclose(np.array(points) / 2e-6, second, rtol=0, atol=1e-6)


def test_smooth_bodies_slide_on_each_other_in_few_steps() -> None:
    """What a stage overlaps has a gap, however far from the state: a superellipsoid slides on a held ellipsoid."""
    held = DrivenBody(Rest(), (Ellipsoid(0.0146, 0.013, 0.0094),))
    body = SuperellipsoidBody(0.0151, 0.0101, 0.0159, 0.46, 0.64, density=1200.0)
    system = ns.System([held, body], gravity=9.81)
    system.contact(held, body, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.0))
    ns.touching(system, body, position=(0.002, 0.001, 0.03), angular_velocity=(15.0, -20.0, 10.0))
    solution = ns.simulate(system, 0.01)
    assert solution.counters.steps < 100
    assert solution.counters.rejected < 20
    assert solution.energy.unexplained < 1e-9 * solution.energy.scale
