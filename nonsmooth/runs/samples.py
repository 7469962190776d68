"""States of a run at its samples, in the memory of its model, for checks after the run."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.state import Floats

_FINEST = 1e-6
"""Least piece of the path of the coordinates, relative to their largest change between two samples."""


def states_at_samples(model: LaidOut, rows: Floats, least_move: float | Floats) -> Generator[float]:
    """Write the states of chosen samples to the memory in turn, and yield the time of each [s].

    The caller evaluates what it needs.  At the end, or when the iterator is closed, the memory has its former state.

    Parameters
    ----------
    model : LaidOut
        The model that ran.
    rows : Floats
        Samples of the run, shape [n, m]: columns are t [s], q, u and more.
    least_move : float or Floats
        A sample is chosen at the latest when a coordinate has changed by this much since the chosen sample before it:
        a number for all coordinates, or one for each, in the units of the coordinates, shape [n_q].
    """
    before = Checkpoint.of(model.memory)
    try:
        for row in rows[_moved_samples(rows[:, 1 : 1 + model.n_q], least_move)]:
            model.memory[owners.Island.time] = row[0]
            model.memory[owners.Island.y] = row[1 : 1 + model.n_y]
            yield float(row[0])
    finally:
        before.put(model.memory)
        # evaluate again, because a checkpoint restores the state but no results of evaluations
        model.evaluate()


def places_at_samples(
    model: LaidOut, rows: Floats, least_move: float | Floats
) -> Iterator[tuple[float, list[list[Place]]]]:
    """Yield the times [s] of chosen samples, and the places of the frames of all bodies then, to search for overlaps.

    Parameters as for :func:`states_at_samples`, which chooses the samples.
    """
    for t in states_at_samples(model, rows, least_move):
        model.evaluate()
        yield t, model.places()


def _moved_samples(q: Floats, least_move: float | Floats) -> list[int]:
    """Numbers of the chosen samples: the first, the last, and each sample between them that moved enough.

    The path of the coordinates is cut into pieces of length ``least_move``: from one sample to the next it grows by the
    largest change of a coordinate, relative to ``least_move``.  Its length is never less than the displacement.
    """
    changes = np.abs(np.diff(q, axis=0))
    # a body without a size has coordinates without one: each of their changes then is a piece of its own
    least = np.maximum(least_move, max(_FINEST * np.max(changes, initial=0.0), np.finfo(float).tiny))
    steps = np.max(changes / least, axis=1, initial=0.0)
    pieces = np.floor(np.concatenate([[0.0], np.cumsum(steps)]))
    return sorted({0, *(1 + np.flatnonzero(np.diff(pieces) > 0.0)).tolist(), len(q) - 1})
