"""The blocks that plug-ins write, with their owners, and the plug-in that wrote past the end of its block.

Behind each block is a mark: a few numbers that nothing writes. A changed mark shows that a plug-in wrote past its
block.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FORCE_AND_MOMENT, FRAME, GEOMETRY, GUARD, JOINT_ROW, LOAD, PAIR, UNTOUCHED
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.interfaces import ImpactMap, Joint, Load, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.declared import DeclaredContacts
from nonsmooth.model.feature_searches import find_searches
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import joints_in_order, place_of_inverse_mass
from nonsmooth.system.contact import Contact, Tie

_CONTACT = owners.ContactRecord


class PluginBlock(NamedTuple):
    """A block of floats that a function writes.

    Attributes
    ----------
    label : callable
        Makes the name of the owner and of the function, for messages.
    function : callable
        The function that writes the block.
    start, size : int
        Place of the block among the floats of the memory, and its length.
    n_written : int
        Number of floats that the function must write.
    """

    label: Callable[[], str]
    function: Callable[..., None]
    start: int
    size: int
    n_written: int


def blocks(model: LaidOut) -> Iterator[PluginBlock]:
    """The blocks of loads, bodies and active contacts, in the order in which one may spoil the next.

    A load that gives NaN spoils the forces in the blocks of its bodies, and a body the geometry of its contacts. So the
    first block with a number that is not finite is the one at fault.
    """
    yield from _blocks_of_bodies(model)
    for index in range(len(model.active)):
        yield _block_of_contact(model, index)


def _blocks_of_bodies(model: LaidOut) -> Iterator[PluginBlock]:
    """The blocks of loads, then of bodies, then of bodies whose ballistic motion has a closed form."""
    system, memory = model.system, model.memory
    # `out` is the place of a block among the floats
    for tie, out in zip(system.loads, memory[owners.LoadRecord.out].tolist(), strict=True):
        assert isinstance(tie.component, Load)
        yield _block(tie, tie.component.evaluator, out, LOAD)
    named = list(zip(system.names.bodies, system.bodies, strict=True))
    for number, ((name, body), start) in enumerate(zip(named, memory[owners.BodyRecord.out].tolist(), strict=True)):
        # a driven body must write the motion of a frame only, another one all up to the end of the force
        force_end = place_of_inverse_mass(memory, number) - start
        n_written = FRAME if body.n_u == 0 else force_end
        # behind the force are the inverse mass and two energies
        label = functools.partial("body {!r}, {!r}:".format, name, body)
        yield PluginBlock(label, body.evaluator, start, force_end + body.n_u**2 + 2, n_written)
    functions, outs = (
        memory[owners.BodyRecord.ballistic_function].tolist(),
        memory[owners.BodyRecord.ballistic_out].tolist(),
    )
    for (name, body), function, start in zip(named, functions, outs, strict=True):
        # 0: the body has a joint or a load, so that its closed form is not used
        if body.flight is not None and function != 0:
            label = functools.partial("body {!r}, {!r} in ballistic motion:".format, name, body)
            # the closed form writes q and u
            size = body.n_q + body.n_u
            yield PluginBlock(label, body.flight, start, size, size)


def _block_of_contact(model: LaidOut, index: int) -> PluginBlock:
    """The geometry block of the active contact at an index of the neighbour list.

    ``PAIR`` of the ``GEOMETRY`` numbers from block to block are written by the kinematics, the rest is the mark.
    """
    contact, first = model.system.contacts[model.active[index]], model.memory.start(owners.ContactRecord.geometry)
    return _block(contact, contact.kinematics.evaluator, first + GEOMETRY * index, PAIR)


def _blocks_of_joints_and_laws(model: LaidOut) -> Iterator[PluginBlock]:
    """The blocks of joints, then those of friction laws: of traction laws, and of the rates of inner states.

    A contact has one of the two if its law has such a block, else none.
    """
    memory, contacts = model.memory, model.system.contacts
    for tie, out in zip(joints_in_order(model.system), memory[owners.JointRecord.out].tolist(), strict=True):
        assert isinstance(tie.component, Joint)
        yield _block(tie, tie.component.evaluator, out, JOINT_ROW * tie.component.n_rows)
    for row, start in zip(contacts.rows, contacts.starts.tolist(), strict=False):
        law = row.laws.friction
        if not isinstance(law, (TractionLaw, StatefulFrictionLaw)):
            continue
        declared = DeclaredContacts.of(memory, range(start, start + len(row)))
        for index in range(len(row)):
            if isinstance(law, TractionLaw):
                # a traction law writes the rates of its inner states behind force and moment
                place, size = int(declared[_CONTACT.traction_out][index]), FORCE_AND_MOMENT + len(law.initial_state)
                yield _block(row.contact(index), law.traction, place, size)
            else:
                place = int(declared[_CONTACT.rates_out][index])
                yield _block(row.contact(index), law.rates, place, len(law.initial_state))


def _blocks_of_searches(model: LaidOut) -> Iterator[PluginBlock]:
    """The blocks of the searches for candidate features."""
    searches = find_searches(model.system.contacts)
    for search, out in zip(searches, model.memory[owners.Search.out].tolist(), strict=True):
        yield _block(search.owner, search.candidates.function, out, search.size)


def _block(owner: Tie | Contact | str, function: Callable[..., None], start: int, size: int) -> PluginBlock:
    """A block that a function must write wholly, with its owner. Its label is made only if a message needs it."""
    return PluginBlock(lambda: f"{owner}: {described(function)},", function, start, size, size)


def marks_behind_blocks(memory: Memory) -> NDArray[np.int64]:
    """Places of the marks behind blocks of the assembly in a memory on which no plug-in was called yet.

    All marks still have the value ``UNTOUCHED``, which no other number has. A mark that changes later shows that a
    plug-in wrote past its block.
    """
    # the marks of geometry blocks, of which there is one for each slot, are read apart
    return memory.blocks + np.flatnonzero(memory.floats[memory.blocks : memory.slots] == UNTOUCHED)


def block_overrun(model: LaidOut) -> str:
    """Sentences that name a function that wrote past its block, or "" if no mark behind a block has changed."""
    memory = model.memory
    # an impact map has marks of its own, which the engine checks at each impact. This is the number of contacts of the
    # impact in which one had changed, or 0
    n_past_map = int(memory[owners.Run.n_past_map])
    # indices in the neighbour list of geometry blocks that are overrun
    overrun = np.flatnonzero(np.any(memory[owners.ContactRecord.geometry][:, PAIR:] != UNTOUCHED, axis=1)).tolist()
    if not overrun and np.all(memory.floats[model.marks] == UNTOUCHED) and n_past_map <= 0:
        return ""
    for block in (
        *_blocks_of_bodies(model),
        *(_block_of_contact(model, index) for index in overrun if index < len(model.active)),
        *_blocks_of_searches(model),
        *_blocks_of_joints_and_laws(model),
    ):
        # the mark behind the block
        is_changed = memory.floats[block.start + block.size :][:GUARD] != UNTOUCHED
        if np.any(is_changed):
            return _sentences(block.label(), block.size, block.size + int(np.argmax(is_changed)))
    if n_past_map > 0:
        # all contacts have the same map. It writes three impulses for each, so the next number is the first past them
        law = model.system.contacts[0].impact
        assert isinstance(law, ImpactMap)
        return _sentences(f"{type(law).__name__}: {described(law.impulses)},", 3 * n_past_map, 3 * n_past_map)
    # a contact that has left the neighbour list cannot be named
    if len(overrun):
        return _sentences("the kinematics of a contact that is not active any more", PAIR, PAIR)
    return ""


def _sentences(name: str, size: int, number: int) -> str:
    """Message that a function has written past the ``size`` numbers of its block, first to ``out[number]``."""
    return (
        f"{name} has written past the {size} numbers of its block, to out[{number}] or beyond: all numbers computed "
        "since may be wrong. `nonsmooth check` shows the line."
    )
