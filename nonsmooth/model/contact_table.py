"""What the contacts of a system have in numbers, read once for all that lay them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.system.contact import Contact
from nonsmooth.types import Array


@dataclass(frozen=True, eq=False)
class ContactTable:
    """Numbers of the contacts, those of both sides in a row, shape [n, 2] each.

    Attributes
    ----------
    bodies, frames : array
        Number of the body, and of its frame.
    extents, levers : array
        Those of the shapes [m].
    revolutions : array
        That of the shape with the smaller lever, shape [n, 3].
    """

    bodies: NDArray[np.int64]
    frames: NDArray[np.int64]
    extents: Array
    levers: Array
    revolutions: Array

    @classmethod
    def of(cls, bodies: Sequence[Body], contacts: Sequence[Contact]) -> ContactTable:
        """Read contacts between these bodies."""
        number = {id(body): i for i, body in enumerate(bodies)}
        sides = [[number[i] for i in map(id, map(attrgetter(side), contacts))] for side in ("first", "second")]
        frames, extents, levers = (
            list(itertools.chain.from_iterable(map(attrgetter(name), contacts)))
            for name in ("frames", "extents", "levers")
        )
        shapes = [contact.shapes[1 if contact.levers[1] <= contact.levers[0] else 0] for contact in contacts]
        revolutions = {id(shape): shape.revolution for shape in shapes}
        return cls(
            np.array(sides, np.int64).T,
            np.array(frames, np.int64).reshape(-1, 2),
            np.array(extents, float).reshape(-1, 2),
            np.array(levers, float).reshape(-1, 2),
            np.array([revolutions[i] for i in map(id, shapes)], float).reshape(-1, 3),
        )
