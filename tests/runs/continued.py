"""Runs that were stopped and went on, beside those that were not stopped."""

from __future__ import annotations

import numpy as np

import nonsmooth as ns
from nonsmooth.solution import events

LISTED = "listed_impulse", "listed_memory"
COLUMNS = tuple(name for name in events.COLUMNS if name not in ("first", "listed", "codes", *LISTED))


def differences(one: ns.Solution, other: ns.Solution) -> list[str]:
    """Return in what two runs over the same time differ, in any bit."""
    found = [
        name
        for name in (*COLUMNS, "listed", "codes", *LISTED)
        if not np.array_equal(getattr(one.events, name), getattr(other.events, name))
    ]
    found += [
        name
        for name in ("t", "q", "u", "q_end", "u_end")
        if not np.array_equal(getattr(one, name), getattr(other, name))
    ]
    return found + (["energy"] if one.energy != other.energy else [])


def lost_by_stopping(whole: ns.Solution, before: ns.Solution, after: ns.Solution) -> list[str]:
    """Return in what a run differs, in any bit, from its two parts: all events, the end, the account."""
    found = []
    for name in COLUMNS:
        # the second part begins with an event that says where it starts
        parts = getattr(before.events, name), getattr(after.events, name)[1:]
        if not np.array_equal(getattr(whole.events, name), np.concatenate(parts)):
            found.append(name)
    for name in LISTED:
        parts = getattr(before.events, name), getattr(after.events, name)[after.events.first[1] :]
        if not np.array_equal(getattr(whole.events, name), np.concatenate(parts)):
            found.append(name)
    found += [name for name in ("q_end", "u_end") if not np.array_equal(getattr(whole, name), getattr(after, name))]
    return found + (["energy"] if whole.energy != after.energy else [])
