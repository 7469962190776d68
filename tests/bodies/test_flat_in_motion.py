"""Superellipsoids with exponents below 1, boxy or flat one way and sharp the other, in the engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, CapsuleBody, EllipsoidBody, Plate, SuperellipsoidBody
from bodies.inertia import tensor_of
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN

Array = NDArray[np.float64]


def _fall(body: Any, friction: Any, t_end: float, **start: Any) -> ns.Solution:
    plate = Plate()
    system = ns.System([plate, body], gravity=9.81)
    system.contact(plate, body, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.5))
    system.place(body, **start)
    return ns.simulate(system, t_end)


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize(
    ("bodies", "t_end"),
    [
        ([(0.8, 0.8, 0.0), (0.9, 0.9, 0.0), (0.9, 0.9, 0.002)], 1.0),
        ([(0.85, 1.2, 0.0)], 0.5),
        ([(1.2, 0.85, 0.0), (1.2, 0.85, 0.002)], 0.5),
    ],
    ids=str,
)
def test_lasting_contact_over_flat_and_sharp_places(bodies: Any, t_end: float) -> None:
    """Exponents from 0.8: it falls, comes to rest in contact, slides and rocks over its faces; the books balance."""
    rng = np.random.default_rng(3)
    for along, across, rounding in bodies:
        a, b, c = (size - rounding for size in (0.01, 0.012, 0.008))
        for friction in (Frictionless(), Coulomb(0.3)):
            body, turn = SuperellipsoidBody(a, b, c, along, across, rounding=rounding), rng.normal(size=4)
            start = {"velocity": (0.1, 0.0, 0.0), "angular_velocity": tuple((3.0 * rng.normal(size=3)).tolist())}
            place = {"position": (0.0, 0.0, 0.03), "orientation": turn / np.linalg.norm(turn)}
            solution = _fall(body, friction, t_end, **place, **start)
            assert solution.status == "done"
            assert solution.energy.residual <= 1e-8
            assert solution.counters.impacts > 3


@pytest.mark.parametrize("exponents", [(0.2, 0.2), (0.5, 0.5), (0.8, 0.8), (0.5, 1.3)], ids=str)
@pytest.mark.parametrize("rounding", [0.0, 0.001])
def test_what_lies_on_its_middle_stays(exponents: Any, rounding: float) -> None:
    """At rest on a flat point, and sliding on it without friction, at any exponent."""
    along, across = exponents
    body = SuperellipsoidBody(0.01, 0.012, 0.008 - rounding, along, across, rounding=rounding)
    at_rest = _fall(body, Coulomb(0.3), 0.1, position=(0.0, 0.0, 0.008))
    np.testing.assert_allclose(at_rest.q_end[:3], [0.0, 0.0, 0.008], rtol=0, atol=1e-15)
    slides = _fall(body, Frictionless(), 0.1, position=(0.0, 0.0, 0.008), velocity=(0.1, 0.0, 0.0))
    np.testing.assert_allclose(slides.q_end[:3], [0.01, 0.0, 0.008], rtol=0, atol=1e-12)


def _among_boxy() -> list[Any]:
    return [
        SuperellipsoidBody(0.02, 0.03, 0.05, 0.2, 0.2),
        SuperellipsoidBody(0.03, 0.02, 0.02, 0.5, 1.0),
        SuperellipsoidBody(0.03, 0.02, 0.04, 1.4, 1.2),
        EllipsoidBody(0.02, 0.03, 0.03),
        BoxBody(0.03, 0.02, 0.025),
        SuperellipsoidBody(0.025, 0.015, 0.015, 0.5, 0.9, rounding=0.005),
    ]


def _among_mixed() -> list[Any]:
    return [
        SuperellipsoidBody(0.02, 0.03, 0.05, 0.3, 1.3),
        SuperellipsoidBody(0.03, 0.02, 0.02, 1.3, 0.5),
        SuperellipsoidBody(0.03, 0.02, 0.04, 0.4, 0.6),
        EllipsoidBody(0.02, 0.03, 0.03),
        BoxBody(0.03, 0.02, 0.025),
        CapsuleBody(0.015, 0.03),
        SuperellipsoidBody(0.025, 0.015, 0.015, 1.3, 0.5, rounding=0.005),
    ]


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize(("draw", "looked_at"), [(_among_boxy, 5), (_among_mixed, 2)], ids=["boxy", "mixed"])
def test_collisions_conserve_momentum_and_energy(draw: Any, looked_at: int) -> None:
    """The first bodies among each other and with all kinds of others, elastic and without friction."""
    bodies = draw()
    system, rng = ns.System(bodies, gravity=0.0), np.random.default_rng(4)
    laws: dict[str, Any] = {"normal": Unilateral(), "friction": Frictionless(), "impact": EnergeticImpact(1.0)}
    for i, one in enumerate(bodies):
        for other in bodies[i + 1 :]:
            if i < looked_at:
                system.contact(one, other, **laws)
            else:
                system.exclude(one, other)
        place = 0.2 * np.array([np.cos(i), np.sin(i), 0.3 * rng.normal()])
        turn = np.roll(Rotation.random(random_state=i).as_quat(), 1)
        spin = tuple(rng.normal(size=3).tolist())
        system.place(one, position=place, orientation=turn, velocity=-3.0 * place, angular_velocity=spin)
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11, impact_tolerance=1e-12))
    assert solution.counters.impacts >= 5

    def totals(q: Array, u: Array) -> tuple[float, Array]:
        energy: Any = 0.0
        momenta = np.zeros(6)
        for body, x, v in zip(bodies, q.reshape(-1, 7), u.reshape(-1, 6), strict=True):
            own = tensor_of(body.inertia, body.products) @ v[3:]
            energy += 0.5 * body.total_mass * v[:3] @ v[:3] + 0.5 * v[3:] @ own
            momenta[:3] += body.total_mass * v[:3]
            turn = Rotation.from_quat(np.roll(x[3:], -1))
            momenta[3:] += np.cross(x[:3], body.total_mass * v[:3]) + turn.apply(own)
        return float(energy), momenta

    before, after = totals(solution.q[0], solution.u[0]), totals(solution.q_end, solution.u_end)
    assert after[0] == pytest.approx(before[0], rel=1e-9)
    np.testing.assert_allclose(after[1], before[1], rtol=0, atol=1e-9 * np.max(np.abs(before[1])))
