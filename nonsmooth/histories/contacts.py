"""Contacts over time: gaps and velocities of all contacts, and forces of the closed contacts.

Forces are solved for at the times at which a contact is closed.  They are stored as entries, one for each closed
contact and time, and become arrays over all contacts at the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, TANGENT, TRACTION_MOMENT
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.model.laid_out import LaidOut


@final
@dataclass(frozen=True)
class NearContacts:
    """Gaps and velocities of contacts, open ones too; NaN while the bodies of a contact are far apart.

    Attributes
    ----------
    gap : array
        Gap [m], negative for a compliant contact that is pressed in, shape [n, n_contacts].
    normal_velocity : array
        Rate of the gap [m/s], shape [n, n_contacts].
    slip_speed : array
        Tangential speed of the second body relative to the first [m/s], shape [n, n_contacts].
    """

    gap: Floats
    normal_velocity: Floats
    slip_speed: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> NearContacts:
        """Evaluate the chosen contacts at the times of a request; NaN if a contact is not in the neighbour list.

        The neighbour list has the contacts of bodies that are near each other, open contacts too.
        """
        memory, contact, chosen = request.replay.laid.memory, owners.ContactRecord, request.contacts
        table = np.empty((3, len(request.times), len(chosen)))
        here = np.empty((3, len(request.solution.system.contacts)))

        def keep(i: int) -> None:
            active = slice(int(memory[owners.Island.n_contacts]))
            rates = memory[contact.rate][active]
            slip = np.hypot(*_slips(memory, active).T)
            here[:] = np.nan
            here[:, memory[contact.declared][active]] = memory[contact.geometry][active][:, GAP], rates[:, 0], slip
            table[:, i] = here[:, chosen]

        request.replay.visit_near(request.times, request.y, keep)
        return cls(*table)


@final
@dataclass(frozen=True)
class ClosedContacts:
    """Forces of the closed contacts, one entry for each contact and time at which it is closed.

    Forces and moments act on the second body of the contact, in world axes.  The first body has the opposite ones.

    Attributes
    ----------
    request : HistoryRequest
        Run, times and contacts.
    first : array
        First entry of each time, then the number of entries m, shape [n + 1].
    contact : array
        Number of the contact of each entry, shape [m].
    mode : array
        1 stick, 2 slide, shape [m].
    gap : array
        Gap [m], negative for a compliant contact that is pressed in, shape [m].
    contact_point : array
        Contact points on the first and the second body [m], shape [m, 2, 3].
    contact_normal : array
        Unit normal from the first to the second body, shape [m, 3].
    normal_force : array
        Normal force [N], shape [m].
    friction_force : array
        Friction force [N], shape [m, 3].
    friction_moment : array
        Moment of a traction law that resists spin [N m], shape [m, 3].
    slip_velocity : array
        Tangential velocity of the second body relative to the first [m/s], shape [m, 3].
    """

    request: HistoryRequest
    first: Integers
    contact: Integers
    mode: Integers
    gap: Floats
    contact_point: Floats
    contact_normal: Floats
    normal_force: Floats
    friction_force: Floats
    friction_moment: Floats
    slip_velocity: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> ClosedContacts:
        """Evaluate all closed contacts at the times of a request.

        Contacts that the request does not name are evaluated, too, because the forces of all contacts are solved
        together.
        """
        replay, row = request.replay, request.times
        read, at = _ClosedReader(replay.laid), replay.closed(row)
        found = len(row) * [read.none]

        def keep(i: int) -> None:
            found[at[i]] = read()

        replay.visit(row[at], keep)
        first = np.concatenate([[0], np.cumsum([len(numbers) for numbers, _ in found], dtype=np.int64)])
        integers, floats = (np.concatenate([read.none[i], *(part[i] for part in found)]) for i in range(2))
        gap, points, normal, force, friction, moment, slip = np.split(floats, [1, 7, 10, 11, 14, 17], axis=1)
        contact, mode = integers.T
        points, force, gap = points.reshape(-1, 2, 3), force[:, 0], gap[:, 0]
        return cls(request, first, contact, mode, gap, points, normal, force, friction, moment, slip)

    @property
    def beyond_cone(self) -> NDArray[np.bool_]:
        """True for entries outside of their friction cone, shape [m].

        The coefficient is that at the present slip speed [m/s], or at rest if the contact sticks.

        Forces of the time-stepping fallback are means over a span.  At an instant within the span, they need not lie in
        the cone.
        """
        speed = np.where(self.mode == Mode.SLIDE, np.linalg.norm(self.slip_velocity, axis=1), 0.0)
        contacts = self.request.solution.system.contacts
        return beyond_cones(contacts, self.contact, self.first, self.normal_force, self.friction_force, speed)

    def spread(self, values: NDArray[Any], *, if_open: float) -> NDArray[Any]:
        """Array over times and contacts of the request, shape [n, n_contacts, ...], from ``values``, shape [m, ...].

        ``values`` has an entry for each closed contact at each time, as the arrays of this class.

        The value is ``if_open`` while a contact is open.
        """
        # a contact may be chosen twice: fill one column for it, and repeat this column at the end
        chosen, columns = np.unique(self.request.contacts, return_inverse=True)
        place = np.full(len(self.request.solution.system.contacts), -1)
        place[chosen] = np.arange(len(chosen))
        table = np.full((len(self.first) - 1, len(chosen), *values.shape[1:]), if_open, dtype=values.dtype)
        times, kept = np.repeat(np.arange(len(self.first) - 1), np.diff(self.first)), place[self.contact] >= 0
        table[times[kept], place[self.contact[kept]]] = values[kept]
        return table if np.array_equal(columns, np.arange(len(columns))) else table[:, columns]


def _slips(memory: Any, slots: Integers | slice) -> Floats:
    """Slip velocities of active contacts along two unit tangents [m/s], shape [n, 2].

    The axes of anisotropic friction are not unit vectors, so such a contact also stores its slip along unit tangents.
    """
    contact = owners.ContactRecord
    oriented = memory[contact.is_anisotropic][slots, None] == 1
    return np.asarray(np.where(oriented, memory[contact.slip_of_tangents][slots], memory[contact.rate][slots, 1:]))


@final
class _ClosedReader:
    """Reader of numbers, modes, gaps and forces of the closed contacts from the engine's memory.

    ``none`` is the result if no contact is closed.
    """

    none = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 20))

    def __init__(self, laid: LaidOut) -> None:
        self._memory = laid.memory

    def __call__(self) -> tuple[Integers, Floats]:
        """Number and mode of each closed contact, shape [m, 2], and its floats, shape [m, 20], by ascending number.

        The floats are gap, points, normal, normal force, friction force, friction moment and slip velocity.
        """
        memory, contact = self._memory, owners.ContactRecord
        slots = memory[owners.Island.grouped][: int(memory[owners.Island.n_grouped])]
        if len(slots) == 0:
            return self.none
        slots = slots[np.argsort(memory[contact.declared][slots])]
        blocks, forces = memory[contact.geometry][slots], memory[contact.force][slots]
        axes = memory[contact.axes].reshape(-1, 3, 3)[slots]
        normal, tangent, slip = blocks[:, NORMAL : NORMAL + 3], blocks[:, TANGENT : TANGENT + 3], _slips(memory, slots)
        floats = np.empty((len(slots), 20))
        floats[:, 0], floats[:, 1:7], floats[:, 7:10] = blocks[:, GAP], blocks[:, POINT_A : POINT_A + 6], normal
        floats[:, 10] = forces[:, 0]
        floats[:, 11:14] = np.einsum("ir,irx->ix", forces[:, 1:], axes[:, 1:])
        floats[:, 14:17] = 0.0
        for i in np.flatnonzero(memory[contact.traction_function][slots]).tolist():
            start = int(memory[contact.traction_out][slots[i]]) + TRACTION_MOMENT
            floats[i, 14:17] = memory.floats[start : start + 3] @ axes[i, [1, 2, 0]]
        floats[:, 17:] = slip[:, :1] * tangent + slip[:, 1:] * np.cross(normal, tangent)
        return np.column_stack([memory[contact.declared][slots], memory[contact.mode][slots]]), floats
