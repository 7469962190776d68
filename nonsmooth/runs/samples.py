"""States of a run at its samples, in the memory of its model, for checks after the run."""

from __future__ import annotations

from collections.abc import Generator, Iterator

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.state import Floats


def states_at_samples(model: LaidOut, rows: Floats, least_move: float) -> Generator[float]:
    """Write the states of chosen samples to the memory in turn, and yield the time of each [s].

    The caller evaluates what it needs.  At the end, or when the iterator is closed, the memory has its former state.

    Parameters
    ----------
    model : LaidOut
        The model that ran.
    rows : Floats
        Samples of the run, shape [n, m]: columns are t [s], q, u and more.
    least_move : float
        A sample is chosen if a coordinate changed by more than this [m or rad] since the chosen sample before it.
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


def places_at_samples(model: LaidOut, rows: Floats, least_move: float) -> Iterator[tuple[float, list[list[Place]]]]:
    """Yield the times [s] of chosen samples, and the places of the frames of all bodies then, to search for overlaps.

    Parameters as for :func:`states_at_samples`, which chooses the samples.
    """
    for t in states_at_samples(model, rows, least_move):
        model.evaluate()
        yield t, model.places()


def _moved_samples(q: Floats, least_move: float) -> list[int]:
    """Numbers of the chosen samples: the first, the last, and each sample between them that moved enough.

    A sample moved enough if a coordinate changed by more than ``least_move`` [m or rad] since the last chosen sample.
    """
    chosen = [0]
    for i in range(1, len(q)):
        if np.max(np.abs(q[i] - q[chosen[-1]]), initial=0.0) > least_move:
            chosen.append(i)
    return sorted({*chosen, len(q) - 1})
