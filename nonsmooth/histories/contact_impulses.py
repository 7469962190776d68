"""Contact impulses: what the contacts of events exchanged, and where."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import NORMAL, POINT_A
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.histories.visitor import visitor
from nonsmooth.system.contact import Contact

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution


@final
@dataclass(frozen=True, eq=False)
class ContactImpulses:
    """The contacts of all events, one entry for each that an event lists: ``events.first`` says where they begin.

    Impulses act on the second body, ``Contact.second``, in world axes; the first one bears the opposite.

    Attributes
    ----------
    event : array
        Number of the event, shape [m].
    contact : array
        Contact, counted from 0, shape [m].
    points : array
        The points of contact on the first and the second body [m], shape [m, 2, 3]; nan where the bodies are too far
        apart to be looked at.
    normal : array
        From the first body to the second, shape [m, 3].
    normal_impulse : array
        [N s], shape [m].
    friction_impulse : array
        [N s], shape [m, 3].
    contacts : tuple of Contact
        Those of the system.
    """

    event: Integers
    contact: Integers
    points: Floats
    normal: Floats
    normal_impulse: Floats
    friction_impulse: Floats
    contacts: tuple[Contact, ...] = field(repr=False)

    @property
    def beyond_cone(self) -> NDArray[np.bool_]:
        """Which entries lie outside of the friction cone, shape [m].

        Impulses within the cones give the same motion: the part of one among redundant contacts may be too large.
        """
        first = np.searchsorted(self.event, np.arange(self.event[-1] + 2 if len(self.event) else 1))
        return beyond_cones(
            self.contacts,
            self.contact,
            first,
            self.normal_impulse,
            self.friction_impulse,
            np.full(len(self.contact), np.nan),
        )

    @classmethod
    def of(cls, solution: Solution) -> ContactImpulses:
        """Return those of a run (:meth:`nonsmooth.Solution.contact_impulses`)."""
        events, known = solution.events, visitor(solution)
        n, memory = len(events.listed), known.laid.memory
        points, axes = np.full((n, 2, 3), np.nan), np.full((n, 3, 3), np.nan)
        # of events at one instant all have the same places
        instants, begins = np.unique(events.time, return_index=True)
        ends = np.append(begins[1:], len(events))

        def look(i: int) -> None:
            slots = int(memory[owners.Island.n_contacts])
            blocks = memory[owners.Contact.geometry][:slots]
            directions = memory[owners.Contact.axes][:slots].reshape(slots, 3, 3)
            slot = np.full(events.n_contacts, -1)
            slot[memory[owners.Contact.declared][:slots]] = np.arange(slots)
            entries = np.arange(events.first[begins[i]], events.first[ends[i]])
            found = slot[events.listed[entries]]
            entries, found = entries[found >= 0], found[found >= 0]
            points[entries] = blocks[found, POINT_A : POINT_A + 6].reshape(-1, 2, 3)
            axes[entries] = directions[found]
            axes[entries, 0] = blocks[found, NORMAL : NORMAL + 3]

        known.visit_listed(instants, look)
        event = np.repeat(np.arange(len(events)), np.diff(events.first))
        impulse = events.listed_impulse
        friction = np.einsum("ir,irx->ix", impulse[:, 1:], axes[:, 1:])
        return cls(event, events.listed, points, axes[:, 0], impulse[:, 0], friction, solution.system.contacts)
