"""The blocks of the engine's memory that plug-ins write, with their names, and who has written past the end of one."""

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
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.feature_searches import find_searches
from nonsmooth.system.contact import Contact, Tie


class Block(NamedTuple):
    """A block of the engine's memory.

    Attributes
    ----------
    label : callable
        Returns in words whose it is.
    function : callable
        The function that writes it.
    start, size : int
        Where it begins, and its floats.
    written : int
        How many of them a function must write.
    """

    label: Callable[[], str]
    function: Callable[..., None]
    start: int
    size: int
    written: int


def blocks(model: LaidOut) -> Iterator[Block]:
    """Yield the blocks of loads, bodies and listed contacts; bodies feel loads, contacts both."""
    yield from _blocks_of_bodies(model)
    yield from _blocks_of_flights(model)
    for slot in range(int(model.memory[owners.Island.n_contacts])):
        yield _block_of_slot(model, slot)


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
        written = FRAME if body.n_u == 0 else rates
        yield Block(
            functools.partial("body {!r}, {!r}:".format, names[i], body),
            body.evaluator,
            start,
            rates + body.n_u**2 + 2,
            written,
        )


def _blocks_of_flights(model: LaidOut) -> Iterator[Block]:
    names = model.system.names.bodies
    for i, body in enumerate(model.system.bodies):
        if body.flight is not None and _entry(model, owners.Body.ballistic_function, i) != 0:
            label, size = functools.partial("body {!r}, {!r} in flight:".format, names[i], body), body.n_q + body.n_u
            yield Block(label, body.flight, _entry(model, owners.Body.ballistic_out, i), size, size)


def _block_of_slot(model: LaidOut, slot: int) -> Block:
    contact = model.system.contacts[_entry(model, owners.Contact.declared, slot)]
    function, first = contact.kinematics.evaluator, model.memory.start(owners.Contact.geometry)
    return Block(_label(contact, function), function, first + GEOMETRY * slot, PAIR, PAIR)


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
    for number, pool in enumerate(find_searches(model.system.contacts)):
        function = pool.search.function
        label = functools.partial(_words, pool.owner, function)
        yield Block(label, function, _entry(model, owners.Search.out, number), pool.size, 1)


def _label(owner: Tie | Contact, function: Callable[..., None]) -> Callable[[], str]:
    return lambda: _words(str(owner), function)


def _words(owner: str, function: Callable[..., None]) -> str:
    return f"{owner}: {described(function)},"


def _entry(model: LaidOut, declared: Any, i: int) -> int:
    return int(model.memory[declared][i])


def block_overrun(model: LaidOut, ends: BlockEnds) -> str:
    """Return a sentence that names a function that has written past its block; nothing if none has."""
    memory = model.memory
    if ends.hold(memory) and not int(memory[owners.Run.n_past_map]) > 0:
        return ""
    slots, listed = memory[owners.Model.n_slots], memory[owners.Island.n_contacts]
    behind = memory[owners.Contact.geometry][:slots][:, PAIR:]
    written = np.flatnonzero(np.any(behind != UNTOUCHED, axis=1))
    pairs = [_block_of_slot(model, int(slot)) for slot in written if slot < listed]
    for block in (
        *_blocks_of_bodies(model),
        *_blocks_of_flights(model),
        *pairs,
        *_blocks_of_searches(model),
        *_blocks_of_joints_and_laws(model),
    ):
        end = block.start + block.size
        touched = memory.floats[end : end + GUARD] != UNTOUCHED
        if np.any(touched):
            return _sentence(block.label(), block.size, block.size + int(np.argmax(touched)))
    n = int(memory[owners.Run.n_past_map])
    if n > 0:
        law = model.system.contacts[0].impact
        assert isinstance(law, ImpactMap)
        return _sentence(f"{type(law).__name__}: {described(law.impulses)},", 3 * n, 3 * n)
    if len(written):
        return _sentence("the kinematics of a contact that is not near by now", PAIR, PAIR)
    return ""


def _sentence(name: str, size: int, number: int) -> str:
    return (
        f"{name} has written past the {size} numbers of its block, to out[{number}] or further on: nothing that was "
        "computed since can be trusted. `nonsmooth check` shows the line."
    )
