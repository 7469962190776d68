"""Findings about a solution: contacts without an overlap check, impulses outside of cones, energy from contacts.

They need not mean that a run is wrong.  The checks that make a run suspect are in :mod:`nonsmooth.solution.suspicion`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.layout import CLOSING_LOSS, FRICTION_LOSS
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.model.part_pairs import unchecked_contacts

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_FRICTION, _CLOSING = 2, 3
"""Columns of the friction loss and of the closing loss in ``events.booked``, the energies accounted so far."""


def contacts_without_body_check(solution: Solution) -> tuple[str, ...]:
    """Names of the contacts whose bodies are not checked for overlap.

    Bodies are checked if all of their shapes have convex parts.  Without the check, only the gap of the contact shows
    an overlap.
    """
    return tuple(unchecked_contacts(solution.system.contacts))


def impulses_beyond_cone(solution: Solution) -> NDArray[np.bool_]:
    """True for impulses outside of their friction cones, shape [m], in the order of ``events.listed``.

    The distribution of impulses over redundant contacts is not unique, and it may load one contact beyond its cone.
    The motion is right all the same: another distribution, within the cones, gives the same motion.
    """
    events = solution.events
    normal, friction = events.listed_impulse[:, 0], events.listed_impulse[:, 1:]
    largest = np.full(len(normal), np.nan)
    return beyond_cones(solution.system.contacts, events.listed, events.first, normal, friction, largest)


def friction_gain(solution: Solution) -> float:
    """Energy that sustained friction added over a run [J]: the sum of all decreases of the integrated friction loss.

    The loss is compared from each sample or event to the next.  It decreases in two cases:

    1. The time-stepping fallback may add energy.  Its friction is constant over a span, while the slip may turn.
    2. A friction law returns energy that it has stored in a contact, for example in bristles.

    Impacts are left out, because some impact laws add energy by their definition.  Events are read block by block,
    because the events of a long run would not fit into memory.
    """
    track = solution.track
    gain, last, n_samples, booked, time = 0.0, np.zeros(0), 0, 0.0, track.time[:-1]
    for block in solution.events.blocks():
        place = track.y.shape[1] - block.integrated.shape[1] + FRICTION_LOSS
        # number of samples before the last event of this block; a sample at the time of an event comes after the event
        stop = int(np.searchsorted(time, block.time[-1])) if len(block) else 0
        order = np.argsort(np.concatenate([block.time, time[n_samples:stop]]), kind="stable")
        loss = np.concatenate([block.integrated[:, FRICTION_LOSS], track.y[n_samples:stop, place]])[order]
        gain, last, n_samples = gain + _decrease(last, loss), loss[-1:], stop
        booked = float(block.booked[-1, _FRICTION]) if len(block) else 0.0
    # the final state has only the total friction loss, in `booked`; subtract the part that was accounted at events, so
    # that the integrated part remains
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - booked
    return gain + _decrease(last, np.append(track.y[n_samples:-1, place], end))


def closing_gain(solution: Solution) -> float:
    """Energy that averaged normal forces added over a run [J]: the sum of all decreases of the closing loss.

    The loss is compared from each sample or event to the next.  The normal force of the time-stepping fallback is
    constant over a span, so that it may push while a gap opens.
    """
    track, gain, last, n_samples = solution.track, 0.0, np.zeros(0), 0
    for block in solution.events.blocks():
        place = track.y.shape[1] - block.integrated.shape[1] + CLOSING_LOSS
        # number of samples before the last event of this block
        stop = int(np.searchsorted(track.time[:-1], block.time[-1])) if len(block) else 0
        order = np.argsort(np.concatenate([block.time, track.time[n_samples:stop]]), kind="stable")
        of_events = block.integrated[:, CLOSING_LOSS] + block.booked[:, _CLOSING]
        of_samples = track.y[n_samples:stop, place] + track.booked[n_samples:stop, _CLOSING]
        loss = np.concatenate([of_events, of_samples])[order]
        gain, last, n_samples = gain + _decrease(last, loss), loss[-1:], stop
    return gain + _decrease(last, track.y[n_samples:, place] + track.booked[n_samples:, _CLOSING])


def _decrease(last: Floats, loss: Floats) -> float:
    """Sum of the decreases of a loss [J] from one value to the next; ``last`` is the value before the first, if any."""
    return float(-np.sum(np.minimum(np.diff(loss, prepend=last), 0.0)))


def findings(solution: Solution) -> str:
    """Text with the findings of all checks, each after a comma; "" without findings."""
    unchecked = len(contacts_without_body_check(solution))
    outside = int(np.count_nonzero(impulses_beyond_cone(solution)))
    gains = {"friction": friction_gain(solution), "averaged normal forces": closing_gain(solution)}
    found = [f", {unchecked} contacts whose bodies are not checked for overlap"] if unchecked else []
    found += [f", {outside} impulses outside of their friction cones"] if outside else []
    # report the gain only if it is above the unexplained energy: a smaller gain may be an error of the integration
    found += [f", {gain:.1e} J added by {by}" for by, gain in gains.items() if gain > solution.energy.unexplained]
    return "".join(found)
