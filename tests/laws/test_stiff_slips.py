"""Slips that stay next to rest during an impact, where their direction follows the forces at once."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import brentq

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact
from nonsmooth.testing.reference import ImpactProblem, problem_of

_SEEDS = st.integers(0, 10**6)


def _random(seed: int, contacts: int) -> tuple[ImpactProblem, float]:
    """Return a body with leaning contacts on long arms, half of its numbers zero, and a coefficient up to 2."""
    random = np.random.default_rng(seed)
    drawn = problem_of(contacts)
    case = {v.name: float(random.uniform(v.low, v.high) * random.integers(2)) for v in drawn.numbers}
    case["velocity_z"] -= 0.1
    return drawn.made(case), float(random.uniform(0.1, 2.0))


@settings(max_examples=60)
@given(seed=_SEEDS, excess=st.floats(-5.0, -0.3), e=st.floats(0.1, 1.0))
def test_a_contact_just_past_its_bound_slips_along_a_ray(seed: int, excess: float, e: float) -> None:
    """From rest the direction does not change, so that rates are linear in the normal impulse: closed form."""
    random = np.random.default_rng(seed)
    axes, _ = np.linalg.qr(random.normal(size=(6, 3)))
    columns = axes @ (np.eye(3) + 0.3 * random.normal(size=(3, 3)))
    delassus = columns.T @ columns
    velocity = columns @ np.linalg.solve(delassus, [-1.0, 0.0, 0.0])
    sticking = np.linalg.solve(delassus[1:, 1:], delassus[1:, 0])
    mu = (1.0 - 10.0**excess) * float(np.linalg.norm(sticking))

    def change(angle: float) -> NDArray[np.float64]:
        rates: NDArray[np.float64] = delassus @ [1.0, -mu * np.cos(angle), -mu * np.sin(angle)]
        return rates

    def turn(angle: float) -> float:
        rates = change(angle)
        return float(rates[2] * np.cos(angle) - rates[1] * np.sin(angle))

    start = float(np.arctan2(sticking[1], sticking[0]))
    angle = brentq(turn, start - 1.0, start + 1.0, xtol=1e-15)
    growth = change(angle)[0]
    assume(growth > 0.1 and mu < 2.0)
    impulse = (1.0 + e) / growth
    expected = velocity + impulse * columns @ [1.0, -mu * np.cos(angle), -mu * np.sin(angle)]
    result = ns.solve_impact(
        np.eye(6), columns[:, :1], columns[:, 1:].reshape(6, 1, 2), velocity, [EnergeticImpact(e)], [Coulomb(mu)]
    )
    np.testing.assert_allclose(result.velocity, expected, rtol=0, atol=2e-7)
    assert result.steps < 2000


def rod(seed: int) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return mass matrix and contact axes of a rod that is light about its axis, and the bound of sticking."""
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    arm = np.append(random.normal(size=2), -random.uniform(0.2, 1.0))
    mass, columns = np.eye(6), np.vstack([np.eye(3)[:, [2, 0, 1]], np.zeros((3, 3))])
    mass[3:, 3:] = turn @ np.diag([1.0 / 12.0, 1.0 / 12.0, 10.0 ** random.uniform(-6.0, -1.0)]) @ turn.T
    mass = 0.5 * (mass + mass.T)
    columns[3:] = np.cross(arm, columns[:3], axisb=0).T
    delassus = columns.T @ np.linalg.solve(mass, columns)
    return mass, columns, float(np.linalg.norm(np.linalg.solve(delassus[1:, 1:], delassus[1:, 0])))


def _rates(seed: int, excess: float, e: float, slip: float) -> NDArray[np.float64]:
    """Return the rates after an impact with friction that is by a part of it more than what holds the contact."""
    mass, columns, bound = rod(seed)
    before = np.linalg.lstsq(columns.T, [-1.0, 0.6 * slip, 0.8 * slip], rcond=None)[0]
    result = ns.solve_impact(
        mass, columns[:, :1], columns[:, 1:].reshape(6, 1, 2), before, [EnergeticImpact(e)],
        [Coulomb((1.0 + excess) * bound)],
    )  # fmt: skip
    assert result.steps < 1000
    rates: NDArray[np.float64] = columns.T @ result.velocity
    return rates


@settings(max_examples=60, deadline=None)
@given(seed=_SEEDS, e=st.sampled_from([0.0, 1e-3, 0.5, 1.0]), slip=st.sampled_from([0.0, 1e-6, 1e-3, 1.0]))
def test_impacts_of_rods_next_to_the_bound_end_and_agree(seed: int, e: float, slip: float) -> None:
    """From 0.1 % below to 0.1 % above it: what they leave differs in proportion to the friction, across it, too."""
    mass, columns, bound = rod(seed)
    assume(0.02 < bound < 1.9)
    at = _rates(seed, 0.0, e, slip)
    # so much does a unit of friction move points as light as these
    reach = float(np.linalg.norm(columns.T @ np.linalg.solve(mass, columns)))
    for part in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11):
        for excess in (-part, part):
            np.testing.assert_allclose(_rates(seed, excess, e, slip), at, rtol=0, atol=part * reach + 1e-5)


@settings(max_examples=60, deadline=None)
@given(seed=_SEEDS)
def test_two_contacts_with_much_friction_end_where_small_steps_do(seed: int) -> None:
    """Contacts that leave their bounds slowly need no more steps than others, and no smaller tolerance."""
    p, mu = _random(seed, 2)
    laws, friction = [EnergeticImpact(0.7)] * 2, [Coulomb(mu)] * 2
    found = ns.solve_impact(p.mass, p.normal, p.tangential, p.velocity, laws, friction)
    fine = ns.solve_impact(p.mass, p.normal, p.tangential, p.velocity, laws, friction, tolerance=1e-12)
    np.testing.assert_allclose(found.velocity, fine.velocity, rtol=0, atol=1e-6)
    lost = 0.5 * (p.velocity @ p.mass @ p.velocity - found.velocity @ p.mass @ found.velocity)
    assert lost == pytest.approx(float(np.sum(found.restitution_loss + found.friction_loss)), abs=1e-8)
