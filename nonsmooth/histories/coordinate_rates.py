"""The rates of the coordinates over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.visitor import visitor

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


def coordinate_rates(solution: Solution, times: Floats) -> Floats:
    """Return dq/dt at times [s] of a run, shape [n, n_q]."""
    known = visitor(solution)
    memory, bodies = known.laid.memory, solution.system.bodies
    tails = memory[owners.Body.tail][: len(bodies)].tolist()
    free = [(tail, body.n_q) for tail, body in zip(tails, bodies, strict=True) if body.n_q > 0]
    table = np.zeros((len(times), solution.q.shape[1]))

    def keep(i: int) -> None:
        call_entry("evaluate_free_bodies", memory, memory[owners.Island.time], memory.start(owners.Island.y), 1)
        parts = [memory.floats[tail : tail + n] for tail, n in free]
        table[i] = np.concatenate(parts) if parts else 0.0

    known.visit(times, keep, forces=False)
    return table
