"""ContactTable: the numbers of all contacts of a system as arrays. To read thousands of contacts once saves time."""

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
    """Numbers of the contacts, a row for each contact and a column for each side.

    Attributes
    ----------
    bodies, frames : array
        Numbers of the bodies, and of their frames, shape [n, 2].
    extents, support_radii : array
        Radii about the origins of the frames that hold the shapes, and largest offsets with which a turn about these
        origins moves a surface along its normal (`extent` and `lever` of :class:`nonsmooth.interfaces.Shape`) [m],
        shape [n, 2].
    revolutions : array
        Axis of revolution of the shape with the smaller support radius, or zero, shape [n, 3].
    """

    bodies: NDArray[np.int64]
    frames: NDArray[np.int64]
    extents: Array
    support_radii: Array
    revolutions: Array

    @classmethod
    def of(cls, bodies: Sequence[Body], contacts: Sequence[Contact]) -> ContactTable:
        """The table of all contacts of a system with these bodies.

        Bodies and shapes are known by their identity. Attributes are read by maps, because systems may have thousands
        of contacts, and the axis of each shape is computed once.
        """
        # the number of each body
        number = {id(body): i for i, body in enumerate(bodies)}
        sides = [[number[i] for i in map(id, map(attrgetter(side), contacts))] for side in ("first", "second")]
        frames, extents, support_radii = (
            list(itertools.chain.from_iterable(map(attrgetter(name), contacts)))
            for name in ("frames", "extents", "levers")
        )
        # of each contact the shape with the smaller support radius, the second if they are equal
        shapes = [contact.shapes[1 if contact.levers[1] <= contact.levers[0] else 0] for contact in contacts]
        revolutions = {id(shape): shape.revolution for shape in shapes}
        return cls(
            np.array(sides, np.int64).T,
            np.array(frames, np.int64).reshape(-1, 2),
            np.array(extents, float).reshape(-1, 2),
            np.array(support_radii, float).reshape(-1, 2),
            np.array([revolutions[i] for i in map(id, shapes)], float).reshape(-1, 3),
        )
