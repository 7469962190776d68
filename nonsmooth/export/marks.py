"""Marks in moving pictures: points of contacts that stick or slip, and of impacts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.contacts import ClosedContacts
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.replay import replay_of
from nonsmooth.histories.request import HistoryRequest

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

WORDS = ("stick", "slip", "impact")
"""The kinds of marks."""


@final
@dataclass(frozen=True, eq=False)
class Marks:
    """Points that are marked at each time.

    Attributes
    ----------
    places : tuple of tuple of array
        ``places[i][k]`` are the points of the kind ``WORDS[k]`` at the time i [m], shape [m, 3].
    """

    places: tuple[tuple[Floats, ...], ...]

    @classmethod
    def of(cls, solution: Solution, times: Floats, seen: float) -> Marks:
        """Points of contacts that stick or slip, and of impacts, at times of a run [s], shape [n].

        The point of an impact is marked for the duration ``seen`` [s].  All marks are missing if the engine of the run
        cannot compute forces.
        """
        if not replay_of(solution).is_flow:
            return cls(len(times) * (len(WORDS) * (np.zeros((0, 3)),),))
        request = HistoryRequest(solution, times)
        forces, impulses = ClosedContacts.of(request), Impulses.of(request)
        points = forces.contact_point.mean(axis=1)
        struck = (impulses.normal_impulse > 0.0) & np.all(np.isfinite(impulses.impulse_point), axis=(1, 2))
        instants, hit = impulses.time[struck], impulses.impulse_point[struck].mean(axis=1)
        found = list[tuple[Floats, ...]]()
        for i, t in enumerate(times.tolist()):
            here = slice(forces.first[i], forces.first[i + 1])
            modes = forces.mode[here]
            recent = hit[(instants <= t) & (instants > t - seen)]
            found.append((points[here][modes == Mode.STICK], points[here][modes == Mode.SLIDE], recent))
        return cls(tuple(found))
