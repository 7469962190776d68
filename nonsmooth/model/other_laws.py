"""Replaces the laws of a laid-out system. Sweeps over parameters of laws need no layout for each value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.errors import InvalidInput
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import by_kind, kind_of, lay_law_floats, lay_states
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System

_OF_GEOMETRY = (owners.Contact.geometry_parameters, owners.Contact.features)
"""Places in the block of a contact that belong to its geometry."""


def lay_laws(model: LaidOut, system: System) -> LaidOut:
    """Layout of ``system``, which differs in its laws only, in the memory of a model. That memory must hold no run.

    Addresses and parameters of the laws are overwritten in place, so ``model`` must not be used any more. Geometry
    stays.

    Raises
    ------
    InvalidInput
        If bodies or contacts differ, or the laws need blocks of other sizes.
    """
    _check_same(model.system, system)
    memory, contacts, former = model.memory, system.contacts, model.system.contacts
    kinds = by_kind(contacts)
    former_kind = {number: k for k, numbers in enumerate(by_kind(former)) for number in numbers}
    for numbers in kinds:
        # one contact of each kind that the contacts of this kind had
        examples = {former_kind[number]: number for number in numbers}.values()
        before, after = [kind_of(memory, former[number]) for number in examples], kind_of(memory, contacts[numbers[0]])
        for number, one in zip(examples, before, strict=True):
            # the new parameters must fit in the places of the old ones, within blocks of the same length
            if (one.offsets, len(one.block)) != (after.offsets, len(after.block)):
                _refuse(contacts[number], former[number])
        for declared, value in after.fields.items():
            memory.declared(declared)[numbers] = value
        # the parameters of the geometry come first and stay, as they may refer to tables; those of the laws follow
        of_laws = [offset for declared, offset in after.offsets.items() if declared not in _OF_GEOMETRY]
        first = min(of_laws, default=len(after.block))
        # the block of each contact begins with the parameters of the geometry
        starts = memory.declared(owners.Contact.geometry_parameters)[numbers]
        places = starts[:, None] + np.arange(first, len(after.block))
        memory.floats[places] = after.block[first:]
    lay_states(memory, contacts, kinds)
    lay_law_floats(memory, contacts, kinds)
    return replace(model, system=system)


def _check_same(one: System, other: System) -> None:
    """Check that two systems differ in their laws only.

    Bodies, joints, loads and guards must be the very same objects. Contacts must have equal bodies, frames and
    geometry, one by one.

    Raises
    ------
    InvalidInput
        If anything else differs.
    """
    remedy = "Make it by nonsmooth.with_laws(model.system, ...), or assemble it."
    if list(map(id, one.bodies)) != list(map(id, other.bodies)) or one.gravity != other.gravity:
        raise InvalidInput("with_laws_of", "needs a system of the same bodies", other, remedy)
    ties = ([tie.component for tie in (*two.joints, *two.loads)] + list(two.guards) for two in (one, other))
    if len({tuple(map(id, parts)) for parts in ties}) > 1 or len(one.contacts) != len(other.contacts):
        raise InvalidInput("with_laws_of", "needs the same joints, loads, guards and contacts", other, remedy)
    for first, second in zip(one.contacts, other.contacts, strict=True):
        has_same_bodies = first.first is second.first and first.second is second.second
        if not has_same_bodies or first.frames != second.frames or first.kinematics != second.kinematics:
            raise InvalidInput("with_laws_of", "needs the same contacts", second.name, remedy)


def _refuse(after: Contact, before: Contact) -> None:
    """Raise InvalidInput for a contact whose new laws need other blocks than the laws before."""
    laws = [", ".join(type(law).__name__ for law in (one.normal, one.friction, one.impact)) for one in (before, after)]
    raise InvalidInput(
        f"with_laws_of: the laws of the {after}",
        f"must be of the kinds of {laws[0]}",
        laws[1],
        "Laws of other kinds need blocks of other sizes: assemble the system.",
    )
