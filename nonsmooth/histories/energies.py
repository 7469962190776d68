"""Energies: what the bodies have, and what the account says of it, over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.datasets import Told, dataset
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.times import of_one, read_times, spoken
from nonsmooth.histories.visitor import visitor
from nonsmooth.model.laid_out import energies

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

_TOLD: Told = {
    name: ((), "J", words)
    for name, words in {
        "kinetic": "kinetic energy",
        "potential": "potential energy",
        "driven_work": "work of driven bodies since the start",
        "load_work": "work of loads and compliant contacts since the start",
        "restitution_loss": "loss to restitution since the start",
        "friction_loss": "loss to friction since the start",
        "closing_loss": "loss in closing steps and projections since the start",
        "loss": "all losses since the start",
        "unexplained": "what the account does not explain",
    }.items()
}


@final
@dataclass(frozen=True, eq=False)
class Energies:
    """Energies of the free bodies, and works and losses from the start of the account, as in EnergyAccount.

    Of a single time the arrays lack the axis n.

    Attributes
    ----------
    time : array
        [s], shape [n].
    kinetic, potential : array
        [J], shape [n].
    driven_work, load_work : array
        Work of driven bodies, and of loads and compliant contacts [J], shape [n].
    restitution_loss, friction_loss, closing_loss : array
        [J], shape [n].
    start : float
        Kinetic and potential energy where the account begins [J].
    """

    time: Floats
    kinetic: Floats
    potential: Floats
    driven_work: Floats
    load_work: Floats
    restitution_loss: Floats
    friction_loss: Floats
    closing_loss: Floats
    start: float

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"Energies({spoken(self.time)}; start {self.start:.6g} J)"

    def to_xarray(self) -> xarray.Dataset:
        """Return them as a dataset with units."""
        return dataset(self, self.time, _TOLD)

    @property
    def loss(self) -> Floats:
        """All losses [J], shape [n]."""
        return self.restitution_loss + self.friction_loss + self.closing_loss

    @property
    def unexplained(self) -> Floats:
        """What the account does not explain of kinetic and potential energy [J], shape [n]."""
        change = self.kinetic + self.potential - self.start
        return change - self.driven_work - self.load_work + self.loss

    @classmethod
    def of(cls, solution: Solution, times: ArrayLike | None = None) -> Energies:
        """Return the energies of a run (:meth:`nonsmooth.Solution.energies`)."""
        given = read_times("Solution.energies", solution, times)
        row, known = np.atleast_1d(given), visitor(solution)
        laid = known.laid
        y = laid.memory[owners.Island.y]
        first = laid.n_q + laid.n_u
        table, tails = np.zeros((7, len(row))), laid.memory[owners.Body.tail][: len(laid.system.bodies)]

        def keep(i: int) -> None:
            driven, rubbed, _, loads = y[first : first + N_ACCOUNTS]
            call_entry(
                "evaluate_free_bodies",
                laid.memory,
                laid.memory[owners.Island.time],
                laid.memory.start(owners.Island.y),
                1,
            )
            table[:2, i] = energies(laid.system.bodies, tails, laid.memory.floats)
            table[2:4, i] = laid.memory[owners.Totals.driven_work] + driven, loads
            table[4:, i] = (
                laid.memory[owners.Totals.restitution_loss],
                laid.memory[owners.Totals.friction_loss] + rubbed,
                laid.memory[owners.Totals.closing_loss],
            )

        known.visit(row, keep, forces=False)
        kinetic, potential, driven, loads, restitution, friction, closing = table
        start = solution.energy.kinetic_start + solution.energy.potential_start
        found = cls(row, kinetic, potential, driven, loads, restitution, friction, closing, start)
        return found if given.ndim else of_one(found)
