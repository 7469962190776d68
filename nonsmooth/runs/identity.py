"""What tells models apart: whether a run of one may be continued by another, in another process too."""

from __future__ import annotations

import hashlib

import numpy as np

from nonsmooth.engine.memory.layout import CATALOGUE
from nonsmooth.engine.memory.tables import (
    ARRAYS_OF,
    CONSTANT_SCALARS,
    COUNTS,
    FLOAT_ARRAYS,
    INTEGER_ARRAYS,
    N_SCALARS,
    SCALARS,
    places,
)
from nonsmooth.interfaces import Engine
from nonsmooth.model.given import parameter_places
from nonsmooth.model.image import Booleans, Image
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying_contacts import by_kind
from nonsmooth.parameters import rules

_FUNCTIONS = tuple(name for name in INTEGER_ARRAYS if name.endswith("_function") or name == "entry_points")
_CHANGING = {
    *("facing", "touching", "identity", "block_start", "catalogue", "unit_order", "own_guard_spent"),
    *("body_flies", "body_turns", "body_course", "body_closed", "body_version", "body_stood", "body_accelerated"),
    *("integrated", "seen_a", "seen_b"),
    *CATALOGUE,
}
"""Integers of the bodies that a run changes; all others say where something stands."""
_STANDING = (*_FUNCTIONS, *(name for name in ARRAYS_OF["bodies"].integers if name not in _CHANGING))
_NUMERICS = tuple(ARRAYS_OF["numerics"].floats)
_COLUMNS = [i for i, name in enumerate(CATALOGUE) if name.endswith("_function")]
_LAYOUT = hashlib.blake2b(repr((SCALARS.names, (*FLOAT_ARRAYS,), (*INTEGER_ARRAYS,), CATALOGUE)).encode()).digest()


def digest(model: LaidOut, blank: Image, engine: Engine) -> str:
    """Return a digest of all numbers of a model that stands nowhere yet, of the kinds of its parts, and of an engine.

    ``blank`` is its image.  Models with one digest run alike, in whatever process.
    """
    scalars, floats, blocks, integers = blank.parts
    scalars, blocks, integers = scalars.copy(), blocks.copy(), integers.copy()
    memory, record = model.memory, scalars[:N_SCALARS].view(SCALARS)
    # functions stand elsewhere in every process, and so do the tables of copies
    record["impact_map"] = record["impact_map"] != 0
    for name in _FUNCTIONS:
        start = int(record[name][0])
        integers[start : start + _size(record, name)] = 0
    declared, width = int(record["n_declared"][0]), len(CATALOGUE)
    start = int(record["catalogue"][0])
    integers[start : start + width * declared].reshape(declared, width)[:, _COLUMNS] = 0
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
    start, width = int(record["catalogue"][0]), len(CATALOGUE)
    rows = start + np.arange(width * int(record["n_declared"][0])).reshape(-1, width)
    blocks = np.array([place - model.memory.blocks for place, _, _ in model.memory.references], dtype=np.int64)
    integers = np.concatenate([*ranges, rows[:, :-1].ravel()]).astype(np.int64)
    standing = places(*CONSTANT_SCALARS, "impact_map", "watch"), np.concatenate(numerics), blocks, integers
    made = tuple(np.ones(len(part), bool) for part in (*blank.parts, blank.parts[2]))
    for part, those in zip(made, (*standing, parameter_places(model)), strict=True):
        part[those] = False
    return made


def _size(record: np.ndarray, name: str) -> int:
    return int((FLOAT_ARRAYS | INTEGER_ARRAYS)[name]({count: int(record[count][0]) for count in COUNTS}))


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
