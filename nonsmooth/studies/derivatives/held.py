"""What closed contacts hold: gaps, rates at which these change, and slips of those that stick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import RigidNormalLaw, StatefulFrictionLaw, TractionLaw
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@final
@dataclass(frozen=True)
class Held:
    """The contacts that are closed in a state; motions that keep them closed leave all of their numbers at zero.

    Attributes
    ----------
    closed, stuck : array
        Contacts of rigid bodies that are closed, and those of them that stick, shapes [n_closed] and [n_stuck].
    """

    closed: Integers
    stuck: Integers

    @classmethod
    def at(cls, model: Model, state: State) -> Held:
        """Return what is held in a state.

        Raises
        ------
        InvalidInput
            If the law of a closed contact has inner states, which are no coordinates.
        """
        contacts = model.system.contacts
        for number in np.flatnonzero(state.modes != Mode.OPEN).tolist():
            if isinstance(contacts[number].friction, (StatefulFrictionLaw, TractionLaw)):
                raise InvalidInput(
                    f"section: the {contacts[number]}",
                    "must be open there, as its law has inner states",
                    "closed",
                    "Choose a section where it is open, or a law without inner states.",
                )
        rigid = np.array([isinstance(contact.normal, RigidNormalLaw) for contact in contacts], dtype=bool)
        closed = rigid & (state.modes != Mode.OPEN)
        return cls(np.flatnonzero(closed), np.flatnonzero(closed & (state.modes == Mode.STICK)))

    def left(self, model: Model, state: State) -> Floats:
        """Return the gaps of the closed contacts [m], their rates, and slips of those that stick [m/s]; one array."""
        gaps, rates = model.contact_rates(state)
        return np.concatenate([gaps[self.closed], rates[self.closed, 0], rates[self.stuck, 1:].ravel()])
