"""Closed contacts that pass from one feature of a body to the next: behind the end of one nothing is exchanged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import ConeBody, DrivenBody, EllipsoidBody, Rod, TriangleMesh, Triangles
from laws import Coulomb, EnergeticImpact, PoissonImpact, Unilateral, Viscous
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.meshes.parts import hills


def _spin(bodies: tuple[Any, ...], q: Any, u: Any) -> Any:
    """Return the spin of free bodies about the origin [kg m^2/s]."""
    total = np.zeros(3)
    for k, body in enumerate(bodies):
        axes = Rotation.from_quat(np.roll(q[7 * k + 3 : 7 * k + 7], -1)).as_matrix()
        total += body.total_mass * np.cross(q[7 * k : 7 * k + 3], u[6 * k : 6 * k + 3])
        total += axes @ (np.asarray(body.inertia) * u[6 * k + 3 : 6 * k + 6])
    return total


@pytest.mark.slow
def test_a_rod_that_slides_over_the_middle_of_a_flank_keeps_the_spin() -> None:
    """A contact of half a flank keeps the crossing of a steep edge, also beyond the middle of the flank."""
    cone = ConeBody(radius=0.004643, height=0.007806, density=2700.0, rounding=0.0006163)
    rod = Rod(centre_distance=0.01279, radius=0.001738, density=2700.0)
    system = ns.System([cone, rod], gravity=0.0)
    friction = Viscous(0.5321, growth=0.01632, largest=1.083)
    system.contact(cone, rod, normal=Unilateral(), friction=friction, impact=PoissonImpact(0.0))
    turns = (
        (-0.6430760866567861, 0.681134776435129, -0.15406355221007426, -0.31428169686011714),
        (-0.578819459205251, -0.2421225552873325, 0.1210684716150793, -0.7692120169675343),
    )
    system.place(cone, position=(-0.0111, 0.00304, 0.0144), orientation=turns[0], velocity=(-0.0867, -0.349, -0.1))
    system.place(rod, position=(-0.017, -0.02, 0.0057), orientation=turns[1], velocity=(0.15, 0.64, 0.29))
    solution = ns.simulate(system, 0.029, sample_interval=5e-4, engine=ns.EventDriven(tolerance=1e-10))
    spins = np.array([_spin((cone, rod), q, u) for q, u in zip(solution.q, solution.u, strict=True)])
    size = cone.total_mass * 0.36 * 0.02
    # it was closed on one half all the time
    assert np.count_nonzero(np.any(np.array(solution.events.after) != 0, axis=0)) == 1
    assert float(np.max(np.abs(spins - spins[0]))) < 1e-9 * size


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="thousands of searches")
@pytest.mark.parametrize(("seed", "end"), [(4, 0.75), (70, 0.6)])
def test_a_body_that_rolls_from_an_edge_onto_a_face_does_not_collide_there(seed: int, end: float) -> None:
    """Both hold for a moment and their rates differ by 1e-8 m/s: closing one and colliding on the other went on."""
    rng = np.random.default_rng(seed)
    ground, body = (
        DrivenBody(carried=(TriangleMesh(Triangles(*hills(10))),)),
        EllipsoidBody(0.03, 0.025, 0.04, mass=0.1),
    )
    system = ns.System([ground, body])
    system.contact(ground, body, normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.2))
    turn = rng.normal(size=4)
    system.place(
        body,
        position=(*rng.uniform(-0.4, 0.4, 2), 0.12),
        orientation=turn / np.linalg.norm(turn),
        velocity=0.5 * rng.normal(size=3),
        angular_velocity=5.0 * rng.normal(size=3),
    )
    solution = ns.simulate(system, end)
    events = solution.events
    slow = np.max(np.abs(events.u_after - events.u_before), axis=1) < 1e-4
    assert solution.status == "done"
    assert np.sum(events.cause == Cause.IMPACT) > 5
    assert np.sum(slow & (events.cause == Cause.IMPACT)) <= 1
    assert solution.energy.residual < 1e-8
