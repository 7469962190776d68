"""What a constant of the engine is for: small problems that are solved with it, and are not with another one.

Every row is a contact problem and how many trials its solution may take, a run, a motion of closed form, or a single
kernel.  In plain mode, in which constants can be replaced, the same problem must fail its own test with the value in
the row: one that fails nothing is one too many.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.engine.events import event_loop as event_loop  # all that steps is loaded with it
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.memory.solvers import solver_number
from nonsmooth.engine.native.kernel import PLAIN, call_entry
from tests.benchmarks.solvers import FRICTION, Problem, bodies, feet, lay_out
from tests.engine.constant_event_kernels import EVENT_KERNELS
from tests.engine.constant_force_kernels import FORCE_KERNELS
from tests.engine.constant_kernels import KERNELS
from tests.engine.constant_motions import MOTIONS
from tests.engine.constant_runs import RUNS, Run
from tests.engine.test_inelastic import wedged_balls

Floats = NDArray[np.float64]
_EXACT = 1e-9
"""Part of the largest force and acceleration to which the laws hold."""


def heavy(n: int, random: np.random.Generator) -> Problem:
    """Return contacts of light bodies beside heavy ones, eight orders of magnitude apart."""
    problem = bodies(n, random)
    scale = np.sqrt(np.repeat(10.0 ** random.uniform(-4.0, 4.0, n), 3))
    return Problem(problem.delassus * np.outer(scale, scale), problem.bias * scale)


def row(n: int, random: np.random.Generator) -> Problem:
    """Return balls in a row on a plate, each touching the next: forces that are not unique, in a narrow band."""
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
    return Problem(jacobian @ (inverse_mass[:, None] * jacobian.T), jacobian @ free)


def wedged(n: int, random: np.random.Generator) -> Problem:
    """Return balls that wedge each other."""
    return Problem(*wedged_balls(n, random))


_KINDS = {"wedged": wedged, "bodies": bodies, "feet": feet, "heavy": heavy, "row": row, "static": bodies}


@dataclass(frozen=True)
class Case:
    """A contact problem at rest, drawn: its kind, contacts and seed, the solver, and the trials that suffice.

    With "static" the static coefficient is 1.3 times the kinetic one.
    """

    kind: str
    size: int
    seed: int
    solver: str
    most: int

    def assert_solved(self) -> None:
        """Solve it, and hold the answer against the laws."""
        problem = _KINDS[self.kind](self.size, np.random.default_rng(1000 * self.size + self.seed))
        n, static = len(problem.bias) // 3, FRICTION * (1.3 if self.kind == "static" else 1.0)
        memory = lay_out(problem, solver_number(self.solver))
        memory.array("mu_static", n)[:] = static
        memory.array("mode_tried", n)[:] = -1
        assert call_entry("solve_contact", memory) == 1
        forces = memory.array("active_forces", 3 * n).reshape(n, 3)
        accelerations = (problem.delassus @ forces.ravel() + problem.bias).reshape(n, 3)
        force, acceleration = _EXACT * np.max(np.abs(forces)), _EXACT * np.max(np.abs(problem.bias))
        for mode, (normal, *pull), (away, *slip) in zip(
            memory.array("mode_tried", n), forces, accelerations, strict=True
        ):
            speed, bound = np.hypot(*slip), static if mode == STICK else FRICTION
            assert away >= -acceleration if mode == OPEN else abs(away) <= acceleration
            assert normal >= -force
            assert np.hypot(*pull) <= bound * normal + force
            assert mode != STICK or speed <= acceleration
            if mode == SLIDE and speed > 1e2 * acceleration:
                np.testing.assert_allclose(pull, -bound * normal * np.array(slip) / speed, rtol=0, atol=1e2 * force)
        assert memory.scalars["evaluations"][0] <= self.most


CASES: dict[str, tuple[Any, Case | Run | Callable[[], None]]] = {
    "contact.cone._SETTLED": (1e-6, Case("feet", 12, 101, "gauss_seidel", 90)),
    "contact.distribution._STEPS": (3, Case("row", 12, 101, "auto", 10)),
    "contact.distribution._FLOOR": (0.0, Case("feet", 3, 100, "auto", 4)),
    "contact.distribution._FLOOR_IN_BAND": (1.0, Case("row", 12, 101, "newton", 10)),
    "contact.distribution._CHEAP": (1e3, Case("row", 12, 103, "auto", 12)),
    "contact.enumeration._ENDLESS": (1.0, Case("bodies", 3, 4, "enumeration", 112)),
    "contact.enumeration._SWEEPS": (0, Case("bodies", 3, 4, "enumeration", 112)),
    "contact.forces.DOUBTFUL": (0.0, Case("feet", 3, 0, "lemke", 10)),
    "contact.forces._COUPLED": (0.1, Case("row", 12, 101, "auto", 10)),
    "contact.gauss_seidel.STAGES": (1, Case("feet", 6, 3, "gauss_seidel", 90)),
    "contact.gauss_seidel.SWEEPS": (2, Case("feet", 3, 102, "gauss_seidel", 10)),
    "contact.lemke.CORNERS": (3, Case("row", 4, 0, "lemke", 2)),
    "contact.lemke.STAGES": (1, Case("bodies", 3, 10, "lemke", 30)),
    "contact.lemke._ZERO": (1e-4, Case("heavy", 4, 1, "lemke", 30)),
    "contact.newton.STAGES": (1, Case("bodies", 2, 6, "newton", 30)),
    "contact.newton._SWEEPS": (0, Case("heavy", 4, 126, "newton", 5)),
    "contact.newton._MEMORY": (0.0, Case("wedged", 8, 133, "newton", 14)),
    "contact.newton.STEPS": (3, Case("feet", 12, 101, "newton", 4)),
    "contact.newton._HALVINGS": (0, Case("bodies", 2, 5, "newton", 6)),
    "contact.newton._FLOOR": (0.0, Case("feet", 4, 8, "newton", 6)),
    "contact.newton._SETTLED": (1e-3, Case("feet", 4, 8, "newton", 6)),
    "contact.polish._STEPS": (2, Case("bodies", 2, 6, "enumeration", 60)),
    "contact.polish._TURN": (0.01, Case("bodies", 2, 6, "enumeration", 60)),
    "contact.polish._NEAR": (0.0, Case("feet", 6, 3, "gauss_seidel", 30)),
    "contact.polish.EXACT": (1e-6, Case("bodies", 2, 6, "enumeration", 60)),
    "contact.search._MOST_EFFORT": (1e3, Case("bodies", 2, 6, "newton", 30)),
    "contact.trial.EQUAL": (1e9, Case("row", 12, 100, "auto", 6)),
    "contact.trial.NO_FORCE": (1e-4, Case("row", 12, 101, "auto", 10)),
    "contact.trial._SOLVED": (1e4, Case("heavy", 2, 2, "enumeration", 100)),
    "contact.trial._ARRIVED": (1e3, Case("row", 12, 101, "auto", 10)),
    "memory.solvers.MOST_ENUMERATED": (3, Case("feet", 4, 0, "enumeration", 100)),
    "numerics.linear.SINGULAR": (1e-4, Case("heavy", 3, 111, "lemke", 30)),
    "numerics.null_band._SHIFT": (0.5, Case("row", 12, 101, "auto", 10)),
    "numerics.null_band._FAINT": (1e-20, Case("row", 12, 102, "auto", 7)),
    "numerics.null_band._SETTLED": (1e-6, Case("row", 12, 101, "auto", 10)),
    **RUNS,
    **MOTIONS,
    **KERNELS,
    **FORCE_KERNELS,
    **EVENT_KERNELS,
}


def _assert_solved(constant: str) -> None:
    case = CASES[constant][1]
    if isinstance(case, Case | Run):
        case.assert_solved()
    else:
        case()


@pytest.mark.parametrize("constant", CASES)
def test_a_problem_is_solved_that_needs_a_constant(constant: str) -> None:
    """The laws hold, and few trials were needed; nothing stands here that the engine has not."""
    module, _, name = constant.rpartition(".")
    assert name in vars(sys.modules[f"nonsmooth.engine.{module}"])
    if constant in {**KERNELS, **FORCE_KERNELS, **EVENT_KERNELS} and not PLAIN:
        pytest.skip("single kernels are compiled into the engine")
    _assert_solved(constant)


@pytest.mark.skipif(not PLAIN, reason="constants are compiled into the engine")
@pytest.mark.parametrize("constant", CASES)
def test_and_is_not_without_it(constant: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the two tests above one fails: else the constant would be one too many."""
    value = CASES[constant][0]
    module, _, name = constant.rpartition(".")
    right = vars(sys.modules[f"nonsmooth.engine.{module}"])[name]
    # those that other files import go by the same name there
    for other in [m for n, m in sys.modules.items() if n.startswith("nonsmooth.engine.")]:
        if vars(other).get(name) is right:
            monkeypatch.setattr(other, name, value)
    with pytest.raises((AssertionError, ZeroDivisionError, ns.RunFailed)):
        _assert_solved(constant)
