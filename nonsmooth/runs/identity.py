"""What tells models apart: whether a run of one may be continued by another, in another process too."""

from __future__ import annotations

import hashlib
from typing import Any, final

import numpy as np

from nonsmooth.model.image import Image
from nonsmooth.model.layout import CATALOGUE, COUNTS, FLOAT_ARRAYS, INTEGER_ARRAYS, SCALARS
from nonsmooth.model.model import Model

_FUNCTIONS = "_function"


@final
class Identity:
    """A digest of all numbers of a model and of the kinds of its parts, made when it is first asked for.

    Parameters
    ----------
    digest : str
        The digest, where it is known.
    model, blank : Model, Image
        Where it is not: the model, and its image before any run.
    """

    def __init__(self, digest: str = "", model: Model | None = None, blank: Image | None = None) -> None:
        self._digest, self._model, self._blank = digest, model, blank

    @property
    def digest(self) -> str:
        """The digest."""
        if not self._digest:
            assert self._model is not None and self._blank is not None
            self._digest = _digest(self._model, self._blank)
        return self._digest

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Identity) and (self is other or self.digest == other.digest)

    def __hash__(self) -> int:
        return hash(self.digest)

    def __reduce__(self) -> tuple[Any, ...]:
        return Identity, (self.digest,)


def _digest(model: Model, blank: Image) -> str:
    found = hashlib.sha256(repr((SCALARS.names, tuple(FLOAT_ARRAYS), tuple(INTEGER_ARRAYS), CATALOGUE)).encode())
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
