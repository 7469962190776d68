"""The blocks that plug-ins write, with their owners, and the plug-in that wrote past the end of its block."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FORCE_AND_MOMENT, FRAME, GEOMETRY, GUARD, JOINT_ROW, LOAD, PAIR, UNTOUCHED
from nonsmooth.interfaces import ImpactMap, Joint, Load, StatefulFrictionLaw, TractionLaw
from nonsmooth.model.articulations import articulations
from nonsmooth.model.block_ends import BlockEnds
from nonsmooth.model.feature_searches import find_searches
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact, Tie


class Block(NamedTuple):
    """A block of floats that a function writes.

    Attributes
    ----------
    label : callable
        Makes the names of the owner and of the function.
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


def blocks(model: LaidOut) -> Iterator[Block]:
    """The blocks of loads, bodies and active contacts, in the order in which one may spoil the next."""
    yield from _blocks_of_bodies(model)
    yield from _blocks_of_ballistic_motion(model)
    for index in range(int(model.memory[owners.Island.n_contacts])):
        yield _block_of_contact(model, index)


def _blocks_of_bodies(model: LaidOut) -> Iterator[Block]:
    system = model.system
    for i, tie in enumerate(system.loads):
        assert isinstance(tie.component, Load)
        function = tie.component.evaluator
        yield Block(_label(tie, function), function, _entry(model, owners.Load.out, i), LOAD, LOAD)
    names = system.names.bodies
    for i, body in enumerate(system.bodies):
        start = _entry(model, owners.Body.out, i)
        rates = _entry(model, owners.Body.tail, i) - start + body.n_q + body.n_u
        n_written = FRAME if body.n_u == 0 else rates
        yield Block(
            functools.partial("body {!r}, {!r}:".format, names[i], body),
            body.evaluator,
            start,
            rates + body.n_u**2 + 2,
            n_written,
        )


def _blocks_of_ballistic_motion(model: LaidOut) -> Iterator[Block]:
    names = model.system.names.bodies
    for i, body in enumerate(model.system.bodies):
        if body.flight is not None and _entry(model, owners.Body.ballistic_function, i) != 0:
            label, size = (
                functools.partial("body {!r}, {!r} in ballistic motion:".format, names[i], body),
                body.n_q + body.n_u,
            )
            yield Block(label, body.flight, _entry(model, owners.Body.ballistic_out, i), size, size)


def _block_of_contact(model: LaidOut, index: int) -> Block:
    contact = model.system.contacts[_entry(model, owners.Contact.declared, index)]
    function, first = contact.kinematics.evaluator, model.memory.start(owners.Contact.geometry)
    return Block(_label(contact, function), function, first + GEOMETRY * index, PAIR, PAIR)


def _blocks_of_joints_and_laws(model: LaidOut) -> Iterator[Block]:
    ties = [tie for articulation in articulations(model.system) for tie in articulation.joints]
    for number, tie in enumerate(ties):
        assert isinstance(tie.component, Joint)
        function, size = tie.component.evaluator, JOINT_ROW * tie.component.n_rows
        yield Block(_label(tie, function), function, _entry(model, owners.Joint.out, number), size, size)
    contacts = model.system.contacts
    traction, rates = (
        model.memory.declared(place) for place in (owners.Contact.traction_out, owners.Contact.rates_out)
    )
    for i in np.flatnonzero(traction):
        law = contacts[i].friction
        assert isinstance(law, (TractionLaw, StatefulFrictionLaw))
        if isinstance(law, TractionLaw):
            function, start, size = law.traction, int(traction[i]), FORCE_AND_MOMENT + len(law.initial_state)
        else:
            function, start, size = law.rates, int(rates[i]), len(law.initial_state)
        yield Block(_label(contacts[i], function), function, start, size, size)


def _blocks_of_searches(model: LaidOut) -> Iterator[Block]:
    for number, search in enumerate(find_searches(model.system.contacts)):
        function = search.candidates.function
        label = functools.partial(_names, search.owner, function)
        yield Block(label, function, _entry(model, owners.Search.out, number), search.size, 1)


def _label(owner: Tie | Contact, function: Callable[..., None]) -> Callable[[], str]:
    return lambda: _names(str(owner), function)


def _names(owner: str, function: Callable[..., None]) -> str:
    return f"{owner}: {described(function)},"


def _entry(model: LaidOut, declared: Any, i: int) -> int:
    return int(model.memory[declared][i])


def block_overrun(model: LaidOut, ends: BlockEnds) -> str:
    """Sentences that name a function that wrote past its block, or ""; ``ends`` are the ends of the model's blocks."""
    memory = model.memory
    n_past_map = int(memory[owners.Run.n_past_map])
    if ends.are_intact(memory) and n_past_map <= 0:
        return ""
    places, n_active = memory[owners.Model.n_slots], memory[owners.Island.n_contacts]
    overrun = np.flatnonzero(np.any(memory[owners.Contact.geometry][:places][:, PAIR:] != UNTOUCHED, axis=1))
    for block in (
        *_blocks_of_bodies(model),
        *_blocks_of_ballistic_motion(model),
        *(_block_of_contact(model, int(index)) for index in overrun if index < n_active),
        *_blocks_of_searches(model),
        *_blocks_of_joints_and_laws(model),
    ):
        end = block.start + block.size
        is_changed = memory.floats[end : end + GUARD] != UNTOUCHED
        if np.any(is_changed):
            return _sentences(block.label(), block.size, block.size + int(np.argmax(is_changed)))
    if n_past_map > 0:
        law = model.system.contacts[0].impact
        assert isinstance(law, ImpactMap)
        return _sentences(f"{type(law).__name__}: {described(law.impulses)},", 3 * n_past_map, 3 * n_past_map)
    if len(overrun):
        return _sentences("the kinematics of a contact that is not active any more", PAIR, PAIR)
    return ""


def _sentences(name: str, size: int, number: int) -> str:
    return (
        f"{name} has written past the {size} numbers of its block, to out[{number}] or beyond: all numbers computed "
        "since may be wrong. `nonsmooth check` shows the line."
    )
