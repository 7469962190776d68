"""The mono-stiffness law against springs in real time, and what it shares with the bi-stiffness law."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import nonsmooth as ns
from bodies import Ball
from laws import Coulomb, EnergeticImpact, Frictionless, MonoStiffnessImpact, Unilateral
from tests.laws.impact_problems import draw, solve

_MASS = np.eye(3)
_CHAIN = np.array([[-1.0, 0.0], [1.0, -1.0], [0.0, 1.0]])


def _row(law: type, e: float, exponent: float = 1.5) -> Any:
    """Return what a ball at 1 m/s does to two that touch."""
    tangential = np.zeros((3, 2, 2))
    laws, friction = [law(e, exponent=exponent)] * 2, [Frictionless()] * 2
    return ns.solve_impact(_MASS, _CHAIN, tangential, [1.0, 0.0, 0.0], laws, friction, tolerance=1e-11)


class _Crossing:
    """An event of solve_ivp: a gap rate, or an entry of the state, passes a value."""

    terminal = True

    def __init__(self, normal: Any, entry: int, value: float, direction: float) -> None:
        self.normal, self.entry, self.value, self.direction = normal, entry, value, direction

    def __call__(self, t: float, y: Any) -> float:
        now = y[self.entry] if self.entry >= 0 else self.normal @ y[:3]
        return float(now - self.value)


def _springs(e: float, exponent: float) -> Any:
    """Return the velocities after the same, in real time: springs of one stiffness that let go under load."""
    u, x = np.array([1.0, 0.0, 0.0]), np.zeros(2)
    loaded = [True, True]
    # the energy at which a spring lets go; none while it is compressed
    rest = [0.0, 0.0]

    def force(x: Any) -> Any:
        return np.where(loaded, np.maximum(x, 0.0) ** exponent, 0.0)

    def slope(t: float, y: Any) -> Any:
        rates = _CHAIN.T @ y[:3]
        return np.concatenate([_CHAIN @ force(y[3:]), np.where(loaded, -rates, 0.0)])

    for _event in range(40):
        rates = _CHAIN.T @ u
        watched: list[tuple[int, str, Any]] = []
        for i in range(2):
            if not loaded[i]:
                watched.append((i, "again", _Crossing(_CHAIN[:, i], -1, 0.0, -1.0)))
            elif rates[i] < -1e-12 or (x[i] == 0.0 and rates[i] <= 1e-12):
                watched.append((i, "turn", _Crossing(_CHAIN[:, i], -1, 1e-13, 1.0)))
            else:
                limit = ((exponent + 1.0) * rest[i]) ** (1.0 / (exponent + 1.0))
                watched.append((i, "open", _Crossing(_CHAIN[:, i], 3 + i, limit, -1.0)))
                watched.append((i, "back", _Crossing(_CHAIN[:, i], -1, -1e-13, -1.0)))
        functions = [function for _, _, function in watched]
        done = solve_ivp(
            slope, (0, 50), np.concatenate([u, x]), events=functions, rtol=1e-11, atol=1e-13, method="DOP853"
        )
        u, x = done.y[:3, -1], done.y[3:, -1]
        if done.status == 0:
            break
        for (i, what, _), times in zip(watched, done.t_events, strict=True):
            if len(times) and what == "turn":
                rest[i] = (1.0 - e**2) * x[i] ** (exponent + 1.0) / (exponent + 1.0)
            elif len(times) and what == "open":
                loaded[i], x[i] = False, 0.0
            elif len(times) and what == "again":
                loaded[i] = True
    return u


@pytest.mark.parametrize(("e", "exponent"), [(0.9, 1.5), (0.8, 1.5), (0.8, 1.0), (0.6, 2.0)])
def test_row_of_three_balls_is_that_of_springs(e: float, exponent: float) -> None:
    """Springs with one curve that let go when the share e^2 has come back."""
    np.testing.assert_allclose(_row(MonoStiffnessImpact, e, exponent).velocity, _springs(e, exponent), atol=1e-7)


@settings(max_examples=40)
@example(seed=1921, e=0.003)
@given(seed=st.integers(0, 10**6), e=st.just(0.0) | st.floats(1e-6, 1.0))
def test_alone_it_is_the_bi_stiffness_law(seed: int, e: float) -> None:
    """On one contact, with friction, where the energy is lost does not matter.

    What comes back is a difference of energies, known to their round-off; its root is known to 1e-9 from e = 1e-6 on.
    """
    problem = draw(seed, 1)
    mono, bi = solve([MonoStiffnessImpact(e)], problem)[0], solve([EnergeticImpact(e)], problem)[0]
    np.testing.assert_allclose(mono, bi, rtol=0, atol=1e-9)


def test_both_ends_of_the_coefficient() -> None:
    """With e = 1 and e = 0 the laws are the same, between them they are not; the share e^2 comes back in both."""
    for e in (0.0, 1.0):
        np.testing.assert_allclose(
            _row(MonoStiffnessImpact, e).velocity, _row(EnergeticImpact, e).velocity, rtol=0, atol=1e-9
        )
    mono, bi = _row(MonoStiffnessImpact, 0.8), _row(EnergeticImpact, 0.8)
    assert np.max(np.abs(mono.velocity - bi.velocity)) > 5e-3
    np.testing.assert_allclose(mono.returned, 0.64 * mono.stored, rtol=1e-9)


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), e=st.floats(0.0, 1.0))
def test_energy_account(seed: int, e: float) -> None:
    """What is stored and not returned, and friction, is what the bodies lose; the certificate holds, and can refuse."""
    problem = draw(seed, 3)
    law, friction = MonoStiffnessImpact(e), [Coulomb(float(mu)) for mu in problem.friction]
    result = ns.solve_impact(
        problem.mass, problem.normal, problem.tangential, problem.velocity, [law] * 3, friction, tolerance=1e-11
    )
    lost = problem.energy(problem.velocity) - problem.energy(result.velocity)
    assert lost == pytest.approx(np.sum(result.restitution_loss + result.friction_loss), abs=1e-8)
    for i in range(3):
        assert law.is_fulfilled(result.stored[i], result.returned[i], 1e-8)
    assert not MonoStiffnessImpact(0.5).is_fulfilled(1.0, 0.2, 1e-3)
    assert not MonoStiffnessImpact(0.5).is_fulfilled(1.0, 1.1, 1e-3)


def test_long_row_through_the_window() -> None:
    """A row long enough to be looked at through a window does what it does on matrices."""
    n, law = 24, MonoStiffnessImpact(0.9)
    balls = [Ball(0.01) for _ in range(n)]
    system = ns.System(balls, gravity=0.0)
    for one, other in itertools.pairwise(balls):
        system.contact(one, other, normal=Unilateral(), friction=Frictionless(), impact=law)
    for i, ball in enumerate(balls):
        system.place(
            ball, position=(0.02 * i - (1e-4 if i == 0 else 0.0), 0, 0), velocity=(1.0 if i == 0 else 0.0, 0, 0)
        )
    solution = ns.simulate(system, 2e-4)
    # three coordinates of every ball, so that there are tangents
    normal, tangential = np.zeros((n, 3, n - 1)), np.zeros((n, 3, n - 1, 2))
    for i in range(n - 1):
        for one_of, sign in ((i, -1.0), (i + 1, 1.0)):
            normal[one_of, 0, i] = tangential[one_of, 1, i, 0] = tangential[one_of, 2, i, 1] = sign
    alone = ns.solve_impact(
        np.eye(3 * n),
        normal.reshape(3 * n, -1),
        tangential.reshape(3 * n, n - 1, 2),
        np.eye(3 * n)[0],
        [law] * (n - 1),
        [Frictionless()] * (n - 1),
    )
    np.testing.assert_allclose(solution.u_end.reshape(n, 6)[:, 0], alone.velocity[::3], rtol=0, atol=1e-6)
