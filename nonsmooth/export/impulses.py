"""Impulses of impacts as arrows, each of which is there for a moment."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.export.meshes import along_axes
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.request import Request
from nonsmooth.scene.scene import sides

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_SEEN = 0.05
"""How long an arrow is there, unless the next one comes before [s]."""


@final
@dataclass(frozen=True, eq=False)
class Arrows:
    """The arrows of one contact: each holds from its time to the next one.

    Attributes
    ----------
    contact : str
        Name of the contact.
    times : array
        [s], shape [n].
    origin : array
        Where they begin [m], shape [n, 3].
    axes : array
        The first one, a column, points along the arrow, shape [n, 3, 3].
    size : array
        Impulse by that of the strongest impact of the run, 0 where there is no arrow, shape [n].
    """

    contact: str
    times: Floats
    origin: Floats
    axes: Floats
    size: Floats


def arrows(solution: Solution) -> Iterator[Arrows]:
    """Give the arrows of each contact that takes part in an impact; they show what bodies that move get."""
    # also of an engine that records no contacts, and so no events
    found = Impulses.recorded(Request(solution, np.zeros(0)))
    side = sides(solution.system)[found.impulse_contact][:, None]
    push = side * (found.normal_impulse[:, None] * found.impulse_normal + found.friction_impulse)
    size = np.linalg.norm(push, axis=1)
    hits = np.flatnonzero((found.normal_impulse > 0.0) & np.isfinite(size))
    for contact in np.unique(found.impulse_contact[hits]).tolist():
        own = hits[found.impulse_contact[hits] == contact]
        begin = found.time[own]
        # an arrow begins at its time and ends some time after, but not past the beginning of the next one
        until = np.minimum(begin + _SEEN, np.append(begin[1:], np.inf))
        times = np.concatenate([solution.track.time[:1], np.column_stack([begin, until]).ravel()])
        strength = np.column_stack([size[own] / np.max(size[hits]), np.zeros(len(own))])
        rows = np.concatenate([own[:1], np.repeat(own, 2)])
        last = np.append(np.diff(times) > 0.0, True)
        yield Arrows(
            solution.system.contacts[contact].name,
            times[last],
            found.impulse_point[rows].mean(axis=1)[last],
            along_axes(push[rows])[last],
            np.concatenate([[0.0], strength.ravel()])[last],
        )
