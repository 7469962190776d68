"""Energy that sustained friction added, where it should only dissipate."""

from __future__ import annotations

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
    gain, last, n_samples, booked, time = 0.0, np.zeros(0), 0, 0.0, track.time[:-1]
    for block in events.blocks():
        place = track.y.shape[1] - block.integrated.shape[1] + FRICTION_LOSS
        # samples before the last event of the block; samples at the time of events are after these
        stop = int(np.searchsorted(time, block.time[-1])) if len(block) else 0
        order = np.argsort(np.concatenate([block.time, time[n_samples:stop]]), kind="stable")
        loss = np.concatenate([block.integrated[:, FRICTION_LOSS], track.y[n_samples:stop, place]])[order]
        gain, last, n_samples = gain + _decrease(last, loss), loss[-1:], stop
        booked = float(block.booked[-1, _FRICTION]) if len(block) else 0.0
    # the final state holds the sum of both; what was accounted at events is taken off again
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - booked
    return gain + _decrease(last, np.append(track.y[n_samples:-1, place], end))


def _decrease(last: Floats, loss: Floats) -> float:
    """Sum of the decreases of a loss [J] from one value to the next; ``last`` is the value before the first, if any."""
    return float(-np.sum(np.minimum(np.diff(loss, prepend=last), 0.0)))
