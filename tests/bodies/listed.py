"""Contacts on the neighbour list of a system at its start, as the engine evaluates them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.engine.memory import blocks, owners
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.assembly import lay_out


@dataclass(frozen=True)
class Listed:
    """Geometry of the contacts on the neighbour list, n of them.

    Attributes
    ----------
    contact : array
        Numbers of the declared contacts, shape [n].
    bodies : array
        Numbers of the first and the second body of each, shape [n, 2].
    gap, past : array
        Gap, and how far the points are past the ends of their features [m], shape [n].
    normal : array
        Unit vector from the first body to the second, shape [n, 3].
    first, second : array
        Contact point on either body [m], shape [n, 3].
    """

    contact: Vector
    bodies: Vector
    gap: Vector
    past: Vector
    normal: Vector
    first: Vector
    second: Vector

    @property
    def within(self) -> NDArray[np.bool_]:
        """Whether the points are within their features, shape [n]."""
        return np.asarray(self.past <= 0.0, dtype=bool)


def listed(system: ns.System, of_all: bool = True) -> Listed:
    """Return the contacts on the neighbour list at the start, which need not be one that a run accepts.

    Parameters
    ----------
    system : System
        The system, placed.
    of_all : bool
        False for the list of a run, which leaves out the contacts of convex shapes that are apart.
    """
    laid = lay_out(system, ns.EventDriven())
    laid.list_contacts(of_all)
    laid.evaluate()
    rows = np.array(laid.memory[owners.ContactRecord.geometry][: len(laid.active)])

    def vector(offset: int) -> Vector:
        return np.asarray(rows[:, offset : offset + 3])

    gap, past = rows[:, blocks.GAP], rows[:, blocks.PAST_END]
    points = vector(blocks.POINT_A), vector(blocks.POINT_B)
    number = {id(body): k for k, body in enumerate(system.bodies)}
    rows_of = [laid.system.contacts[int(k)] for k in laid.active]
    bodies = np.array([(number[id(one.first)], number[id(one.second)]) for one in rows_of]).reshape(-1, 2)
    return Listed(np.array(laid.active), bodies, gap, past, vector(blocks.NORMAL), *points)
