"""Other laws in the contacts of a system that is laid out, without laying it out again."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.errors import InvalidInput
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import by_kind, kind_of, lay_law_floats
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System

_OF_GEOMETRY = ("geometry_parameters", "features")


def lay_laws(model: LaidOut, system: System) -> LaidOut:
    """Return the model of a system with other laws, in the memory of a model that stands nowhere.

    Raises
    ------
    InvalidInput
        If it has other bodies or contacts, or laws that need other room.
    """
    _check_same(model.system, system)
    memory, contacts = model.memory, system.contacts
    kinds = by_kind(contacts)
    for numbers in kinds:
        before, after = (kind_of(memory, one.contacts[numbers[0]]) for one in (model.system, system))
        if (before.offsets, len(before.block)) != (after.offsets, len(after.block)):
            _refuse(contacts[numbers[0]], model.system.contacts[numbers[0]])
        for name, value in after.fields.items():
            memory.declared(getattr(owners.Contact, name))[numbers] = value
        # behind what belongs to the geometry, whose tables stand somewhere
        first = min((at for name, at in after.offsets.items() if name not in _OF_GEOMETRY), default=len(after.block))
        starts = memory.declared(owners.Contact.geometry_parameters)[numbers]
        places = starts[:, None] + np.arange(first, len(after.block))
        memory.floats[places] = after.block[first:]
    lay_law_floats(memory, contacts, kinds)
    return LaidOut(system, memory, model.n_q, model.n_u, model.n_states)


def _check_same(one: System, other: System) -> None:
    remedy = "Make it by nonsmooth.with_laws(model.system, ...), or assemble it."
    if list(map(id, one.bodies)) != list(map(id, other.bodies)) or one.gravity != other.gravity:
        raise InvalidInput("with_laws_of", "needs a system of the same bodies", other, remedy)
    ties = ([tie.component for tie in (*two.joints, *two.loads)] + list(two.guards) for two in (one, other))
    if len({tuple(map(id, parts)) for parts in ties}) > 1 or len(one.contacts) != len(other.contacts):
        raise InvalidInput("with_laws_of", "needs the same joints, loads, guards and contacts", other, remedy)
    for first, second in zip(one.contacts, other.contacts, strict=True):
        same = first.first is second.first and first.second is second.second and first.frames == second.frames
        if not same or first.kinematics != second.kinematics:
            raise InvalidInput("with_laws_of", "needs the same contacts", second.name, remedy)


def _refuse(after: Contact, before: Contact) -> None:
    laws = [", ".join(type(law).__name__ for law in (one.normal, one.friction, one.impact)) for one in (before, after)]
    raise InvalidInput(
        f"with_laws_of: the laws of the {after}",
        f"must be of the kinds of {laws[0]}",
        laws[1],
        "Laws of other kinds need other memory: assemble the system.",
    )
