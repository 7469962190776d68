"""Forces, and what they do to momentum and energy, against closed forms."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, BoxBody, Distance, Dumbbell, Hinge, Plate, Rest
from laws import Anisotropic, Cohesive, Coulomb, EnergeticImpact, Unilateral, Viscous
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.plugins import registry
from nonsmooth.solution.checks import impulses_beyond_cone
from tests.histories.closed import closed_contacts

GRAVITY = 9.81
SLOPE = 0.3
_FORCES = ("normal_force", "friction_force", "contact_normal", "contact_point", "slip_velocity")


@pytest.mark.parametrize(("friction", "share"), [(0.5, 2.0 / 7.0 * math.sin(SLOPE)), (0.05, 0.05 * math.cos(SLOPE))])
def test_a_ball_on_a_slope(build: Any, friction: float, share: float) -> None:
    """One that rolls feels 2/7 of the pull, one that slips its coefficient; the plate bears the rest."""
    ball = Ball(0.1)
    system = build.over(ball, Rest(slope=SLOPE), friction=friction)
    ns.resting(system, ball)
    solution = ns.simulate(system, 0.4)
    weight = ball.total_mass * GRAVITY
    up = np.array([-math.cos(SLOPE), 0.0, math.sin(SLOPE)])
    contact = solution.history(*_FORCES, times=[0.31, 0.07], of=solution.system.contacts[0])
    force, rub, normal, points, slip = (contact[name][:, 0] for name in _FORCES)
    np.testing.assert_allclose(force, weight * math.cos(SLOPE), rtol=1e-9)
    np.testing.assert_allclose(rub, weight * share * np.tile(up, (2, 1)), rtol=0, atol=1e-8 * weight)
    arm = points[:, 1] - solution.history("position", times=[0.31, 0.07], of=ball)["position"][:, 0]
    np.testing.assert_allclose(arm, -0.1 * normal, rtol=0, atol=1e-9)
    np.testing.assert_allclose(np.sum(normal * up, axis=1), 0.0, atol=1e-12)
    slips = np.linalg.norm(slip, axis=1)
    sliding = GRAVITY * np.array([0.31, 0.07]) * (math.sin(SLOPE) - 3.5 * share)
    np.testing.assert_allclose(slips, sliding if friction < 0.1 else 0.0, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("friction", [0.6, 0.2])
def test_a_block_on_a_slope(build: Any, friction: float) -> None:
    """Whatever its corners share, together they bear the weight, and without a moment about the mass centre."""
    block = BoxBody(0.1, 0.1, 0.05, density=1000.0)
    system = build.over(block, Rest(slope=SLOPE), friction=friction)
    half = SLOPE / 2.0
    ns.resting(system, block, orientation=(math.cos(half), 0.0, math.sin(half), 0.0))
    solution = ns.simulate(system, 0.2)
    forces = closed_contacts(solution, 0.15)
    assert len(forces.contact) == 4
    weight = block.total_mass * GRAVITY
    np.testing.assert_allclose(forces.normal_force.sum(), weight * math.cos(SLOPE), rtol=1e-9)
    pull = math.sin(SLOPE) if friction == 0.6 else friction * math.cos(SLOPE)
    total = forces.friction_force.sum(axis=0)
    np.testing.assert_allclose(np.linalg.norm(total), weight * pull, rtol=1e-9)
    assert np.all(np.linalg.norm(forces.friction_force, axis=1) <= friction * forces.normal_force * (1.0 + 1e-7))
    arms = forces.contact_point[:, 1] - solution.history("position", times=0.15, of=block)["position"][0]
    whole = forces.normal_force[:, None] * forces.contact_normal + forces.friction_force
    np.testing.assert_allclose(np.cross(arms, whole).sum(axis=0), 0.0, atol=1e-8 * weight)


@pytest.mark.parametrize("joint", [BallJoint, Hinge])
def test_what_a_pendulum_hangs_from(joint: Any) -> None:
    """Along the arm weight and centripetal force, across it what the moment of inertia leaves; no moment."""
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball])
    system.joint(joint(second=(0.0, 0.0, 0.5)), plate, ball)
    angle = 1.2
    system.place(
        ball,
        position=(-0.5 * math.sin(angle), 0.0, -0.5 * math.cos(angle)),
        orientation=(math.cos(angle / 2), 0.0, math.sin(angle / 2), 0.0),
    )
    solution = ns.simulate(system, 2.0)
    times = np.random.default_rng(1).uniform(0.0, 2.0, 30)
    loads, states = solution.history("joint_force", "joint_point", "joint_moment", times=times), solution.at(times)
    along = -states["q"][:, :3] / 0.5
    rate = np.linalg.norm(states["u"][:, :3], axis=1) / 0.5
    lever = 0.5**2 / (0.5**2 + 0.4 * 0.1**2)
    down = np.array([0.0, 0.0, -GRAVITY])
    fall = down - np.outer(down @ along.T, np.ones(3)) * along
    force = ball.total_mass * ((rate**2 * 0.5 - along @ down)[:, None] * along - (1.0 - lever) * fall)
    np.testing.assert_allclose(loads["joint_force"][:, 0], force, rtol=0, atol=1e-7 * ball.total_mass * GRAVITY)
    np.testing.assert_allclose(loads["joint_point"][:, 0], 0.0, atol=1e-9)
    np.testing.assert_allclose(loads["joint_moment"][:, 0], 0.0, atol=1e-7 * ball.total_mass * GRAVITY)


def test_joints_bear_what_contacts_press(build: Any) -> None:
    """A rod between two balls on a plate, told second body first: statics, and the order of the system's joints."""
    plate, low, high = Plate(), Ball(0.1), Ball(0.1)
    system = ns.System([plate, low, high])
    system.joint(Distance((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.5), high, low)
    system.joint(Distance((0.4, 0.0, 0.3), (0.0, 0.0, 0.0), 0.5), plate, high)
    system.contact(low, plate, **build.laws(friction=0.0))
    system.place(low, position=(0.0, 0.0, 0.1))
    system.place(high, position=(0.0, 0.0, 0.6))
    solution = ns.simulate(system, 1e-3)
    loads, weight = solution.history("joint_force", times=0.0)["joint_force"], low.total_mass * GRAVITY
    # the slanting rod is the only one to hold the upper ball sideways, with no force at first
    expected = np.array([[0.0, 0.0, -weight], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(loads, expected, rtol=0, atol=1e-9 * weight)
    np.testing.assert_allclose(solution.history("normal_force", times=0.0)["normal_force"], [2.0 * weight], rtol=1e-12)


def test_forces_over_time_make_up_momentum() -> None:
    """Of the dumbbell on the vibrating plate: sticking, sliding, in flight, from one event or sample to the next."""
    system = registry.load("scenarios", "dumbbell")().build()
    body = system.bodies[-1]
    assert isinstance(body, Dumbbell)
    solution = ns.simulate(system, 0.5, sample_interval=1e-3)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    ends = np.unique(np.concatenate([solution.t, solution.events.time]))
    half, middle = np.diff(ends) / 2.0, (ends[1:] + ends[:-1]) / 2.0
    forces = closed_contacts(solution, (middle[:, None] + half[:, None] * nodes).ravel())
    sides = np.array([1.0 if contact.second is body else -1.0 for contact in system.contacts])
    each = forces.normal_force[:, None] * forces.contact_normal + forces.friction_force
    force = np.zeros((len(middle), 4, 3))
    at_node = np.repeat(np.arange(4 * len(middle)), np.diff(forces.first))
    np.add.at(force.reshape(-1, 3), at_node, sides[forces.contact, None] * each)
    pushed = half[:, None] * np.einsum("k,ikx->ix", weights, force)
    before, after = (
        solution.history("velocity", times=t, of=body)["velocity"][:, 0]
        for t in (ends[:-1], np.nextafter(ends[1:], 0.0))
    )
    gained = body.total_mass * (after - before + np.outer(2.0 * half, (0.0, 0.0, GRAVITY)))
    # where friction turns round within an interval, no quadrature of four nodes is exact
    smooth = np.all(np.sign(force[:, :, 1]) == np.sign(force[:, :1, 1]), axis=1)
    assert np.count_nonzero(~smooth) in range(5, 30)
    most = np.max(np.abs(pushed))
    np.testing.assert_allclose(pushed[smooth], gained[smooth], rtol=0, atol=1e-6 * most)
    np.testing.assert_allclose(pushed, gained, rtol=0, atol=0.1 * most)


def test_contact_histories_make_a_dataset() -> None:
    """Open contacts have zero forces and no contact points."""
    solution = ns.simulate(registry.load("scenarios", "dumbbell")().build(), 0.1)
    history, closed = solution.history("mode", *_FORCES), solution.at()["mode"] > 0
    data = history.to_xarray()
    np.testing.assert_array_equal(history["mode"] > 0, closed)
    for name in _FORCES:
        np.testing.assert_array_equal(data[name], history[name])
    assert np.all(history["normal_force"][~closed] == 0.0)
    assert np.all(np.isnan(history["contact_point"][~closed]))
    assert np.all(np.isfinite(history["contact_point"][closed]))
    assert data["normal_force"].attrs["units"] == "N"
    assert data.sizes["time"] == len(solution.t)


@pytest.mark.parametrize(
    "friction", [Coulomb(0.3), Coulomb(0.3, 0.5), Anisotropic(0.3, 0.1), Viscous(0.2, 0.3)], ids=str
)
def test_forces_and_impulses_outside_of_their_cones_are_marked(friction: FrictionLaw) -> None:
    """Those of a sliding box lie on the cone, within round-off; with a little more friction they are marked.

    So they are at one instant of small forces, next to another one of large ones.
    """
    plate, box = Plate(), BoxBody(0.02, 0.02, 0.01)
    system = ns.System([plate, box])
    system.contact(plate, box, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.5))
    system.place(box, position=(0.0, 0.0, 0.02), velocity=(0.5, 0.0, 0.0))
    solution = ns.simulate(system, 0.3)
    forces, impulses = closed_contacts(solution, solution.t), solution.history("normal_impulse", "friction_impulse")
    assert len(forces.contact) > 0
    assert not np.any(forces.beyond_cone)
    slides = (forces.mode == 2) & (forces.normal_force > 0.0)
    assert np.any(slides)
    entry = int(np.argmax(slides))
    instant = np.searchsorted(forces.first, entry, side="right") - 1
    small = np.zeros(len(forces.contact), dtype=bool)
    small[forces.first[instant] : forces.first[instant + 1]] = True
    factor = np.where(small, 1e-8, 1.0)
    rubbed = forces.friction_force * np.where(small & slides, 1.01, 1.0)[:, None]
    more = dataclasses.replace(
        forces, normal_force=forces.normal_force * factor, friction_force=rubbed * factor[:, None]
    )
    assert np.array_equal(more.beyond_cone, small & slides)
    assert not np.any(impulses_beyond_cone(solution))
    events, unknown = solution.events, np.full(len(impulses["normal_impulse"]), np.nan)
    pulls = -impulses["normal_impulse"] - 1e-3, impulses["friction_impulse"], unknown
    assert np.all(beyond_cones(system.contacts, events.listed, events.first, *pulls))


def test_what_pulls_by_a_law_that_may_is_not_marked() -> None:
    """A ball that hangs on a sticky ceiling."""
    ceiling, ball = Plate(Rest(orientation=ns.turned_about((1.0, 0.0, 0.0), np.pi))), Ball(0.01, mass=0.01)
    system = ns.System([ceiling, ball])
    system.contact(ceiling, ball, normal=Cohesive(1e4, 1.0, 1.0), friction=Coulomb(0.3))
    system.place(ball, position=(0.0, 0.0, -0.01), velocity=(0.0, 0.0, 0.01))
    forces = ns.simulate(system, 0.05).history("normal_force", "beyond_cone")
    assert np.any(forces["normal_force"] < 0.0)
    assert not np.any(forces["beyond_cone"])
