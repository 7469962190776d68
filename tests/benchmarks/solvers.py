"""Time of one contact problem by solver and size: ``python -m tests.benchmarks.solvers [--problems N]``.

The problems are random, or feet of one block.
Every solver starts without a past, on the same problems, in one process; times are of the engine alone.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory, allocate
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED, SOLVERS, Solver
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import call_entry, entry_addresses
from nonsmooth.problems.matrices import write_delassus

Floats = NDArray[np.float64]
FRICTION = 0.3


@dataclass(frozen=True)
class Problem:
    """G and b of contacts at rest.

    Attributes
    ----------
    delassus : array
        [1/kg], shape [3 n, 3 n].
    bias : array
        [m/s^2], shape [3 n].
    """

    delassus: Floats
    bias: Floats


def bodies(n: int, random: np.random.Generator) -> Problem:
    """Return contacts that a random system with more freedoms than rows presses, pulls and shears."""
    freedoms = 3 * n + 3
    jacobian = random.normal(size=(3 * n, freedoms)) / np.sqrt(freedoms)
    free = random.normal(size=freedoms) - 2.0 * jacobian[::3].sum(axis=0)
    return Problem(jacobian @ jacobian.T, jacobian @ free)


def feet(n: int, random: np.random.Generator) -> Problem:
    """Return the feet of one block, pushed and turned near its breakaway: six freedoms for 3 n forces."""
    angles = 2.0 * np.pi * np.arange(n) / n
    points = np.column_stack([np.cos(angles), np.sin(angles), np.full(n, -0.3)])
    jacobian = np.zeros((3 * n, 6))
    for i, point in enumerate(points):
        for r, axis in enumerate(np.eye(3)[[2, 0, 1]]):
            jacobian[3 * i + r, :3], jacobian[3 * i + r, 3:] = axis, np.cross(point, axis)
    push = random.normal(size=2)
    push *= random.uniform(0.2, 1.4) * FRICTION * 9.81 / np.linalg.norm(push)
    free = np.array([*push, -9.81, *random.normal(size=2), random.normal()])
    return Problem(jacobian @ np.diag([1.0, 1.0, 1.0, 3.0, 2.5, 2.0]) @ jacobian.T, jacobian @ free)


def lay_out(problem: Problem, solver: Solver) -> Memory:
    """Return the engine's memory with the problem in it."""
    n = len(problem.bias) // 3
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n, "n_pivoted": n})
    memory[owners.ModelNumbers.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active], memory[owners.Options.solver] = n, solver
    memory[owners.Problem.acceleration_scale] = np.max(np.abs(problem.bias))
    memory[owners.Problem.active][:n] = np.arange(n)
    write_delassus(memory, problem.delassus)
    memory[owners.Problem.free_accelerations][: 3 * n] = problem.bias
    memory[owners.ActiveContact.friction_coefficient][:n] = FRICTION
    memory[owners.ActiveContact.static_coefficient][:n] = FRICTION
    memory[owners.ActiveContact.is_at_rest][:n] = 1
    memory[owners.ActiveContact.direction][:n, 0] = 1.0
    return memory


def measure(problem: Problem, solver: Solver, repetitions: int) -> tuple[float, bool]:
    """Return the least time of a solve [s] and whether it was solved."""
    memory = lay_out(problem, solver)
    n = len(problem.bias) // 3
    least, solved = np.inf, False
    for _ in range(repetitions):
        memory[owners.ActiveContact.mode_tried][:n] = Mode.UNKNOWN
        memory[owners.ActiveContact.direction][:n] = (1.0, 0.0)
        began = time.perf_counter()
        solved = call_entry("solve_contact", memory) == 1
        least = min(least, time.perf_counter() - began)
    return least, solved


def main() -> None:
    """Print a table: median time and unsolved problems by solver and size, and the ratio to "auto"."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--problems", type=int, default=40, help="problems of each size")
    parser.add_argument("--sizes", type=int, nargs="+", default=[1, 2, 4, 6, 8, 16, 32, 64])
    parser.add_argument("--repetitions", type=int, default=3)
    chosen = parser.parse_args()
    for make in (bodies, feet):
        print(f"\n{make.__name__}: median time of a solve [us] (ratio to auto; slowest; unsolved)")
        print("contacts " + "".join(f"{name:>32}" for name in SOLVERS))
        for n in chosen.sizes:
            random = np.random.default_rng(n)
            drawn = [make(n, random) for _ in range(chosen.problems)]
            line, first = f"{n:8d} ", 0.0
            for solver in Solver:
                if solver == Solver.ENUMERATION and n > min(6, MOST_ENUMERATED):
                    line += f"{'-':>32}"
                    continue
                results = [measure(problem, solver, chosen.repetitions) for problem in drawn]
                times = 1e6 * np.array([result[0] for result in results])
                middle, missed = float(np.median(times)), sum(not result[1] for result in results)
                first = first or middle
                line += f"{f'{middle:.0f} ({middle / first:.2f}; {times.max():.0f}; {missed})':>32}"
            print(line, flush=True)


if __name__ == "__main__":
    main()
