"""What tells models apart: whether a run of one may be continued by another, in another process too."""

from __future__ import annotations

import hashlib

import numpy as np

from nonsmooth.model.image import Image
from nonsmooth.model.layout import CATALOGUE, COUNTS, FLOAT_ARRAYS, INTEGER_ARRAYS, SCALARS
from nonsmooth.model.model import Model

_FUNCTIONS = "_function"


def digest(model: Model, blank: Image) -> str:
    """Return a digest of all numbers of a model that stands nowhere yet, and of the kinds of its parts.

    ``blank`` is its image.  Models with one digest run alike, in whatever process.
    """
    found = hashlib.blake2b(repr((SCALARS.names, tuple(FLOAT_ARRAYS), tuple(INTEGER_ARRAYS), CATALOGUE)).encode())
    for kind in _kinds(model):
        found.update(f"{kind.__module__}.{kind.__qualname__};".encode())
    scalars, floats, blocks, integers = (part.copy() for part in blank.parts)
    memory = model.memory
    record = scalars.view(SCALARS)
    # functions stand elsewhere in every process
    record["impact_map"] = record["impact_map"] != 0
    for name in INTEGER_ARRAYS:
        if name.endswith(_FUNCTIONS) or name == "rooms":
            start = int(record[name][0])
            integers[start : start + _size(record, name)] = 0
    declared, width = int(record["n_declared"][0]), len(CATALOGUE)
    start = int(record["catalogue"][0])
    rows = integers[start : start + width * declared].reshape(declared, width)
    rows[:, [i for i, name in enumerate(CATALOGUE) if name.endswith(_FUNCTIONS)]] = 0
    for place, _, _ in memory.references:
        blocks[place - memory.blocks] = 0
    for part in (scalars, floats, blocks, integers, (memory.owner or memory).floats[memory.tables :]):
        found.update(np.ascontiguousarray(part).data)
    return found.hexdigest()


def _size(record: np.ndarray, name: str) -> int:
    return int(INTEGER_ARRAYS[name]({count: int(record[count][0]) for count in COUNTS}))


def _kinds(model: Model) -> list[type]:
    system = model.system
    parts: list[object] = [*system.bodies, *system.guards, *(tie.component for tie in (*system.joints, *system.loads))]
    for contact in system.contacts:
        parts += [contact.kinematics, contact.normal, contact.friction, contact.impact]
    return [type(part) for part in parts]
