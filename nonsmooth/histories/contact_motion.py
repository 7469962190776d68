"""Contact motion: gaps, normal velocities and slip of contacts, open ones too, over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.datasets import Told, dataset
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import GAP
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.times import of_one, read_times, spoken
from nonsmooth.histories.visitor import visitor
from nonsmooth.system.contact import Contact
from nonsmooth.system.lookup import contact_number

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

_TOLD: Told = {
    "gap": (("contact",), "m", "gap, not a number where the bodies are far apart"),
    "normal_velocity": (("contact",), "m/s", "velocity of the second body along the normal"),
    "slip_speed": (("contact",), "m/s", "speed of the second body over the first"),
}


@final
@dataclass(frozen=True, eq=False)
class ContactMotion:
    """How the two bodies of contacts move to one another; of a single time the arrays lack the axis n.

    They are not a number where the engine has no look at a contact, as its bodies are far apart, which happens where
    contacts are many; and for contacts of meshes that no features have at the time: an open one of these may go from
    one pair of features to another.

    Attributes
    ----------
    time : array
        [s], shape [n].
    gap : array
        [m], negative where a compliant contact is pressed in, shape [n, n_contacts].
    normal_velocity : array
        Of the second body along the normal, positive where they part [m/s], shape [n, n_contacts].
    slip_speed : array
        Of the second body over the first, across the normal [m/s], shape [n, n_contacts].
    contacts : tuple of str
        Names of the contacts.
    """

    time: Floats
    gap: Floats
    normal_velocity: Floats
    slip_speed: Floats
    contacts: tuple[str, ...]

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"ContactMotion({spoken(self.time)}; {len(self.contacts)} contacts)"

    def to_xarray(self) -> xarray.Dataset:
        """Return it as a dataset with names and units."""
        return dataset(self, self.time, _TOLD, {"contact": self.contacts})

    @classmethod
    def of(
        cls,
        solution: Solution,
        times: ArrayLike | None = None,
        contacts: Sequence[Contact | str | int] | None = None,
    ) -> ContactMotion:
        """Return how contacts move in a run (:meth:`nonsmooth.Solution.contact_motion`)."""
        given, declared = read_times("Solution.contact_motion", solution, times), solution.system.contacts
        asked = range(len(declared)) if contacts is None else contacts
        numbers = [contact_number("Solution.contact_motion", one, declared) for one in asked]
        row, known = np.atleast_1d(given), visitor(solution)
        memory, table = known.laid.memory, np.full((3, len(row), len(numbers)), np.nan)
        here = np.full((3, len(declared)), np.nan)

        def keep(i: int) -> None:
            n = int(memory[owners.Island.n_contacts])
            rates, oriented = memory[owners.Contact.rate][:n], memory[owners.Contact.is_anisotropic][:n]
            # the axes of friction that is not the same in all directions are no unit vectors
            slips = np.where(oriented[:, None] == 1, memory[owners.Contact.slip_of_tangents][:n], rates[:, 1:])
            here[:] = np.nan
            here[:, memory[owners.Contact.declared][:n]] = (
                memory[owners.Contact.geometry][:n][:, GAP],
                rates[:, 0],
                np.hypot(*slips.T),
            )
            table[:, i] = here[:, numbers]

        known.visit_listed(row, keep)
        gap, rate, slip = table
        found = cls(row, gap, rate, slip, tuple(declared[number].name for number in numbers))
        return found if given.ndim else of_one(found)
