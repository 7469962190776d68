"""Contact forces: what the closed contacts bear, and where, over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, TANGENT, TRACTION_MOMENT
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.histories.contact_history import ContactHistory, contacts_dataset
from nonsmooth.histories.times import read_times, spoken
from nonsmooth.histories.visitor import visitor
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact
from nonsmooth.system.lookup import contact_number

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution


@final
@dataclass(frozen=True, eq=False)
class ContactForces:
    """The closed contacts at times, one entry for each that is closed at one of them.

    Forces and moments act on the second body, ``Contact.second``, in world axes; the first one bears the opposite.

    Attributes
    ----------
    time : array
        [s], shape [n], or [] of a single time.
    first : array
        Where the entries of each time begin, shape [n + 1].
    contact : array
        Contact, counted from 0, shape [m].
    mode : array
        1 stick, 2 slide, shape [m].
    gap : array
        [m], negative where a compliant contact is pressed in, shape [m].
    points : array
        The points of contact on the first and the second body [m], shape [m, 2, 3].
    normal : array
        From the first body to the second, shape [m, 3].
    normal_force : array
        [N], shape [m].
    friction_force : array
        [N], shape [m, 3].
    friction_moment : array
        Of a law of traction that resists turning [N m], shape [m, 3].
    slip_velocity : array
        Of the second body over the first [m/s], shape [m, 3].
    contacts : tuple of Contact
        Those of the system.
    """

    time: Floats
    first: Integers
    contact: Integers
    mode: Integers
    gap: Floats
    points: Floats
    normal: Floats
    normal_force: Floats
    friction_force: Floats
    friction_moment: Floats
    slip_velocity: Floats
    contacts: tuple[Contact, ...] = field(repr=False)

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"ContactForces({spoken(self.time)}; {len(self.contacts)} contacts, {len(self.contact)} entries)"

    @classmethod
    def of(cls, solution: Solution, times: ArrayLike | None = None) -> ContactForces:
        """Return the contact forces of a run (:meth:`nonsmooth.Solution.contact_forces`)."""
        given = read_times("Solution.contact_forces", solution, times)
        row, known = np.atleast_1d(given), visitor(solution)
        closed, at = _Closed(known.laid), known.closed(row)
        found: list[tuple[Integers, Floats]] = len(row) * [closed.none]

        def keep(i: int) -> None:
            found[at[i]] = closed.look()

        known.visit(row[at], keep)
        first = np.concatenate([[0], np.cumsum([len(numbers) for numbers, _ in found], dtype=np.int64)])
        integers, floats = (np.concatenate([closed.none[i], *(part[i] for part in found)]) for i in range(2))
        gap, points, normal, force, friction, moment, slip = np.split(floats, [1, 7, 10, 11, 14, 17], axis=1)
        return cls(
            given,
            first,
            integers[:, 0],
            integers[:, 1],
            gap[:, 0],
            points.reshape(-1, 2, 3),
            normal,
            force[:, 0],
            friction,
            moment,
            slip,
            solution.system.contacts,
        )

    @property
    def beyond_cone(self) -> NDArray[np.bool_]:
        """Which entries lie outside of the friction cone, shape [m]; where a contact slides, of that at its slip speed.

        Where a run averages forces over a span, those of an instant within need not lie in it.
        """
        speed = np.where(self.mode == Mode.SLIDE, np.linalg.norm(self.slip_velocity, axis=1), np.nan)
        return beyond_cones(self.contacts, self.contact, self.first, self.normal_force, self.friction_force, speed)

    def history(self, contact: Contact | str | int) -> ContactHistory:
        """Return what one contact bears over time, with zeros for forces where it is open.

        Parameters
        ----------
        contact : Contact, str or int
            The contact, as ``System.contact`` returned it, its name, or its number, counted from 0.

        Raises
        ------
        InvalidInput
            If it is not of the system.
        """
        number = contact_number("ContactForces.history", contact, self.contacts)
        times = np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))
        entries = np.flatnonzero(self.contact == number)
        return ContactHistory.spread(self, entries, times[entries], self.contacts[number].name)

    def to_xarray(self) -> xarray.Dataset:
        """Return the histories of all contacts that are closed at any of the times, as one dataset with units."""
        return contacts_dataset([self.history(number) for number in np.unique(self.contact).tolist()], self.time)


@final
class _Closed:
    """Views of what the engine writes of closed contacts."""

    none = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 20))

    def __init__(self, laid: LaidOut) -> None:
        memory, n = laid.memory, int(laid.memory[owners.Model.n_slots])
        self._memory, contact = memory, owners.Contact
        self._blocks = memory[owners.Contact.geometry][:n]
        self._axes = memory[owners.Contact.axes][:n].reshape(n, 3, 3)
        self._forces, self._rates = memory[owners.Contact.force], memory[owners.Contact.rate]
        self._slips = memory[owners.Contact.slip_of_tangents][:n]
        self._grouped, self._identity, self._mode, self._oriented, self._function, self._out = (
            memory[one]
            for one in (
                owners.Island.grouped,
                contact.declared,
                contact.mode,
                contact.is_anisotropic,
                contact.traction_function,
                contact.traction_out,
            )
        )

    def look(self) -> tuple[Integers, Floats]:
        """Return numbers and modes of the closed contacts, and twenty floats of each, in the order of the numbers."""
        slots = self._grouped[: int(self._memory[owners.Island.n_grouped])]
        if len(slots) == 0:
            return self.none
        slots = slots[np.argsort(self._identity[slots])]
        blocks, axes, forces = self._blocks[slots], self._axes[slots], self._forces[slots]
        normal, tangent = blocks[:, NORMAL : NORMAL + 3], blocks[:, TANGENT : TANGENT + 3]
        # the axes of friction that is not the same in all directions are no unit vectors
        slip = np.where(self._oriented[slots, None] == 1, self._slips[slots], self._rates[slots, 1:])
        floats = np.empty((len(slots), 20))
        floats[:, 0], floats[:, 1:7], floats[:, 7:10] = blocks[:, GAP], blocks[:, POINT_A : POINT_A + 6], normal
        floats[:, 10] = forces[:, 0]
        floats[:, 11:14] = np.einsum("ir,irx->ix", forces[:, 1:], axes[:, 1:])
        floats[:, 14:17] = 0.0
        for i in np.flatnonzero(self._function[slots]).tolist():
            start = int(self._out[slots[i]]) + TRACTION_MOMENT
            floats[i, 14:17] = self._memory.floats[start : start + 3] @ axes[i, [1, 2, 0]]
        floats[:, 17:] = slip[:, :1] * tangent + slip[:, 1:] * np.cross(normal, tangent)
        return np.column_stack([self._identity[slots], self._mode[slots]]), floats
