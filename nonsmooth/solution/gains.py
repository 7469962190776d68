"""Energy that sustained friction added, where it should only dissipate."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.layout import FRICTION_LOSS
from nonsmooth.solution.events import Events
from nonsmooth.solution.track import Track

_FRICTION = 2
"""Column of the friction loss among the energies accounted at events."""


def friction_gain(track: Track, events: Events) -> float:
    """Energy that sustained friction added over a run [J]: the sum of all decreases of the integrated friction loss.

    The loss is compared from each sample or event to the next.  Averaged forces can add energy: their friction is
    constant over a span, while the slip may turn.  Laws that store energy in a contact, such as bristles, return it.
    Impacts are left out, because some impact laws add energy by their definition.
    """
    place = events.q.shape[1] + events.u_after.shape[1] + FRICTION_LOSS
    booked = events.booked[:, _FRICTION]
    # the final state holds the sum of both; what was accounted at events is taken off again
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - (booked[-1] if len(booked) else 0.0)
    # a stable sort keeps events before samples at equal times
    order = np.argsort(np.concatenate([events.time, track.time]), kind="stable")
    loss = np.concatenate([events.integrated[:, FRICTION_LOSS], track.y[:-1, place], [end]])[order]
    return float(-np.sum(np.minimum(np.diff(loss), 0.0)))
