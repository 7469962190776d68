"""Rounded polyhedra and capsules in motion: conservation, rest, features that hand over, known limits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, CapsuleBody, DrivenBody, FreeBody, HalfSpace, HullBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from tests.bodies.polytopes import random_hull, tetrahedron
from tests.physics.test_polyhedra_runs import cloud, momenta


def _laws(friction: float, restitution: float) -> dict[str, Any]:
    law = Coulomb(friction) if friction > 0.0 else Frictionless()
    return {"normal": Unilateral(), "friction": law, "impact": EnergeticImpact(restitution=restitution)}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 5])
def test_colliding_rounded_bodies_keep_momentum_and_energy(seed: int) -> None:
    """Without friction and with e = 1, over 1 s, to 1e-9: rounded hulls, boxes and capsules, sharing slots."""
    rng = np.random.default_rng(seed)
    kinds = (
        lambda: HullBody(tetrahedron(rng, 0.05).points, rounding=5e-3),
        lambda: HullBody(random_hull(rng, 6, 0.04).points, rounding=1e-2),
        lambda: replace(BoxBody(*rng.uniform(0.02, 0.04, 3)), rounding=5e-3),
        lambda: CapsuleBody(0.015, 0.03),
    )
    bodies: list[FreeBody] = [kinds[i % 4]() for i in range(12)]
    solution = ns.simulate(cloud(bodies, rng), t_end=1.0)
    assert solution.events.causes().count("impact") >= 10
    before, after = momenta(bodies, solution.q[0], solution.u[0]), momenta(bodies, solution.q_end, solution.u_end)
    speeds = np.linalg.norm(solution.u[0].reshape(-1, 6)[:, :3], axis=1)
    momentum = sum(body.total_mass * speed for body, speed in zip(bodies, speeds, strict=True))
    np.testing.assert_allclose(after[0], before[0], rtol=0, atol=1e-13 * momentum)
    np.testing.assert_allclose(after[1], before[1], rtol=0, atol=1e-9 * float(np.max(np.abs(before[1]))))
    assert solution.energy.kinetic_end == pytest.approx(solution.energy.kinetic_start, rel=1e-9)


def _lying(yaw: float) -> Any:
    turn = Rotation.from_rotvec([0.0, 0.0, yaw]) * Rotation.from_rotvec([0.0, 0.5 * np.pi, 0.0])
    return np.roll(turn.as_quat(), 1)


@pytest.mark.parametrize(("half_length", "yaw"), [(0.02, 0.0), (0.02, 0.4), (0.05, 0.0), (0.05, 0.4)])
def test_a_capsule_lies_on_a_box(half_length: float, yaw: float) -> None:
    """On two contacts: its ends, or, where it is longer than the box, the crossings of its side and two edges."""
    plate, box, capsule = Plate(), BoxBody(0.03, 0.03, 0.02), CapsuleBody(0.005, half_length)
    system = ns.System([plate, box, capsule])
    for pair in ((plate, box), (box, capsule)):
        system.contact(*pair, **_laws(0.3, 0.3))
    system.place(box, position=(0.0, 0.0, 0.02))
    system.place(capsule, position=(0.002, 0.001, 0.045), orientation=_lying(yaw))
    solution = ns.simulate(system, t_end=0.5)
    assert solution.events.causes() == ["start"]
    assert len([code for code in solution.events.codes if code != 0]) == 4 + 2
    np.testing.assert_allclose(solution.q_end, solution.q[0], rtol=0, atol=1e-11)


def test_a_capsule_that_falls_on_a_box_comes_to_lie_on_it() -> None:
    plate, box, capsule = Plate(), BoxBody(0.03, 0.03, 0.02), CapsuleBody(0.005, 0.02)
    system = ns.System([plate, box, capsule])
    for pair in ((plate, box), (box, capsule), (plate, capsule)):
        system.contact(*pair, **_laws(0.3, 0.3))
    system.place(box, position=(0.0, 0.0, 0.02))
    turn = Rotation.from_rotvec([0.0, 0.5 * np.pi - 0.2, 0.0])
    system.place(capsule, position=(0.0, 0.0, 0.055), orientation=np.roll(turn.as_quat(), 1))
    solution = ns.simulate(system, t_end=1.0)
    assert solution.q_end[9] == pytest.approx(0.045, abs=1e-9)
    assert np.max(np.abs(solution.u_end)) < 1e-6


@pytest.mark.parametrize("rounding", [2e-4, 1e-3, 4e-3])
def test_a_rounded_box_that_falls_on_a_box_comes_to_lie_on_it(rounding: float) -> None:
    """With all its slips stopped at once in some impact."""
    plate, box, top = Plate(), BoxBody(0.03, 0.03, 0.02), BoxBody(0.01, 0.01, 0.01, rounding=rounding)
    system = ns.System([plate, box, top])
    for pair in ((plate, box), (box, top), (plate, top)):
        system.contact(*pair, **_laws(0.3, 0.3))
    system.place(box, position=(0.0, 0.0, 0.02))
    q = np.array([1.0, 0.3, 0.2, 0.1])
    system.place(top, position=(0.022, 0.005, 0.07), orientation=q / np.linalg.norm(q))
    solution = ns.simulate(system, t_end=1.0)
    assert solution.q_end[9] == pytest.approx(0.05, abs=1e-9)
    assert np.max(np.abs(solution.u_end)) < 1e-9


def test_a_rounded_box_rolls_over_its_edge() -> None:
    """A cube on a table turns about the axis of its rounded edge, which moves on like that of a wheel, without slip.

    Energy is that at the start, and the edge has gone forward by the radius times the angle.
    """
    half, radius = 0.02, 0.006
    plate, box = DrivenBody(Rest(), (HalfSpace(),)), BoxBody(half, half, half, rounding=radius)
    system = ns.System([plate, box])
    system.contact(plate, box, **_laws(0.9, 0.0))
    core, tilt = half - radius, 0.3
    turn = Rotation.from_rotvec([0.0, tilt, 0.0])
    edge = turn.apply([core, 0.0, -core])
    position = np.array([0.0, 0.0, radius]) - edge
    # the point of contact is at rest
    spin = 12.0
    velocity = spin * np.cross([0.0, 1.0, 0.0], position)
    system.place(
        box,
        position=position.tolist(),
        orientation=np.roll(turn.as_quat(), 1),
        velocity=velocity,
        angular_velocity=(0.0, spin, 0.0),
    )
    solution = ns.simulate(system, t_end=0.03, sample_interval=1e-3)
    assert solution.events.causes() == ["start"]
    axes = Rotation.from_quat(np.roll(solution.q[:, 3:7], -1, axis=1))
    angles = 2.0 * np.arctan2(solution.q[:, 5], solution.q[:, 3]) - tilt
    assert angles[-1] > 0.25
    edges = solution.q[:, :3] + axes.apply([core, 0.0, -core])
    np.testing.assert_allclose(edges[:, 0], radius * angles, rtol=0, atol=1e-9)
    np.testing.assert_allclose(edges[:, 2], radius, rtol=0, atol=1e-11)
    energy = solution.energy
    total = energy.kinetic_start + energy.potential_start
    assert energy.kinetic_end + energy.potential_end == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_a_rounded_box_slides_over_the_edge_of_another(angle: float) -> None:
    """Corners pass the edge, crossings of edges take over, it tips and falls; the books balance throughout."""
    plate, low = Plate(), BoxBody(0.05, 0.05, 0.02, rounding=2e-3)
    top = BoxBody(0.02, 0.02, 0.01, rounding=1e-3)
    system = ns.System([plate, low, top])
    system.contact(low, top, **_laws(0.1, 0.0))
    for body in (low, top):
        system.contact(plate, body, **_laws(0.5, 0.0))
    system.place(low, position=(0.0, 0.0, 0.02))
    turn = float(np.cos(0.5 * angle)), 0.0, 0.0, float(np.sin(0.5 * angle))
    system.place(top, position=(0.0, 0.003, 0.05), orientation=turn, velocity=(0.5, 0.0, 0.0))
    solution = ns.simulate(system, t_end=0.8)
    energy = solution.energy
    lost = energy.restitution_loss + energy.friction_loss + energy.closing_loss
    total = energy.kinetic_start + energy.potential_start
    assert energy.kinetic_end + energy.potential_end + lost == pytest.approx(total, abs=1e-8)
    assert solution.q_end[9] < 0.04
    assert float(np.min(solution.q[:, 9])) >= 0.01 - 1e-9


def test_an_almost_sharp_box_falls_like_a_sharp_one() -> None:
    """The motion tends to that of the sharp body as the radius goes to zero, in proportion to it."""

    def run(rounding: float) -> Any:
        plate, box = Plate(), BoxBody(0.01, 0.015, 0.02, rounding=rounding, mass=0.1)
        system = ns.System([plate, box])
        system.contact(plate, box, **_laws(0.4, 0.5))
        q = np.array([0.9, 0.3, 0.2, 0.1])
        system.place(box, position=(0.0, 0.0, 0.03), orientation=q / np.linalg.norm(q))
        return ns.simulate(system, t_end=0.06).q_end

    sharp, errors = run(0.0), []
    for rounding in (1e-6, 1e-7):
        errors.append(float(np.max(np.abs(run(rounding) - sharp))))
    assert errors[0] < 1e-3
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.05)
