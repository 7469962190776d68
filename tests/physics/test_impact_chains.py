"""Chains of balls against published numbers and against the compliant model in real time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import EnergeticImpact, Frictionless, Unilateral

HERTZ_3 = (-0.07095235, 0.07640304, 0.99454931)
LINEAR_3 = (-0.13026170, 0.15022957, 0.98003213)
HERTZ_5 = (-0.07108502, -0.03027376, -0.01446363, 0.12704499, 0.98877742)


def _collide(chain: Any, masses: Any, velocity: Any, laws: Any, tolerance: float = 1e-12) -> ns.ImpactResult:
    impact = [EnergeticImpact(e, stiffness=k, exponent=eta) for e, k, eta in laws]
    mass, normal, tangential = chain(masses)
    friction = [Frictionless()] * len(laws)
    return ns.solve_impact(mass, normal, tangential, velocity, impact, friction, tolerance=tolerance)


@pytest.mark.parametrize(("exponent", "expected"), [(1.5, HERTZ_3), (1.0, LINEAR_3), (1.5, HERTZ_5)])
def test_published_chains(chain: Any, exponent: float, expected: tuple[float, ...]) -> None:
    """One ball at 1 m/s into touching balls at rest, e = 1, to the printed 1e-8."""
    n = len(expected)
    velocity = np.eye(n)[0]
    result = _collide(chain, np.ones(n), velocity, [(1.0, 1.0, exponent)] * (n - 1))
    np.testing.assert_allclose(result.velocity, expected, rtol=0, atol=1e-8)
    assert np.sum(result.velocity) == pytest.approx(1.0, abs=1e-12)
    assert np.sum(result.velocity**2) == pytest.approx(1.0, abs=1e-9)


CASES = {
    "equal, e 0.9": ((1.0, 1.0, 1.0), (1.0, 0.0, 0.0), [(0.9, 1.0, 1.5)] * 2),
    "e differs": ((1.0, 1.0, 1.0), (1.0, 0.0, 0.0), [(0.3, 1.0, 1.5), (0.8, 1.0, 1.5)]),
    "k differs by 50": ((1.0, 1.0, 1.0), (1.0, 0.0, 0.0), [(0.7, 1.0, 1.5), (0.7, 50.0, 1.5)]),
    "k differs by 1/50": ((1.0, 2.0, 0.5), (1.0, 0.0, 0.0), [(0.7, 50.0, 1.5), (0.9, 1.0, 1.5)]),
    "light middle ball": ((1.0, 0.1, 1.0), (1.0, 0.0, 0.0), [(1.0, 1.0, 1.5)] * 2),
    "light middle ball, e 0.8": ((1.0, 0.05, 2.0), (1.0, 0.0, 0.0), [(0.8, 1.0, 1.5), (0.8, 3.0, 1.5)]),
    "heavy middle ball": ((1.0, 10.0, 1.0), (1.0, 0.0, -0.5), [(0.6, 1.0, 1.5), (0.9, 2.0, 1.5)]),
    "linear": ((1.0, 0.3, 1.0), (1.0, 0.0, -0.2), [(0.8, 1.0, 1.0), (0.5, 4.0, 1.0)]),
    "exponent 2": ((1.0, 1.0, 1.0), (1.0, 0.0, 0.0), [(0.8, 1.0, 2.0)] * 2),
    "exponents differ": ((1.0, 0.4, 1.0), (1.0, 0.0, 0.0), [(0.8, 1.0, 1.5), (0.6, 2.0, 1.0)]),
    "both approach": ((1.0, 1.0, 1.0), (1.0, 0.2, -1.5), [(0.8, 1.0, 1.5)] * 2),
    "four balls": ((1.0, 0.5, 2.0, 0.2), (1.0, 0.0, 0.0, 0.0), [(0.9, 1.0, 1.5), (0.7, 5.0, 1.5), (0.8, 0.3, 1.5)]),
}


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("case", CASES)
def test_compliant_model_in_real_time(chain: Any, compliant: Any, case: str) -> None:
    """The impact equals the springs integrated in time, to 1e-8, with as many phases."""
    masses, velocity, laws = CASES[case]
    mass, normal, tangential = chain(masses)
    expected, model = compliant(mass, normal, tangential[:, :, 0], velocity, laws)
    result = _collide(chain, masses, velocity, laws)
    np.testing.assert_allclose(result.velocity, expected, rtol=0, atol=1e-8)
    assert result.phases == model.phases
    loss = 0.5 * (np.dot(masses, np.square(velocity)) - np.dot(masses, result.velocity**2))
    assert np.sum(result.restitution_loss) == pytest.approx(loss, abs=1e-9)
    for (e, _, _), stored, returned in zip(laws, result.stored, result.returned, strict=True):
        assert EnergeticImpact(e).is_fulfilled(stored, returned, 1e-9)


def test_repeated_compression(chain: Any, compliant: Any) -> None:
    """A light ball between heavy ones is compressed several times; a lone pair once."""
    masses, velocity, laws = CASES["light middle ball"]
    mass, normal, tangential = chain(masses)
    _, model = compliant(mass, normal, tangential[:, :, 0], velocity, laws)
    assert model.compressions > 2
    repeated = _collide(chain, masses, velocity, laws)
    assert repeated.phases > 6
    alone = _collide(chain, (1.0, 1.0), (1.0, 0.0), [(0.5, 1.0, 1.5)])
    assert alone.phases == 3
    np.testing.assert_allclose(alone.velocity, (0.25, 0.75), rtol=0, atol=1e-13)


@pytest.mark.parametrize("restitution", [0.0, 1e-3, 0.5, 1.0])
def test_two_balls_alone(chain: Any, restitution: float) -> None:
    """Energetic restitution of one frictionless contact is Newton's: g'+ = -e g'-."""
    result = _collide(chain, (2.0, 3.0), (1.0, -1.0), [(restitution, 7.0, 1.5)])
    assert result.velocity[1] - result.velocity[0] == pytest.approx(2.0 * restitution, abs=1e-11)
    assert np.dot((2.0, 3.0), result.velocity) == pytest.approx(-1.0, abs=1e-13)


def test_without_restitution_the_chain_stays_together_where_it_is_pushed(chain: Any) -> None:
    """E = 0 twice: the first pair ends with one velocity at most that of the next ball."""
    result = _collide(chain, (1.0, 1.0, 1.0), (1.0, 0.0, 0.0), [(0.0, 1.0, 1.5)] * 2)
    rates = np.diff(result.velocity)
    assert np.all(rates >= -1e-12)
    assert np.sum(result.velocity) == pytest.approx(1.0, abs=1e-12)
    assert np.all(result.returned <= 1e-12)


def test_order_of_a_chain_does_not_matter(chain: Any) -> None:
    """Numbering the contacts the other way round changes nothing."""
    laws = [(0.9, 1.0, 1.5), (0.4, 6.0, 1.5)]
    mass, normal, tangential = chain((1.0, 0.3, 2.0))
    impact = [EnergeticImpact(e, stiffness=k, exponent=eta) for e, k, eta in laws]
    friction = [Frictionless()] * 2
    one = ns.solve_impact(mass, normal, tangential, (1.0, 0.0, 0.0), impact, friction, tolerance=1e-12)
    other = ns.solve_impact(mass, normal[:, ::-1], tangential, (1.0, 0.0, 0.0), impact[::-1], friction, tolerance=1e-12)
    np.testing.assert_allclose(other.velocity, one.velocity, rtol=0, atol=1e-11)
    np.testing.assert_allclose(other.stored[::-1], one.stored, rtol=0, atol=1e-11)


@pytest.mark.parametrize("ratio", [1e2, 1e3, 1e4, 1e6])
def test_a_heavy_ball_comes_to_rest_on_a_light_one(ratio: float) -> None:
    """Endlessly many compressions of the light ball, each of which loses energy, end in common rest with e = 0.2."""
    plate, light, heavy = Plate(), Ball(0.5, mass=1.0), Ball(0.5, mass=ratio)
    system = ns.System([plate, light, heavy])
    for one, other in ((plate, light), (light, heavy)):
        system.contact(one, other, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(0.2))
    system.place(light, position=(0.0, 0.0, 0.5))
    system.place(heavy, position=(0.0, 0.0, 1.8))
    solution = ns.simulate(system, 0.5)
    assert solution.status == "done"
    np.testing.assert_allclose(solution.q_end[[2, 9]], [0.5, 1.5], atol=1e-9)
    np.testing.assert_allclose(solution.u_end, 0.0, atol=1e-7)


def test_a_ball_without_loss_between_two_ends_by_name() -> None:
    """Nothing makes the bounces of a light ball between a heavy one and a plate fade where no contact loses energy."""
    plate, light, heavy = Plate(), Ball(0.5, mass=1.0), Ball(0.5, mass=1e10)
    system = ns.System([plate, light, heavy])
    for one, other in ((plate, light), (light, heavy)):
        system.contact(one, other, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(1.0))
    system.place(light, position=(0.0, 0.0, 0.5))
    system.place(heavy, position=(0.0, 0.0, 1.8))
    with pytest.raises(ns.RunFailed, match="an impact did not end within its steps"):
        ns.simulate(system, 0.5)
