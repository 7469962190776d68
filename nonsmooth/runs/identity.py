"""What tells models apart: whether a run of one may be continued by another, in another process too."""

from __future__ import annotations

import hashlib

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Life, declarations
from nonsmooth.engine.memory.tables import (
    CONSTANT_SCALARS,
    COUNTS,
    FLOAT_ARRAYS,
    INTEGER_ARRAYS,
    N_SCALARS,
    OWNERS,
    SCALARS,
    places,
)
from nonsmooth.interfaces import Engine
from nonsmooth.model.given import parameter_places
from nonsmooth.model.image import Booleans, Image
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import by_kind
from nonsmooth.parameters import rules

_FUNCTIONS = tuple(name for name in INTEGER_ARRAYS if name.endswith("_function") or name == "model.entry_points")
_FUNCTIONS += tuple(name for name in INTEGER_ARRAYS if name.endswith(".function"))
_STANDING = tuple(
    one.key
    for owner in OWNERS
    for one in declarations(owner).values()
    if one.key in INTEGER_ARRAYS and one.life is Life.PARAMETER and (owner is not owners.Contact or one.is_of_slot)
)
"""Integers that no run changes: they say where something stands."""
_NUMERICS = tuple(one.key for one in declarations(owners.Coefficients).values())
_LAYOUT = hashlib.blake2b(repr((SCALARS.names, (*FLOAT_ARRAYS,), (*INTEGER_ARRAYS,))).encode()).digest()


def digest(model: LaidOut, blank: Image, engine: Engine) -> str:
    """Return a digest of all numbers of a model that stands nowhere yet, of the kinds of its parts, and of an engine.

    ``blank`` is its image.  Models with one digest run alike, in whatever process.
    """
    scalars, floats, blocks, integers = blank.parts
    scalars, blocks, integers = scalars.copy(), blocks.copy(), integers.copy()
    memory, record = model.memory, scalars[:N_SCALARS].view(SCALARS)
    # functions stand elsewhere in every process, and so do the tables of copies
    record["options.impact_map"] = record["options.impact_map"] != 0
    for name in _FUNCTIONS:
        start = int(record[name][0])
        integers[start : start + _size(record, name)] = 0
    for place, _, _ in memory.references:
        blocks[place - memory.blocks] = 0
    found = hashlib.blake2b(_LAYOUT + _kinds(model) + _said(engine))
    for part in (scalars, floats, blocks, integers):
        # most of them are zero
        filled = np.flatnonzero(part)
        found.update(filled.data)
        found.update(part[filled].data)
    found.update((memory.owner or memory).floats[memory.tables :].data)
    return found.hexdigest()


def changing(model: LaidOut, blank: Image) -> tuple[Booleans, ...]:
    """Return of every place in the parts of an image whether a run may change it.

    It does not change sizes, offsets, functions, and ways to tables: where the rest of an image comes from a file,
    these are left as this process has them.  Last comes, of every place in the blocks, whether it may be other than a
    parameter, which is the same in all processes.
    """
    record = blank.parts[0][:N_SCALARS].copy().view(SCALARS)
    ranges, numerics = (
        [np.arange(_size(record, name)) + int(record[name][0]) for name in names] for names in (_STANDING, _NUMERICS)
    )
    blocks = np.array([place - model.memory.blocks for place, _, _ in model.memory.references], dtype=np.int64)
    integers = np.concatenate(ranges).astype(np.int64)
    standing = (
        places(*CONSTANT_SCALARS, "options.impact_map", "request.interrupt_check"),
        np.concatenate(numerics),
        blocks,
        integers,
    )
    made = tuple(np.ones(len(part), bool) for part in (*blank.parts, blank.parts[2]))
    for part, those in zip(made, (*standing, parameter_places(model)), strict=True):
        part[those] = False
    return made


def _size(record: np.ndarray, name: str) -> int:
    return int({**FLOAT_ARRAYS, **INTEGER_ARRAYS}[name]({count: int(record[f"model.{count}"][0]) for count in COUNTS}))


def _said(engine: Engine) -> bytes:
    return repr((type(engine).__qualname__, {name: getattr(engine, name) for name in rules(type(engine))})).encode()


def _kinds(model: LaidOut) -> bytes:
    """Return the names of the classes of all parts of a system, and which part is of which."""
    system = model.system
    parts: list[object] = [*system.bodies, *system.guards, *(tie.component for tie in (*system.joints, *system.loads))]
    known: dict[type, int] = {}
    numbers = [known.setdefault(type(part), len(known)) for part in parts]
    contacts = system.contacts
    rows = np.zeros((len(contacts), 4), np.int64)
    for same in by_kind(contacts):
        one = contacts[same[0]]
        laws = one.kinematics, one.normal, one.friction, one.impact
        rows[same] = [known.setdefault(type(part), len(known)) for part in laws]
    names = repr([(kind.__module__, kind.__qualname__) for kind in known]).encode()
    return names + np.array(numbers).tobytes() + rows.tobytes()
