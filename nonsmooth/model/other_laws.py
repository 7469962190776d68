"""Gives a system with other laws the memory of a model, without laying it out where that is possible."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Engine
from nonsmooth.model.assembly import lay
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import Kind, groups_of, laws_of, lay_states, write_fields
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System


def lay_laws(model: LaidOut, system: System, engine: Engine) -> LaidOut:
    """Lay out ``system``, which differs from ``model.system`` in its laws only.

    No run may be in progress in the memory of ``model``. If the same contacts share their laws as before, addresses and
    parameters of the laws are overwritten there in place, and ``model`` must not be used any more. Otherwise the
    contacts have other kinds, and the system gets a memory of its own.

    Raises
    ------
    InvalidInput
        If bodies or contacts differ, or the laws need blocks of other sizes.
    """
    _check_same(model.system, system)
    memory, contacts, former = model.memory, system.contacts, model.system.contacts
    groups, former_groups = groups_of(contacts), groups_of(former)
    former_group = {row: g for g, rows in enumerate(former_groups) for row in rows.tolist()}
    is_same = len(groups) == len(former_groups) and all(map(np.array_equal, groups, former_groups))
    for rows in groups:
        # the rows have equal laws now, but their former laws may differ: take one row for each of those
        examples = {former_group[row]: former.rows[row] for row in rows.tolist()}.values()
        row = contacts.rows[rows[0]]
        # all contacts of a row have the same laws
        contact = row.contact(0)
        after = laws_of(memory, contact)
        for example in (row.contact(0) for row in examples):
            # the new parameters must fit in the places of the old ones, within blocks of the same length
            before = laws_of(memory, example)
            if (before.block.offsets, len(before.block.numbers)) != (after.block.offsets, len(after.block.numbers)):
                _refuse(contact, example)
        if is_same:
            first_kind = int(memory[owners.RowRecord.first_kind][rows[0]])
            _overwrite(memory, slice(first_kind, first_kind + len(row)), after, len(rows))
    if not is_same:
        return lay(system, engine)
    lay_states(memory, contacts)
    # what the engine writes before any run may depend on the laws
    engine.prepare(model)
    return replace(model, system=system)


def _overwrite(memory: Memory, kinds: slice, laws: Kind, n_rows: int) -> None:
    """Overwrite the fields and parameters of the laws of some kinds, each with ``n_rows`` contacts."""
    write_fields(memory, kinds, laws.fields)
    numbers = laws.block.numbers
    # any field with an offset in the block shows where this block begins
    for declared, offset in [*laws.block.offsets.items()][:1]:
        firsts = memory[getattr(owners.KindRecord, declared.name)][kinds] - offset
        stride = int(memory[owners.KindRecord.law_stride][kinds][0])
        starts = np.add.outer(firsts, stride * np.arange(n_rows if stride > 0 else 1))
        memory.floats[np.add.outer(starts, np.arange(len(numbers)))] = numbers


def _check_same(one: System, other: System) -> None:
    """Check that two systems differ in their laws only.

    Bodies, joints, loads and guards must be the very same objects. Contacts must have equal bodies, frames and
    geometry, one by one.

    Raises
    ------
    InvalidInput
        If bodies, gravity, joints, loads, guards or contacts differ.
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
    """Raise InvalidInput: the new laws of a contact need another layout of parameters than its former laws.

    The system must then be assembled anew. ``before`` and ``after`` are the contact with the former and the new laws.
    """
    laws = [", ".join(type(law).__name__ for law in (one.normal, one.friction, one.impact)) for one in (before, after)]
    raise InvalidInput(
        f"with_laws_of: the laws of the {after}",
        f"must be of the kinds of {laws[0]}",
        laws[1],
        "Laws of other kinds need blocks of other sizes: assemble the system.",
    )
