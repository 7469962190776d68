"""Energy that friction brought in."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.layout import FRICTION_LOSS
from nonsmooth.solution.events import Events
from nonsmooth.solution.track import Track

_FRICTION = 2
"""Where the loss to friction stands in what is booked."""


def friction_gain(track: Track, events: Events) -> float:
    """Return how much energy sustained friction brought in over a run [J]: the decreases of the loss to it, summed up.

    From one sample or event to the next that loss grows.  Where forces are averaged friction is that of the span, and
    may push along a slip that changes meanwhile.  Laws that store energy in a contact, as bristles do, give it back.
    Of impacts some laws bring energy in by their definition; they are not counted.
    """
    place = events.q.shape[1] + events.u_after.shape[1] + FRICTION_LOSS
    booked = events.booked[:, _FRICTION]
    # the last state has all of its energies booked
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - (booked[-1] if len(booked) else 0.0)
    # an event comes before a sample of the same time
    order = np.argsort(np.concatenate([events.time, track.time]), kind="stable")
    loss = np.concatenate([events.integrated[:, FRICTION_LOSS], track.y[:-1, place], [end]])[order]
    return float(-np.sum(np.minimum(np.diff(loss), 0.0)))
