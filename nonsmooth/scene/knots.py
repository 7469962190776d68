"""Knots: the times between which a run is drawn along straight lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.visitor import visitor

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_FEWEST = 600
"""Where a run has fewer, what is between its samples is followed, so that a flight is seen as a curve."""


def knots(solution: Solution, most: int) -> Floats:
    """Return times [s], shape [n]: all instants of events and at most so many others, if possible samples."""
    samples = solution.t
    chosen = samples[:: max(1, -(-len(samples) // most))] if len(samples) > 0 else samples
    instants = np.unique(solution.events.time)
    found = np.unique(np.concatenate([chosen, samples[-1:], instants, [solution.t_end]]))
    if len(found) < min(_FEWEST, most) and visitor(solution).solves:
        found = np.union1d(found, np.linspace(found[0], found[-1], min(_FEWEST, most)))
    return np.asarray(found)
