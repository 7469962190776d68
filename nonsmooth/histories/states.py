"""States: coordinates, velocities, modes and inner states of laws over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.datasets import Told, dataset
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.recorded import check_recorded
from nonsmooth.histories.times import of_one, read_times, spoken
from nonsmooth.histories.visitor import visitor
from nonsmooth.interfaces import Engine
from nonsmooth.system.lookup import labels
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

_TOLD: Told = {
    "q": (("coordinate",), "", "coordinates, see coordinate_units"),
    "u": (("velocity",), "", "velocities, see velocity_units"),
    "modes": (("contact",), "1", "0 open, 1 stick, 2 slide"),
    "law_states": (("law_state",), "", "inner states of friction and traction laws, in SI units of each law"),
}


@final
@dataclass(frozen=True, eq=False)
class States:
    """States at times; of a single time the arrays lack the axis n.

    Attributes
    ----------
    time : array
        [s], shape [n].
    q, u : array
        Coordinates and velocities of all bodies, shapes [n, n_q] and [n, n_u].
    law_states : array
        Inner states of friction and traction laws, contact by contact, shape [n, n_states]; those of open contacts
        are what is left of them.
    system : System
        What ran.
    engine : Engine
        What integrated it.
    found_modes : array
        What :attr:`modes` returns where the engine records modes.
    """

    time: Floats
    q: Floats
    u: Floats
    law_states: Floats
    system: System = field(repr=False)
    engine: Engine = field(repr=False)
    found_modes: Integers = field(repr=False)

    @property
    def modes(self) -> Integers:
        """0 open, 1 stick, 2 slide, shape [n, n_contacts].

        Raises
        ------
        InvalidInput
            If the engine records no modes.
        """
        check_recorded("Solution.at", "modes", self.system, self.engine)
        return self.found_modes

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"States({spoken(self.time)}; {self.q.shape[-1]} coordinates, {self.found_modes.shape[-1]} contacts)"

    def to_xarray(self) -> xarray.Dataset:
        """Return them as a dataset with names and units; those of coordinates and velocities lie along these."""
        known, contacts = labels(self.system), self.system.names.contacts
        columns = {"coordinate": known.coordinates, "velocity": known.velocities}
        names = {axis: [name for _, name, _ in rows] for axis, rows in columns.items()}
        made = dataset(self, self.time, _TOLD, {**names, "contact": contacts})
        return made.assign_coords({f"{axis}_units": (axis, [unit for *_, unit in columns[axis]]) for axis in columns})

    @classmethod
    def of(cls, solution: Solution, times: ArrayLike | None = None) -> States:
        """Return the states of a run (:meth:`nonsmooth.Solution.at`)."""
        given = read_times("Solution.at", solution, times)
        row, known = np.atleast_1d(given), visitor(solution)
        n_q, n_u = solution.q.shape[1], solution.u.shape[1]
        q, u, _, law_states = np.split(known.states(row), np.cumsum([n_q, n_u, N_ACCOUNTS]), axis=1)
        system, engine = solution.system, solution.recorded.engine
        found = cls(row, q, u, law_states, system, engine, known.modes(row))
        return found if given.ndim else of_one(found)
