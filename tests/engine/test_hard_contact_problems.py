"""Contact problems with extreme masses, with more forces than motions, or with wedged bodies keep the laws."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from laws import Coulomb
from tests.benchmarks.solvers import FRICTION, bodies, feet
from tests.benchmarks.solvers import Problem as Delassus
from tests.engine.test_inelastic import wedged_balls
from tests.engine.test_solvers import Problem, assert_lawful


def heavy(n: int, random: np.random.Generator) -> Delassus:
    """Return contacts of light bodies beside heavy ones, eight orders of magnitude apart."""
    problem = bodies(n, random)
    scale = np.sqrt(np.repeat(10.0 ** random.uniform(-4.0, 4.0, n), 3))
    return Delassus(problem.delassus * np.outer(scale, scale), problem.bias * scale)


def row(n: int, random: np.random.Generator) -> Delassus:
    """Return balls in a row on a plate, each in contact with the next: their forces are not unique."""
    jacobian = np.zeros((3 * (2 * n - 1), 6 * n))
    up, along, across = np.eye(3)[[2, 0, 1]]

    def touch(contact: int, ball: int, axes: Any, sign: float) -> None:
        for r, axis in enumerate(axes):
            line = jacobian[3 * contact + r]
            line[6 * ball : 6 * ball + 3] = sign * axis
            line[6 * ball + 3 : 6 * ball + 6] = np.cross(-axes[0] * sign, sign * axis)

    for i in range(n):
        touch(2 * i, i, (up, along, across), 1.0)
    for i in range(n - 1):
        touch(2 * i + 1, i + 1, (along, across, up), 1.0)
        touch(2 * i + 1, i, (along, across, up), -1.0)
    free = np.zeros(6 * n)
    free[2::6], free[::6] = -9.81, random.uniform(-3.0, 3.0, n)
    inverse_mass = np.tile([1.0, 1.0, 1.0, 2.5, 2.5, 2.5], n)
    return Delassus(jacobian @ (inverse_mass[:, None] * jacobian.T), jacobian @ free)


def wedged(n: int, random: np.random.Generator) -> Delassus:
    """Return balls that wedge each other."""
    return Delassus(*wedged_balls(n, random))


def _of_unit_mass(problem: Delassus, static: float) -> Problem:
    """Return bodies of unit mass with the same accelerations of the contacts for the same forces."""
    squares, axes = np.linalg.eigh(problem.delassus)
    root = axes * np.sqrt(np.maximum(squares, 0.0))
    force = np.linalg.lstsq(root, problem.bias, rcond=None)[0]
    n = len(force) // 3
    return Problem(np.eye(3 * n), root.reshape(n, 3, 3 * n), force, [Coulomb(FRICTION, static)] * n)


@pytest.mark.parametrize(
    ("draw", "size", "seed", "solver"),
    [
        (bodies, 2, 6, "enumeration"),
        (bodies, 3, 4, "enumeration"),
        (bodies, 3, 10, "lemke"),
        (bodies, 2, 5, "newton"),
        (bodies, 2, 6, "newton"),
        (feet, 3, 0, "lemke"),
        (feet, 3, 100, "auto"),
        (feet, 4, 0, "enumeration"),
        (feet, 3, 102, "gauss_seidel"),
        (feet, 6, 3, "gauss_seidel"),
        (feet, 12, 101, "gauss_seidel"),
        (feet, 4, 8, "newton"),
        (feet, 12, 101, "newton"),
        (heavy, 2, 2, "enumeration"),
        (heavy, 3, 111, "lemke"),
        (heavy, 4, 1, "lemke"),
        (heavy, 4, 126, "newton"),
        (row, 4, 0, "lemke"),
        (row, 12, 101, "newton"),
        (row, 12, 100, "auto"),
        (row, 12, 101, "auto"),
        (row, 12, 102, "auto"),
        (row, 12, 103, "auto"),
        (wedged, 8, 133, "newton"),
    ],
)
@pytest.mark.parametrize("static", [FRICTION, 1.3 * FRICTION])
def test_the_answer_keeps_the_laws(
    draw: Callable[[int, np.random.Generator], Delassus], size: int, seed: int, solver: str, static: float
) -> None:
    """Each kind of problem, by each solver that solves it."""
    problem = _of_unit_mass(draw(size, np.random.default_rng(1000 * size + seed)), static)
    assert_lawful(problem, problem.solve(solver))
