"""Polyhedra in motion: conservation, rest, features that end, and the same body said in two ways."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, DrivenBody, FreeBody, HullBody, Plate, Rest
from bodies.inertia import tensor_of
from bodies.shapes.box import Box
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from tests.bodies.polytopes import random_hull, tetrahedron

Array = NDArray[np.float64]


def _laws(friction: Any, restitution: float) -> dict[str, Any]:
    return {"normal": Unilateral(), "friction": friction, "impact": EnergeticImpact(restitution=restitution)}


def _yaw(angle: float) -> tuple[float, float, float, float]:
    return float(np.cos(0.5 * angle)), 0.0, 0.0, float(np.sin(0.5 * angle))


def cloud(bodies: list[FreeBody], rng: np.random.Generator) -> ns.System:
    """Return bodies of 5 cm on a lattice that fly at each other."""
    system = ns.System(bodies, gravity=0.0)
    for i, body in enumerate(bodies):
        for other in bodies[:i]:
            system.contact(other, body, **_laws(Frictionless(), 1.0))
    side = int(np.ceil(len(bodies) ** (1.0 / 3.0)))
    places = rng.permutation(np.array(list(np.ndindex(side, side, side))))
    for body, cell in zip(bodies, places, strict=False):
        place = 0.13 * (cell - 0.5 * (side - 1)) + rng.uniform(-0.01, 0.01, 3)
        system.place(
            body,
            position=place,
            orientation=np.roll(Rotation.random(random_state=rng).as_quat(), 1),
            velocity=-4.0 * place + 0.3 * rng.normal(size=3),
            angular_velocity=5.0 * rng.normal(size=3),
        )
    return system


def momenta(bodies: list[FreeBody], q: Array, u: Array) -> tuple[Array, Array]:
    linear, angular = np.zeros(3), np.zeros(3)
    for body, x, v in zip(bodies, q.reshape(-1, 7), u.reshape(-1, 6), strict=True):
        axes = Rotation.from_quat(np.roll(x[3:], -1)).as_matrix()
        own = axes @ tensor_of(body.inertia, body.products) @ v[3:]
        linear += body.total_mass * v[:3]
        angular += np.cross(x[:3], body.total_mass * v[:3]) + own
    return linear, angular


@pytest.mark.parametrize(("n", "seed"), [(2, 4), (8, 5)])
def test_colliding_polyhedra_keep_momentum_and_energy(n: int, seed: int) -> None:
    """Without friction and with e = 1, over 1 s, to 1e-9; hulls of 4 to 6 vertices and boxes."""
    rng = np.random.default_rng(seed)
    kinds = (
        lambda: HullBody(tetrahedron(rng, 0.06).points),
        lambda: HullBody(random_hull(rng, 6, 0.05).points),
        lambda: BoxBody(*rng.uniform(0.02, 0.04, 3)),
    )
    bodies: list[FreeBody] = [kinds[i % 3]() for i in range(n)]
    solution = ns.simulate(cloud(bodies, rng), t_end=1.0)
    assert solution.events.causes().count("impact") >= n // 2
    before, after = momenta(bodies, solution.q[0], solution.u[0]), momenta(bodies, solution.q_end, solution.u_end)
    speeds = np.linalg.norm(solution.u[0].reshape(-1, 6)[:, :3], axis=1)
    momentum = sum(body.total_mass * speed for body, speed in zip(bodies, speeds, strict=True))
    np.testing.assert_allclose(after[0], before[0], rtol=0, atol=1e-13 * momentum)
    np.testing.assert_allclose(after[1], before[1], rtol=0, atol=1e-9 * float(np.max(np.abs(before[1]))))
    assert solution.energy.kinetic_end == pytest.approx(solution.energy.kinetic_start, rel=1e-9)


def _rocking(body: FreeBody) -> ns.Solution:
    plate = Plate()
    system = ns.System([plate, body])
    system.contact(plate, body, **_laws(Coulomb(0.6), 0.4))
    tilt = 0.1
    height = 0.02 * np.cos(tilt) + 0.01 * np.sin(tilt)
    lean = np.cos(0.5 * tilt), 0.0, np.sin(0.5 * tilt), 0.0
    system.place(body, position=(0.0, 0.0, height), orientation=lean)
    return ns.simulate(system, t_end=0.25)


def test_a_hull_of_the_corners_rocks_like_the_box() -> None:
    """Vertices in another order, mass properties by integrals: the same events and the same motion to 1e-9."""
    box = BoxBody(0.01, 0.015, 0.02)
    corners = [tuple(x) for x in np.random.default_rng(1).permutation(np.array(box.shapes[0].vertices))]  # type: ignore[attr-defined]
    one, two = _rocking(box), _rocking(HullBody(corners))
    assert one.events.causes().count("impact") > 3
    assert one.events.causes() == two.events.causes()
    np.testing.assert_allclose(two.events.time, one.events.time, rtol=0, atol=1e-9)
    np.testing.assert_allclose(two.q, one.q, rtol=0, atol=1e-9)
    np.testing.assert_allclose(two.u, one.u, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("angle", "points"), [(0.0, 4), (0.25 * np.pi, 8), (0.2, 8)])
def test_a_box_on_a_box_stays(angle: float, points: int) -> None:
    """However it is turned: on the aligned corners, or on the crossings of edges, each of them once."""
    plate, low, top = Plate(), BoxBody(0.01, 0.01, 0.01), BoxBody(0.01, 0.01, 0.01)
    system = ns.System([plate, low, top])
    for pair in ((plate, low), (low, top)):
        system.contact(*pair, **_laws(Coulomb(0.3), 0.3))
    system.place(low, position=(0.0, 0.0, 0.01))
    system.place(top, position=(0.0, 0.0, 0.03), orientation=_yaw(angle))
    solution = ns.simulate(system, t_end=1.0)
    assert solution.events.causes() == ["start"]
    closed = [i for i, code in enumerate(solution.events.codes) if code != 0]
    assert len(closed) == 4 + points
    np.testing.assert_allclose(solution.q, solution.q[0][None, :].repeat(len(solution.q), axis=0), rtol=0, atol=1e-11)


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_a_box_slides_over_an_edge_and_tips_where_its_centre_passes_it(angle: float) -> None:
    """Corners that leave the face end with an event, the crossings of the edges take over, and the books balance."""
    plate, low, top = Plate(), BoxBody(0.05, 0.05, 0.02), BoxBody(0.02, 0.02, 0.01)
    system = ns.System([plate, low, top])
    system.contact(low, top, **_laws(Coulomb(0.1), 0.0))
    for body in (low, top):
        system.contact(plate, body, **_laws(Coulomb(0.5), 0.0))
    system.place(low, position=(0.0, 0.0, 0.02))
    system.place(top, position=(0.0, 0.003, 0.05), orientation=_yaw(angle), velocity=(0.36, 0.0, 0.0))
    solution = ns.simulate(system, t_end=0.6)
    causes = solution.events.causes()
    assert "end of a feature" in causes
    # the deceleration is mu g, and friction under the centre brings the force forward by mu times its height
    arrival = (0.36 - np.sqrt(0.36**2 - 2.0 * 0.1 * 9.81 * (0.05 - 0.1 * 0.01))) / (0.1 * 9.81)
    turning = solution.events.time[causes.index("lift-off")]
    assert turning == pytest.approx(arrival, abs=1e-9)
    energy = solution.energy
    lost = energy.restitution_loss + energy.friction_loss + energy.closing_loss
    total = energy.kinetic_start + energy.potential_start
    assert energy.kinetic_end + energy.potential_end + lost == pytest.approx(total, abs=1e-9)
    assert float(np.min(solution.q[:, 9])) >= 0.01 - 1e-9


def _apart(halves: Array, others: Array, q: Array) -> float:
    """Return the widest slab without points of a box, at a pose, and of one at rest; negative where they overlap."""
    axes = Rotation.from_quat(np.roll(q[3:7], -1)).as_matrix()
    slabs = [*np.eye(3), *axes.T, *(np.cross(one, two) for one in np.eye(3) for two in axes.T)]
    units = [n / np.linalg.norm(n) for n in slabs if np.linalg.norm(n) > 1e-6]
    return float(max(abs(n @ q[:3]) - others @ np.abs(n) - halves @ np.abs(axes.T @ n) for n in units))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("drop", [3, 21, 35, 37])
def test_a_box_that_falls_on_a_box_does_not_sink_in(drop: int) -> None:
    """While some corners slide others come down: no closing is missed between two events."""
    halves, others, rng = np.array([0.03, 0.02, 0.015]), np.array([0.2, 0.2, 0.01]), np.random.default_rng(0)
    for _ in range(drop + 1):
        turn, restitution, mu = rng.normal(size=4), rng.uniform(0.0, 0.8), rng.uniform(0.0, 0.8)
        velocity, spin = 0.3 * rng.normal(size=3), 10.0 * rng.normal(size=3)
    floor, body = DrivenBody(Rest(), (Box(*others),)), BoxBody(0.03, 0.02, 0.015)
    system = ns.System([floor, body])
    system.contact(floor, body, **_laws(Coulomb(mu), restitution))
    orientation = turn / np.linalg.norm(turn)
    system.place(body, position=(0, 0, 0.06), orientation=orientation, velocity=velocity, angular_velocity=spin)
    solution = ns.simulate(system, 0.8, sample_interval=5e-4)
    assert min(_apart(halves, others, q) for q in solution.q) > -1e-9
    assert abs(solution.energy.residual) < 1e-7
