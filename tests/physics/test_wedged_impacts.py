"""Impacts of points that joints let move in a plane or on a line only: slip and approach come to rest together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BallJoint, CylinderBody, Dumbbell, Plate
from laws import Coulomb, EnergeticImpact, Stribeck, Unilateral


def _on_a_line(angle: float, mass: float = 0.7, speed: float = 0.4) -> tuple[Any, Any, Any, Any]:
    """M, W, N, u of a point on a line at ``angle`` from the normal, approaching."""
    line = np.array([math.cos(angle), math.sin(angle) * math.cos(0.3), math.sin(angle) * math.sin(0.3)])
    return np.array([[mass]]), line[None, :1], line[None, None, 1:], np.array([-speed])


@pytest.mark.filterwarnings("ignore:.*outside the usual range")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.2, 0.95, 1.05, 3.0])
@pytest.mark.parametrize("angle", [1e-3, 0.2, 1.0, 1.5])
def test_a_point_on_a_line_rebounds_unless_the_line_is_in_the_cone_of_friction(
    angle: float, friction: float, e: float
) -> None:
    """Friction opposes motion both ways; where it can hold the force of the contact alone, all of that stays stored."""
    mass, normal, tangential, u = _on_a_line(angle)
    mu = friction / math.tan(angle)
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(e)], [Coulomb(mu)])
    before = 0.5 * mass[0, 0] * u[0] ** 2
    stored = before / (1.0 + friction)
    after = e**2 * stored * max(0.0, 1.0 - friction)
    assert result.stored[0] == pytest.approx(stored, rel=1e-9)
    assert 0.5 * mass[0, 0] * result.velocity[0] ** 2 == pytest.approx(after, abs=1e-9 * before)
    assert result.velocity[0] >= -1e-10
    assert result.returned[0] == pytest.approx(e**2 * stored if friction < 1.0 else 0.0, abs=1e-9 * before)


@pytest.mark.parametrize("heavy", [1e11, 1e12, 1e13, 1e14, 1e15])
@pytest.mark.parametrize("heading", np.linspace(0.0, 3.0, 7))
def test_a_line_that_round_off_makes_a_plane_wedges_all_the_same(heading: float, heavy: float) -> None:
    """Joints leave their coefficients with errors like those of a second, very heavy, way to move."""
    _, normal, tangential, u = _on_a_line(1.0)
    across = np.array([[0.3, math.cos(heading), math.sin(heading)]])
    normal, tangential = np.vstack([normal, across[:, :1]]), np.vstack([tangential, across[:, None, 1:]])
    mass, u = np.diag([0.7, heavy]), np.array([u[0], 0.0])
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(0.5)], [Coulomb(1.2)], tolerance=1e-8)
    stored = 0.5 * 0.7 * u[0] ** 2 / (1.0 + 1.2 * math.tan(1.0))
    assert result.stored[0] == pytest.approx(stored, rel=1e-7)
    assert abs(result.velocity[0]) < 1e-7


def _jointed(seed: int) -> tuple[Any, Any, Any, Any]:
    """M, W, N, u of a body on a ball joint, a hinge or a slider, one or two points of which collide."""
    random = np.random.default_rng(seed)
    shape = np.linalg.qr(random.normal(size=(3, 3)))[0]
    inertia = shape @ np.diag(random.uniform(0.3, 2.0, 3)) @ shape.T
    arm, axis = random.normal(size=3), random.normal(size=3)
    if seed % 3 == 0:
        velocities, turns = np.cross(np.eye(3), arm), np.eye(3)
    elif seed % 3 == 1:
        velocities, turns = np.cross(axis, arm)[None, :], axis[None, :]
    else:
        velocities, turns = axis[None, :], np.zeros((1, 3))
    mass = velocities @ velocities.T + turns @ inertia @ turns.T
    frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
    n = 1 + seed % 2
    points = [velocities + np.cross(turns, random.normal(size=3)) for _ in range(n)]
    columns = np.stack([point @ frame for point in points], axis=1)
    u = random.normal(size=len(mass))
    u *= 1.0 if np.min(columns[:, :, 0].T @ u) < 0.0 else -1.0
    return mass, columns[:, :, 0], columns[:, :, 1:], u


@pytest.mark.parametrize("seed", range(60))
def test_jointed_bodies_keep_their_account(seed: int) -> None:
    """No approach is left, no energy is gained or lost without a word."""
    mass, normal, tangential, u = _jointed(seed)
    random = np.random.default_rng(1000 + seed)
    e, mu, n = random.uniform(0.0, 1.0), random.uniform(0.02, 1.2), normal.shape[1]
    friction = Coulomb(mu) if seed % 4 else Stribeck(mu + 0.2, 1.0, mu)
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(e)] * n, [friction] * n)
    before, after = (0.5 * v @ mass @ v for v in (u, result.velocity))
    lost = np.sum(result.restitution_loss) + np.sum(result.friction_loss)
    assert after + lost == pytest.approx(before, rel=1e-9)
    assert after <= before * (1.0 + 1e-10)
    assert np.min(normal.T @ result.velocity) >= -1e-8 * np.max(np.abs(normal.T @ u))
    assert np.min(result.friction_loss) >= -1e-10 * before


def test_a_contact_that_hardly_moves_along_its_normal_leaves_the_others_exact() -> None:
    """Its own small coefficient says nothing of which slips and impulses are small elsewhere on the body."""
    line = np.array([[4.5e-3, -0.079, -0.70], [-1.17, 0.25, -0.80]])
    mass, u = np.array([[1.0]]), np.array([2.7])
    law, friction = [EnergeticImpact(0.0176)] * 2, [Coulomb(0.0924)] * 2
    result = ns.solve_impact(mass, line[None, :, 0], line[None, :, 1:], u, law, friction)
    after = 0.5 * float(result.velocity @ mass @ result.velocity)
    lost = np.sum(result.restitution_loss) + np.sum(result.friction_loss)
    assert after + lost == pytest.approx(0.5 * 2.7**2, rel=1e-9)


def _hung(body: Any, first: Any, second: Any, position: Any, orientation: Any) -> ns.System:
    plate = Plate()
    system = ns.System([plate, body])
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.place(body, position=position, orientation=orientation)
    system.joint(BallJoint(first=first, second=second), plate, body)
    return system


def test_a_dumbbell_on_a_ball_joint_strikes() -> None:
    system = _hung(
        Dumbbell(0.003417, 4.89),
        (-0.010569133034496175, 0.032528853589546027, 0.02124416628282459),
        (0.016516647675778904, -0.018001448419855716, 0.003922670872844571),
        (-0.006233, 0.008464, 0.01746),
        (-0.30592826560001074, 0.6016441556041544, 0.2960170338108167, -0.6758743389330439),
    )
    solution = ns.simulate(system, 0.3)
    assert solution.counters.impacts > 0
    assert abs(solution.energy.residual) < 1e-8


def test_a_cylinder_on_a_ball_joint_strikes() -> None:
    system = _hung(
        CylinderBody(0.01822, 0.008148, 2700.0),
        (0.018567566062342895, -0.004121289209882834, 0.030303200045028504),
        (-0.005602408388243476, -0.012420062239514263, 0.008170670956449869),
        (0.003129, -0.001666, 0.02747),
        (-0.08077728821967645, 0.4714258540827525, -0.7567763688447278, 0.4455583254394548),
    )
    solution = ns.simulate(system, 0.3)
    assert solution.counters.impacts > 0
    assert abs(solution.energy.residual) < 1e-8


def resting_wedge(seed: int) -> tuple[Any, ...]:
    """M, W, N, u and laws of balls that touch walls and one another and slip; one contact closes, the others rest."""
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 6))
    m = int(random.integers(n, 2 * n + 1))
    jacobian = np.zeros((6 * n, m, 3))
    for contact in range(m):
        first, second = random.choice(n, 2, replace=False)
        wall = random.random() < 0.6
        axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
        for r, axis in enumerate(axes):
            turn = np.cross(axes[0], axis)
            jacobian[6 * first : 6 * first + 6, contact, r] = [*axis, *-turn]
            if not wall:
                jacobian[6 * second : 6 * second + 6, contact, r] = [*-axis, *-turn]
    mobility = np.tile([1.0, 1.0, 1.0, 2.5, 2.5, 2.5], n) * np.repeat(random.choice([1.0, 7.0], n), 6)
    normal, u, hit = jacobian[:, :, 0], random.normal(size=6 * n), int(random.integers(m))
    resting = np.delete(normal, hit, axis=1)
    if m > 1:
        u -= resting @ np.linalg.lstsq(resting.T @ resting, resting.T @ u, rcond=1e-10)[0]
    u = u if normal[:, hit] @ u < 0.0 else -u
    u = 1e-3 * (u + 1e-9 * random.normal(size=6 * n))
    impact = [EnergeticImpact(float(e)) for e in random.choice([0.5, 0.7, 0.9], m)]
    return (
        np.diag(1.0 / mobility),
        normal,
        jacobian[:, :, 1:],
        u,
        impact,
        [Coulomb(float(mu)) for mu in random.choice([0.15, 0.5, 0.8], m)],
    )


@pytest.mark.parametrize("seed", [267, 626, 669, 1199])
def test_slips_that_leave_their_bounds_slowly_take_long_steps(seed: int) -> None:
    """Their directions are stiff; steps that follow them ask for twenty thousand and more."""
    mass, normal, tangential, u, *laws = resting_wedge(seed)
    result = ns.solve_impact(mass, normal, tangential, u, *laws)
    before, after = 0.5 * u @ mass @ u, 0.5 * result.velocity @ mass @ result.velocity
    lost = np.sum(result.restitution_loss) + np.sum(result.friction_loss)
    assert result.steps < 5000
    assert np.min(normal.T @ result.velocity) > -1e-10
    assert np.all(result.friction_loss >= -1e-12 * before)
    assert before - after == pytest.approx(lost, abs=1e-8 * before)
