"""Checks of a solution beyond its energy account: contacts without a check of bodies, cones, and friction that gains.

A suspect run is told by :mod:`nonsmooth.solution.suspicion`.  These findings need not mean that a run is wrong.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.layout import FRICTION_LOSS
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.model.part_pairs import unchecked_contacts

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_FRICTION = 2
"""Column of the friction loss among the energies accounted at events."""


def contacts_without_body_check(solution: Solution) -> tuple[str, ...]:
    """Names of the contacts whose bodies are not checked for overlap; only their own gap shows it.

    Two bodies are checked as a whole if all of their shapes have convex parts.
    """
    return tuple(unchecked_contacts(solution.system.contacts))


def impulses_beyond_cone(solution: Solution) -> NDArray[np.bool_]:
    """True for impulses outside of their friction cones, shape [m], in the order of ``events.listed``.

    Impulses within the cones give the same motion: of redundant contacts, one may have too large a part.
    """
    events = solution.events
    normal, friction = events.listed_impulse[:, 0], events.listed_impulse[:, 1:]
    largest = np.full(len(normal), np.nan)
    return beyond_cones(solution.system.contacts, events.listed, events.first, normal, friction, largest)


def friction_gain(solution: Solution) -> float:
    """Energy that sustained friction added over a run [J]: the sum of all decreases of the integrated friction loss.

    The loss is compared from each sample or event to the next.  Averaged forces can add energy: their friction is
    constant over a span, while the slip may turn.  Laws that store energy in a contact, such as bristles, return it.
    Impacts are left out, because some impact laws add energy by their definition.
    """
    track, events = solution.track, solution.events
    place = events.q.shape[1] + events.u_after.shape[1] + FRICTION_LOSS
    booked = events.booked[:, _FRICTION]
    # the final state holds the sum of both; the part accounted at events is subtracted
    end = track.y[-1, place] + track.booked[-1, _FRICTION] - (booked[-1] if len(booked) else 0.0)
    # a stable sort keeps events before samples at equal times
    order = np.argsort(np.concatenate([events.time, track.time]), kind="stable")
    loss = np.concatenate([events.integrated[:, FRICTION_LOSS], track.y[:-1, place], [end]])[order]
    return float(-np.sum(np.minimum(np.diff(loss), 0.0)))


def findings(solution: Solution) -> str:
    """Findings of all checks in words, each after a comma; "" without any."""
    unchecked = len(contacts_without_body_check(solution))
    outside, gain = int(np.count_nonzero(impulses_beyond_cone(solution))), friction_gain(solution)
    found = [f", {unchecked} contacts whose bodies are not checked for overlap"] if unchecked else []
    found += [f", {outside} impulses outside of their friction cones"] if outside else []
    # a gain below the imbalance of the account is round-off
    found += [f", {gain:.1e} J added by friction"] if gain > solution.energy.unexplained else []
    return "".join(found)
