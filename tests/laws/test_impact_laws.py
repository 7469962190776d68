"""Certificates, dissipation and invariances of the impact laws."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, Dumbbell
from laws import Coulomb, EnergeticImpact, NewtonImpact
from nonsmooth.engine.memory.modes import Cause

RNG = st.integers(0, 10**6)


def _problem(seed: int, n: int = 2) -> tuple[Any, Any]:
    """Return a random positive definite Delassus matrix and rates with at least one approach."""
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(3 * n, 3 * n + 1))
    rates = random.normal(size=(n, 3))
    rates[0, 0] = -abs(rates[0, 0]) - 0.1
    return jacobian @ jacobian.T, rates


def _newton(delassus: Any, rates: Any, e: Any, mu: Any) -> Any:
    n = len(mu)
    out = np.zeros(3 * n)
    NewtonImpact(0.5).impulses(n, delassus.ravel(), rates.ravel(), out, np.array(mu, float), np.array(e, float))
    return out.reshape(n, 3)


@settings(max_examples=40)
@given(seed=RNG, e=st.floats(0.0, 1.0), mu=st.floats(0.02, 0.8))
def test_newton_fulfils_its_law(seed: int, e: float, mu: float) -> None:
    """g'+ >= -e g'- complementary to P_N >= 0; impulses in the disc, opposed to the slip that is left."""
    delassus, rates = _problem(seed)
    impulse = _newton(delassus, rates, (e, e), (mu, mu))
    after = rates + (delassus @ impulse.ravel()).reshape(-1, 3)
    size = 1.0 + float(np.max(np.abs(impulse)))
    for i in range(2):
        excess = after[i, 0] + e * min(rates[i, 0], 0.0)
        assert excess >= -1e-9 * size
        assert impulse[i, 0] >= 0.0
        assert abs(excess * impulse[i, 0]) <= 1e-8 * size**2
        slip = after[i, 1:] if np.hypot(*after[i, 1:]) > 1e-7 * size else np.zeros(2)
        assert Coulomb(mu).is_fulfilled(tuple(slip), impulse[i, 0], tuple(impulse[i, 1:]), 1e-6 * size)


@settings(max_examples=40)
@given(seed=RNG, e=st.floats(0.0, 1.0))
def test_newton_without_friction_dissipates(seed: int, e: float) -> None:
    """Moreau's form with one e for all contacts loses energy for e <= 1 where all contacts approach."""
    delassus, rates = _problem(seed)
    rates[:, 0] = -np.abs(rates[:, 0])
    impulse = _newton(delassus, rates, (e, e), (0.0, 0.0))
    after = rates + (delassus @ impulse.ravel()).reshape(-1, 3)
    gain = 0.5 * np.sum(impulse * (rates + after))
    assert gain <= 1e-12
    np.testing.assert_array_equal(impulse[:, 1:], 0.0)


def _energetic(seed: int, e: Any, mu: Any, n_u: int = 6) -> Any:
    random = np.random.default_rng(seed)
    mass = np.diag(random.uniform(0.5, 2.0, n_u))
    normal, tangential = random.normal(size=(n_u, 2)), random.normal(size=(n_u, 2, 2))
    u = random.normal(size=n_u)
    if np.all(normal.T @ u >= 0.0):
        u = -u
    impact = [EnergeticImpact(one) for one in e]
    friction = [Coulomb(one) for one in mu]
    return mass, u, ns.solve_impact(mass, normal, tangential, u, impact, friction, tolerance=1e-10)


coefficients = st.tuples(st.floats(0.02, 0.6), st.floats(0.02, 0.6))
restitutions = st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0))


@settings(max_examples=60)
@given(seed=RNG, e=restitutions, mu=coefficients)
def test_energetic_impact_dissipates(seed: int, e: Any, mu: Any) -> None:
    """Kinetic energy never rises, every contact gives back e^2 of what it stored, friction takes, nothing pulls."""
    mass, u, result = _energetic(seed, e, mu)
    change = 0.5 * (result.velocity @ mass @ result.velocity - u @ mass @ u)
    assert change <= 1e-9
    assert change == pytest.approx(-np.sum(result.restitution_loss + result.friction_loss), abs=1e-8)
    assert np.all(result.normal_impulse >= 0.0)
    assert np.all(result.friction_loss >= -1e-10)
    friction = np.hypot(*result.tangential_impulse.T)
    assert np.all(friction <= np.array(mu) * result.normal_impulse * (1 + 1e-9) + 1e-12)
    for i in range(2):
        assert EnergeticImpact(e[i]).is_fulfilled(result.stored[i], result.returned[i], 1e-8)


def test_certificates_refuse() -> None:
    """Every certificate has a false side."""
    law = EnergeticImpact(0.5)
    assert law.is_fulfilled(4.0, 1.0, 1e-12)
    assert not law.is_fulfilled(4.0, 1.1, 1e-3)
    assert not law.is_fulfilled(4.0, 0.9, 1e-3)


def test_functions_of_the_energetic_law() -> None:
    """Eq. (20) and Eq. (28): k x^eta; 1 in compression and at rest, e^2 in expansion."""
    law = EnergeticImpact(0.5, stiffness=3.0, exponent=2.0)
    assert law.force(0.5, 3.0, 2.0) == pytest.approx(0.75)
    assert [law.efficiency(rate, 0.5) for rate in (-1.0, 0.0, 1.0)] == [1.0, 1.0, 0.25]


def test_kanes_example_gains_energy_with_newton_only() -> None:
    """Newton's law with friction may gain energy; the energetic law on the same impact may not."""
    # a rod of unit mass and length on its end, tilted, sliding: the classic counterexample
    angle, e, mu = math.radians(20.0), 1.0, 0.7
    arm = np.array([-0.5 * math.sin(angle), -0.5 * math.cos(angle)])
    mass = np.diag([1.0, 1.0, 1.0, 1.0, 1.0 / 12.0, 1.0 / 12.0])
    normal = np.array([[0.0, 0.0, 1.0, 0.0, -arm[0], 0.0]]).T
    tangential = np.array([[1.0, 0, 0, 0, arm[1], 0], [0, 1.0, 0, 0.1, 0, 0]]).T[:, None, :]
    columns = np.column_stack([normal[:, 0], tangential[:, 0]])
    delassus = columns.T @ np.linalg.solve(mass, columns)
    gains = []
    for slip in np.linspace(-2.0, 2.0, 41):
        u = np.linalg.lstsq(columns.T, np.array([-1.0, slip, 0.0]), rcond=None)[0]
        impulse = _newton(delassus, (columns.T @ u)[None], (e,), (mu,))[0]
        after = u + np.linalg.solve(mass, columns @ impulse)
        gains.append(after @ mass @ after - u @ mass @ u)
        result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(e)], [Coulomb(mu)])
        assert result.velocity @ mass @ result.velocity <= u @ mass @ u + 1e-12
    assert max(gains) > 1e-3


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_both_laws_agree_on_a_ball(build: Any, e: float) -> None:
    """One contact, sphere on a plate: Newton's and the energetic law are the same map; both through a whole run."""
    ends = []
    for law in (EnergeticImpact(e), NewtonImpact(e)):
        ball = Ball(0.01)
        system = build.over(ball)
        plate = system.bodies[0]
        system = ns.System([plate, ball])
        system.contact(plate, ball, **(build.laws(friction=0.1) | {"impact": law}))
        system.place(ball, position=(0, 0, 0.02), velocity=(0.5, 0.2, 0), angular_velocity=(3.0, 5.0, 10.0))
        solution = ns.simulate(system, 0.06)
        assert solution.events.count(Cause.IMPACT) >= 1
        ends.append(np.concatenate([solution.q_end, solution.u_end]))
        assert solution.energy.residual <= 1e-8
    np.testing.assert_allclose(ends[1], ends[0], rtol=0, atol=1e-8)


def test_laws_differ_on_a_dumbbell(build: Any) -> None:
    """Two coupled contacts, one at rest: the sequence of compressions matters."""
    ends = []
    for law in (EnergeticImpact(0.6), NewtonImpact(0.6)):
        body = Dumbbell()
        plate = build.over(body).bodies[0]
        system = ns.System([plate, body])
        system.contact(plate, body, **(build.laws(friction=0.15) | {"impact": law}))
        system.place(body, **build.paper_start(body, (0, 0, body.radius, 0, 0.17, 0), np.zeros(6)))
        solution = ns.simulate(system, 0.1)
        assert solution.energy.residual <= 1e-8
        ends.append(solution.events.u_after[solution.events.cause == Cause.IMPACT][0])
    assert np.max(np.abs(ends[0] - ends[1])) > 1e-3


@pytest.mark.parametrize("exponent", [1.0, 1.5, 5.0, 6.0, 10.0])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-11])
def test_the_share_comes_back_whatever_the_exponent(exponent: float, tolerance: float) -> None:
    """A steep force has given back its energy long before its deformation: the last contact to open adds none."""
    mass = np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5])
    arms = np.array([[0.5, 0.0, -0.5], [0.1, -0.5, -0.5]])
    normal = np.array([[0.0, 0.0, 1.0, *np.cross(arm, (0.0, 0.0, 1.0))] for arm in arms]).T
    tangential = np.zeros((6, 2, 2))
    for i, arm in enumerate(arms):
        for j, axis in enumerate(np.eye(3)[:2]):
            tangential[:, i, j] = [*axis, *np.cross(arm, axis)]
    for down in ((0.0, 0.0, -1.0), (0.3, -0.2, -0.7)):
        u = np.array([*down, 0.0, 0.0, 0.0])
        for e in (0.1, 0.5, 0.9):
            laws = [EnergeticImpact(e, exponent=exponent)] * 2
            done = ns.solve_impact(mass, normal, tangential, u, laws, [Coulomb(0.0)] * 2, tolerance=tolerance)
            size = float(np.max(done.stored))
            bound = 20.0 * tolerance + 1e-9
            np.testing.assert_allclose(done.returned, e**2 * done.stored, rtol=0, atol=bound * size)
            lost = 0.5 * u @ mass @ u - 0.5 * done.velocity @ mass @ done.velocity
            assert lost == pytest.approx(float(np.sum(done.restitution_loss)), abs=bound * size)
