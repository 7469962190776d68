"""Digest of a model: it shows whether a run of one model can be continued by another, also in another process."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from nonsmooth.binding.source import name_of
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, Life, declarations
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS, INTEGER_ARRAYS, OWNERS, SCALARS, SLOT_COUNTS
from nonsmooth.interfaces import Engine
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import groups_of
from nonsmooth.parameters import rules

_LAYOUT = hashlib.blake2b(repr((SCALARS.names, (*FLOAT_ARRAYS,), (*INTEGER_ARRAYS,))).encode()).digest()


def digest(model: LaidOut, engine: Engine) -> str:
    """Digest of all parameters of a model, of the classes of its parts, and of the options of an engine.

    Models with the same digest give the same runs, to the last bit. So a run of one can be continued by the other.
    """
    found = hashlib.blake2b(_LAYOUT + _classes(model) + _options(engine))
    for numbers in _parameters(model.memory):
        # bits, because NaN and -0.0 count, too; most are zero, and places and bits of the others are fewer bytes
        bits = np.ascontiguousarray(numbers).view(np.uint8 if numbers.dtype == bool else np.int64).ravel()
        nonzero = np.flatnonzero(bits)
        found.update(nonzero.data)
        found.update(bits[nonzero].data)
    return found.hexdigest()


def _parameters(memory: Memory) -> Iterator[np.ndarray]:
    """All numbers of a memory that no run changes and that are the same in every process, array by array."""
    for owner in (*OWNERS, *memory.own):
        # a view of another array is that array, and addresses of functions are others in each process
        for one in declarations(owner).values():
            if one.life is Life.PARAMETER and not one.inside[0] and not one.is_address and not _is_of_slots(one):
                yield np.atleast_1d(np.asarray(memory[one]))
    blocks = memory.floats[memory.blocks : memory.slots].copy()
    # what a run writes
    blocks[memory.written] = 0.0
    # numbers that refer to tables: in the memory of a copy they are other distances
    blocks[memory.references[:, 0] - memory.blocks] = 0.0
    yield blocks
    # the tables, which a copy of a model reads in the memory of the original
    yield memory.table_numbers


def _is_of_slots(one: Declaration) -> bool:
    """True for a number that depends on the number of slots for active contacts, or that a slot has a copy of.

    The number of slots grows in a run, and does not change its results.
    """
    return one.owner is owners.ContactRecord or (one.owner is owners.ModelNumbers and one.name in SLOT_COUNTS)


def _options(engine: Engine) -> bytes:
    """Class of an engine, and the values of its options, as bytes for the digest."""
    return repr((type(engine).__qualname__, {name: getattr(engine, name) for name in rules(type(engine))})).encode()


def _classes(model: LaidOut) -> bytes:
    """Names of the classes of all parts of a system and of the evaluators of contacts, and their number for each part.

    Otherwise two classes or evaluators with the same parameters would give the same digest.
    """
    system = model.system
    parts: list[object] = [*system.bodies, *system.guards, *(tie.component for tie in (*system.joints, *system.loads))]
    # classes, and functions of contacts, are numbered in the order in which they are met
    known: dict[Any, int] = {}
    numbers = [known.setdefault(type(part), len(known)) for part in parts]
    # the kind of each contact is a parameter
    kinds: list[list[int]] = []
    for same in groups_of(system.contacts):
        row = system.contacts.rows[same[0]]
        laws = row.laws.normal, row.laws.friction, row.laws.impact
        for contact in row.kinematics:
            kinds.append([known.setdefault(one, len(known)) for one in (contact.evaluator, *map(type, laws))])
    names = repr([(kind.__module__, name_of(kind)) for kind in known]).encode()
    return names + np.array(numbers).tobytes() + np.array(kinds, np.int64).tobytes()
