"""Stronge's law against the integrated one, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Dumbbell, Plate
from laws import Coulomb, EnergeticImpact, StrongeImpact, Unilateral
from tests.laws.impact_problems import Problem, apply, solve

COEFFICIENTS = st.one_of(st.just(0.0), st.floats(1e-6, 1.0))
"""The integrated law takes coefficients below 1.4e-8 for none."""


def _planar(seed: int, mu: float, slip: float | None = None) -> Problem:
    """Return a random body with one contact, all in a plane that stands at a random angle to the tangents."""
    random = np.random.default_rng(seed)
    columns = random.normal(size=(3, 2))
    rates = np.array([-random.uniform(0.1, 2.0), random.normal() if slip is None else slip])
    angle = random.uniform(-np.pi, np.pi)
    normal, tangential = np.zeros((4, 1)), np.zeros((4, 1, 2))
    normal[:3, 0] = columns[:, 0]
    tangential[:3, 0, :] = np.outer(columns[:, 1], [np.cos(angle), np.sin(angle)])
    tangential[3, 0, :] = -np.sin(angle), np.cos(angle)
    velocity = np.append(np.linalg.lstsq(columns.T, rates, rcond=None)[0], 0.0)
    return Problem(np.diag(random.uniform(0.5, 2.0, 4)), normal, tangential, velocity, np.array([mu]))


@settings(max_examples=200)
@given(seed=st.integers(0, 10**6), e=COEFFICIENTS, mu=st.floats(0.01, 2.0))
def test_equals_the_energetic_law(seed: int, e: float, mu: float) -> None:
    """On a contact by itself both are the same, also with strong coupling: slip, stick, reversal."""
    problem = _planar(seed, mu)
    after, impulse = solve([StrongeImpact(e)], problem)
    expected, impulses = solve([EnergeticImpact(e)], problem)
    size = float(impulses[0, 0])
    np.testing.assert_allclose(after, expected, rtol=0, atol=1e-9 * max(1.0, size))
    np.testing.assert_allclose(impulse, impulses, rtol=0, atol=1e-9 * max(1.0, size))


@settings(max_examples=50)
@given(seed=st.integers(0, 10**6), e=COEFFICIENTS, mu=st.floats(0.01, 2.0))
def test_equals_it_from_rest(seed: int, e: float, mu: float) -> None:
    """Without slip at the start: it sticks, or starts in the direction that the normal impulse gives it."""
    problem = _planar(seed, mu, 0.0)
    delassus = problem.columns.T @ np.linalg.solve(problem.mass, problem.columns)
    # next to the coefficient that just holds it, a slip that hardly starts is too slow to be integrated
    holds = np.linalg.norm(np.linalg.pinv(delassus[1:, 1:]) @ delassus[1:, 0])
    assume(abs(mu - holds) > 0.02 * mu)
    after, _ = solve([StrongeImpact(e)], problem)
    expected, impulses = solve([EnergeticImpact(e)], problem)
    np.testing.assert_allclose(after, expected, rtol=0, atol=1e-8 * max(1.0, float(impulses[0, 0])))


def test_all_ways_of_the_slip_occur() -> None:
    """Of G = [[b, c], [c, a]]: slip that goes on, ends and sticks, ends and comes back, in either phase."""
    law, found = StrongeImpact(0.7), []
    for c, slip, mu in ((0.0, 3.0, 0.2), (0.0, 0.5, 0.6), (0.0, 1.0, 0.6), (-0.9, 0.2, 0.2), (0.5, 1.0, 0.3)):
        delassus = np.array([[1.0, c, 0.0], [c, 1.0, 0.0], [0.0, 0.0, 1.0]])
        impulse = apply([law], delassus, [[-1.0, slip, 0.0]], [mu])[0]
        after = np.array([-1.0, slip, 0.0]) + delassus @ impulse
        found.append((round(float(np.sign(np.round(after[1], 12)))), bool(abs(impulse[1]) < mu * impulse[0] - 1e-12)))
    # slides on at the bound; stops; stops in expansion; comes back, having been stopped; accelerated away
    assert found == [(1, False), (0, True), (0, True), (-1, True), (1, False)]


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0])
def test_a_straight_fall_is_planar_in_any_tangents(angle: float) -> None:
    """Where nothing slips and the normal impulse pushes no way, round-off must not choose a direction of slip."""
    axes = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    tangential = np.zeros((6, 1, 2))
    tangential[:2, 0, :], tangential[3:5, 0, :] = axes, 0.5 * np.array([[0.0, 1.0], [-1.0, 0.0]]) @ axes
    normal = np.eye(6)[:, 2:3]
    velocity = np.array([0.0, 0.0, -1.0, 0.0, 0.0, 0.0])
    problem = Problem(np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5]), normal, tangential, velocity, np.array([0.2]))
    after, _ = solve([StrongeImpact(0.5)], problem)
    np.testing.assert_allclose(after, -0.5 * velocity, rtol=0, atol=1e-15)


@pytest.mark.parametrize("coupling", [1.5, 0.0])
def test_a_slip_in_a_plane_does_not_depend_on_the_tangents(coupling: float) -> None:
    """A slip that keeps to a line has a closed form, exact to round-off also where the tangent moves more easily."""
    delassus = np.array([[1.0, coupling, 0.0], [coupling, 8.0, 0.0], [0.0, 0.0, 0.0]])
    expected = apply([StrongeImpact(0.5)], delassus, [[-1.0, 10.0, 0.0]], [0.2])[0]
    for angle in np.linspace(0.0, 2.0 * np.pi, 17):
        turn = np.eye(3)
        turn[1:, 1:] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        turned = apply([StrongeImpact(0.5)], turn @ delassus @ turn.T, [turn @ [-1.0, 10.0, 0.0]], [0.2])[0]
        np.testing.assert_allclose(turned, turn @ expected, rtol=0, atol=1e-13)


def test_separating_contact_gets_nothing() -> None:
    """No approach, no impulse."""
    np.testing.assert_array_equal(apply([StrongeImpact(0.5)], np.eye(3), [[0.2, 1.0, 0.0]], [0.3]), np.zeros((1, 3)))


def _spatial(seed: int, mu: float) -> Problem:
    """Return a random body with one contact, fast or slow in its slip."""
    random = np.random.default_rng(seed)
    columns = random.normal(size=(6, 3))
    rates = np.array([-random.uniform(0.1, 2.0), *(random.normal(size=2) * random.choice([0.0, 0.1, 1.0, 3.0]))])
    velocity = np.linalg.lstsq(columns.T, rates, rcond=None)[0]
    mass = np.diag(random.uniform(0.5, 2.0, 6))
    return Problem(mass, columns[:, :1], columns[:, None, 1:], velocity, np.array([mu]))


@settings(max_examples=100)
@given(seed=st.integers(0, 10**6), e=COEFFICIENTS, mu=st.floats(0.01, 2.0))
def test_a_slip_that_turns_equals_the_energetic_law(seed: int, e: float, mu: float) -> None:
    """The slip turns as it slows down, ends, and the contact sticks or slips off along its own direction."""
    problem = _spatial(seed, mu)
    delassus = problem.columns.T @ np.linalg.solve(problem.mass, problem.columns)
    holds = np.linalg.norm(np.linalg.solve(delassus[1:, 1:], delassus[1:, 0]))
    assume(abs(mu - holds) > 0.02 * mu)
    after, _ = solve([StrongeImpact(e)], problem)
    expected, impulses = solve([EnergeticImpact(e)], problem)
    np.testing.assert_allclose(after, expected, rtol=0, atol=1e-7 * max(1.0, float(impulses[0, 0])))


def test_what_the_impact_lets_go_takes_no_part() -> None:
    """A foot at rest that the impact of the other one lifts; where it would be pressed there is no answer."""
    law, rates = StrongeImpact(0.5), [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    for coupling in (0.5, -0.5):
        delassus = np.eye(6)
        delassus[0, 3] = delassus[3, 0] = coupling
        if coupling > 0.0:
            np.testing.assert_allclose(apply([law, law], delassus, rates, [0.1, 0.1])[:, 0], [0.0, 1.5], atol=1e-15)
            continue
        with pytest.raises(ValueError, match="one contact; take EnergeticImpact"):
            apply([law, law], delassus, rates, [0.1, 0.1])


def test_refuses_more_than_one_contact() -> None:
    """As a function it raises; in a run the double impact of a dumbbell ends it, and says why."""
    law = StrongeImpact(0.6)
    with pytest.raises(ValueError, match="one contact; take EnergeticImpact"):
        apply([law, law], np.eye(6), -np.ones((2, 3)), [0.1, 0.1])
    plate, dumbbell = Plate(), Dumbbell()
    system = ns.System([plate, dumbbell])
    system.contact(plate, dumbbell, normal=Unilateral(), friction=Coulomb(0.2), impact=law)
    system.place(dumbbell, position=(0.0, 0.0, dumbbell.radius + 1e-3))
    with pytest.raises(
        ns.RunFailed, match=r"StrongeImpact: .*one contact; take EnergeticImpact .*2 in contact"
    ) as caught:
        ns.simulate(system, 0.1)
    assert caught.value.solution is not None
