"""RowTable: the numbers of all rows of contacts of a system as arrays. To read thousands of rows once saves time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.system.contacts import Contacts
from nonsmooth.types import Array


@dataclass(frozen=True, eq=False)
class RowTable:
    """Numbers of the rows of contacts, a row for each pair of shapes and a column for each side.

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
    def of(cls, bodies: Sequence[Body], contacts: Contacts) -> RowTable:
        """The table of all rows of contacts of a system with these bodies.

        Bodies and shapes are known by their identity. The axis of each shape is computed once.
        """
        # the number of each body
        number, rows = {id(body): i for i, body in enumerate(bodies)}, contacts.rows
        # of each row the shape with the smaller support radius, the second if they are equal
        shapes = [row.shapes[1 if row.levers[1] <= row.levers[0] else 0] for row in rows]
        revolutions = {id(shape): shape.revolution for shape in shapes}
        return cls(
            np.array([[number[id(body)] for body in row.bodies] for row in rows], np.int64).reshape(-1, 2),
            np.array([row.frames for row in rows], np.int64).reshape(-1, 2),
            np.array([row.extents for row in rows], float).reshape(-1, 2),
            np.array([row.levers for row in rows], float).reshape(-1, 2),
            np.array([revolutions[id(shape)] for shape in shapes], float).reshape(-1, 3),
        )
