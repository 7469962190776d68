"""One body of a system, whose frames, gaps and rates are evaluated at coordinates that the caller sets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.assembly import lay_out
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.overlaps import frames_of
from nonsmooth.system.contacts import Contacts
from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Probe:
    """A body with its contacts, to be evaluated at any coordinates.

    Attributes
    ----------
    model : LaidOut
        The laid-out system, whose contacts are only those of this body.
    body : Body
        The body.
    number : int
        Number of the body in the system.
    """

    model: LaidOut
    body: Body
    number: int

    @classmethod
    def of(cls, system: System, body: Body) -> Probe:
        """Return the probe of ``body``, with all bodies of the system at their starts.

        Contacts with half-spaces are on the neighbour list at any distance, so that their gaps are known.
        """
        number = next(i for i, other in enumerate(system.bodies) if other is body)
        model = lay_out(system.about(body), EventDriven())
        model.memory[owners.HalfSpaceRecord.is_steady] = False
        return cls(model, body, number)

    @property
    def name(self) -> str:
        """The name of the body."""
        return self.model.system.name_of(self.body)

    @property
    def contacts(self) -> Contacts:
        """The contacts of the body."""
        return self.model.system.contacts

    def _part(self, name: str, first: int, size: int) -> Vector:
        start = int(self.model.memory[getattr(owners.BodyRecord, name)][self.number]) + first
        return self.model.memory.floats[start : start + size]

    def _state(self, offset: int, name: str, size: int) -> Vector:
        start = offset + int(self.model.memory[getattr(owners.BodyRecord, name)][self.number])
        y: Vector = self.model.memory[owners.Island.y]
        return y[start : start + size]

    @property
    def q(self) -> Vector:
        """Coordinates of the body, shape [n_q]: a view that the caller may write to."""
        return self._state(0, "q", self.body.n_q)

    @property
    def u(self) -> Vector:
        """Velocities of the body, shape [n_u]: a view that the caller may write to."""
        return self._state(self.model.n_q, "u", self.body.n_u)

    def frame(self, number: int) -> Vector:
        """Motion of a frame at the present coordinates, shape [FRAME] (:mod:`nonsmooth.engine.memory.blocks`)."""
        call_entry("evaluate_at", self.model.memory)
        return self._part("out", number * (FRAME + 6 * self.body.n_u), FRAME).copy()

    def jacobian(self, number: int) -> Vector:
        """Jacobian of a frame, shape [6, n_u], at the coordinates of the last call of :meth:`frame`."""
        first = number * (FRAME + 6 * self.body.n_u) + FRAME
        return self._part("out", first, 6 * self.body.n_u).reshape(6, self.body.n_u).copy()

    def coordinate_rates(self, u: Vector) -> Vector:
        """Coordinate rates dq/dt for velocities, shape [n_q]."""
        kept = self.u.copy()
        self.u[:] = u
        call_entry("evaluate_at", self.model.memory)
        self.u[:] = kept
        return self._part("tail", 0, self.body.n_q).copy()

    def gaps(self) -> Vector:
        """Gaps of the body's n contacts [m], shape [n].

        Contacts with distant bodies are not on the neighbour list, so their gaps are not evaluated: their entries are
        lower bounds of the gaps.
        """
        self.model.list_contacts()
        gaps = np.asarray(self.model.gaps())
        margin = float(self.model.memory[owners.Island.list_margin])
        for number in np.flatnonzero(np.isinf(gaps)).tolist():
            one, two = frames_of(self.model, number)
            apart = float(np.linalg.norm(one[:3] - two[:3])) - sum(self.contacts[number].extents)
            gaps[number] = max(apart, margin)
        return gaps

    def rates(self, u: Vector) -> Vector:
        """Gap rate and slip velocity of the body's contacts [m/s], shape [n, 3].

        The values are NaN for contacts that are not on the neighbour list.
        """
        self.u[:] = u
        call_entry("evaluate_at", self.model.memory)
        n = int(self.model.memory[owners.Island.n_contacts])
        rates = np.full((len(self.contacts), 3), np.nan)
        rates[self.model.memory[owners.ContactRecord.declared][:n]] = self.model.memory[owners.ContactRecord.rate][:n]
        return rates
