"""The inelastic impact on Coulomb's cone, where contacts wedge and repeat each other."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from laws import Coulomb
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.problems.contact import _memory
from nonsmooth.problems.matrices import write_delassus
from tests.benchmarks.solvers import bodies

Floats = NDArray[np.float64]
FRICTION = 0.8
REST = 1e-8
"""Velocity that counts as none [m/s]."""


def wedged(seed: int) -> tuple[Floats, Floats]:
    """Return the Delassus matrix and the rates of three to six wedged balls."""
    random = np.random.default_rng(seed)
    return wedged_balls(int(random.integers(3, 7)), random)


def wedged_balls(n: int, random: np.random.Generator) -> tuple[Floats, Floats]:
    """Return the Delassus matrix and the rates of balls with two contacts each, with walls and with one another.

    Normals are drawn, so that some wedge, and there may be more contacts than motions.
    """
    jacobian = np.zeros((6 * n, 6 * n))
    for contact in range(2 * n):
        first, second = random.choice(n, 2, replace=False)
        meets_wall = random.random() < 0.5
        axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
        for r, axis in enumerate(axes):
            row, turn = jacobian[3 * contact + r], np.cross(axes[0], axis)
            row[6 * first : 6 * first + 6] = [*axis, *-turn]
            if not meets_wall:
                row[6 * second : 6 * second + 6] = [*-axis, *-turn]
    mobility = np.tile([1.0, 1.0, 1.0, 2.5, 2.5, 2.5], n) * np.repeat(random.choice([1.0, 7.0], n), 6)
    return (jacobian * mobility) @ jacobian.T, jacobian @ random.normal(size=6 * n)


def impact(delassus: Floats, rates: Floats, at_hand: Floats | float = 0.0) -> tuple[bool, Floats]:
    """Return whether impulses are found from those at hand, and them, shape [n, 3]."""
    n = len(rates) // 3
    memory = _memory([Coulomb(FRICTION)] * n, Solver.AUTO)
    write_delassus(memory, delassus)
    memory[owners.Tolerance.velocity] = REST
    memory[owners.Problem.free_accelerations][: 3 * n] = rates
    memory[owners.Problem.forces][: 3 * n] = at_hand
    found = call_entry("inelastic_impulses", memory, 1.0) == 1
    return found, memory[owners.Problem.forces][: 3 * n].reshape(n, 3).copy()


def assert_lawful(seed: int) -> None:
    """None pulls, all are in their cones, what moves rubs against its motion, and the energy does not grow."""
    delassus, rates = wedged(seed)
    found, impulses = impact(delassus, rates)
    assert found
    after = (rates + delassus @ impulses.ravel()).reshape(-1, 3)
    own = np.diag(delassus).reshape(-1, 3)
    normal, friction = impulses[:, 0], impulses[:, 1:]
    assert np.all(normal >= -1e-9 * np.max(normal))
    np.testing.assert_allclose(np.minimum(own[:, 0] * normal, after[:, 0]), 0.0, rtol=0, atol=REST)
    pull, speed = np.hypot(*friction.T), np.hypot(*after[:, 1:].T)
    assert np.all(pull <= FRICTION * normal + 1e-9 * np.max(normal))
    moves = (speed > 1e3 * REST) & (own[:, 0] * normal > REST)
    against = -FRICTION * normal[moves, None] * after[moves, 1:] / speed[moves, None]
    np.testing.assert_allclose(friction[moves], against, rtol=0, atol=1e-5 * np.max(normal))
    assert impulses.ravel() @ (rates + after.ravel()) <= 0.0


@pytest.mark.parametrize("seed", range(60))
def test_impulses_keep_the_laws(seed: int) -> None:
    """Of every wedge that is drawn."""
    assert_lawful(seed)


def test_impulses_that_are_unique_do_not_depend_on_the_guess() -> None:
    """From a guess that is off by a hundredth the search ends at the same impulses."""
    for seed in range(20):
        problem = bodies(4, np.random.default_rng(seed))
        found, impulses = impact(problem.delassus, problem.bias)
        again, later = impact(problem.delassus, problem.bias, 1.01 * impulses.ravel())
        assert found
        assert again
        np.testing.assert_allclose(later, impulses, rtol=0, atol=1e-9 * np.max(impulses))


@pytest.mark.parametrize("seed", [22, 65, 201, 284, 441])
def test_impulses_that_have_not_settled_bring_in_no_energy(seed: int) -> None:
    """If no exact impulses are found, those of compliant contacts lie in their cones and dissipate."""
    random = np.random.default_rng(seed)
    delassus, rates = wedged_balls(int(random.integers(6, 14)), random)
    found, impulses = impact(delassus, rates)
    after = rates + delassus @ impulses.ravel()
    normal, friction = impulses[:, 0], np.hypot(*impulses[:, 1:].T)
    assert not found
    assert np.all(normal >= -1e-9 * np.max(normal))
    assert np.all(friction <= FRICTION * normal + 1e-9 * np.max(normal))
    assert impulses.ravel() @ (rates + after) <= 0.0
