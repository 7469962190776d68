"""Energy that sustained friction added, where it should only dissipate."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.engine.memory.layout import FRICTION_LOSS
from nonsmooth.solution.events import Events
from nonsmooth.solution.state import Floats
from nonsmooth.solution.track import Track

_FRICTION = 2
"""Column of the friction loss among the energies accounted at events."""


def friction_gain(track: Track, events: Events) -> float:
    """Energy that sustained friction added over a run [J]: the sum of all decreases of the integrated friction loss.

    The loss is compared from each sample or event to the next.  Averaged forces can add energy: their friction is
    constant over a span, while the slip may turn.  Laws that store energy in a contact, such as bristles, return it.
    Impacts are left out, because some impact laws add energy by their definition.  Events are read block by block, as
    those of a long run are in its output folder and would not fit into memory.
    """
    place = track.y.shape[1] - events.n_integrated + FRICTION_LOSS
    blocks, booked, gain, last, n_samples = events.blocks("time", "integrated", "booked"), 0.0, 0.0, math.nan, 0
    time, sampled = track.time[:-1], track.y[:-1, place]
    for event_time, integrated, accounted in blocks:
        # samples before the last event of the block; samples at the time of events are after these
        stop = int(np.searchsorted(time, event_time[-1], side="left"))
        order = np.argsort(np.concatenate([event_time, time[n_samples:stop]]), kind="stable")
        loss = np.concatenate([integrated[:, FRICTION_LOSS], sampled[n_samples:stop]])[order]
        gain, last, n_samples, booked = gain + _decrease(last, loss), loss[-1], stop, accounted[-1, _FRICTION]
    # the final state holds the sum of both; what was accounted at events is taken off again
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - booked
    return gain + _decrease(last, np.append(sampled[n_samples:], end))


def _decrease(last: float, loss: Floats) -> float:
    """Sum of the decreases of a loss from one value to the next [J]; NaN is no value before the first."""
    steps = np.diff(loss, prepend=last if last == last else loss[0])
    return float(-np.sum(np.minimum(steps, 0.0)))
