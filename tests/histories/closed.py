"""Entries of the closed contacts of a run."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import nonsmooth as ns
from nonsmooth.histories.contacts import ClosedContacts
from nonsmooth.histories.request import HistoryRequest


def closed_contacts(solution: ns.Solution, times: ArrayLike) -> ClosedContacts:
    """Entries of all contacts that are closed at times [s]."""
    return ClosedContacts.of(HistoryRequest(solution, np.atleast_1d(np.asarray(times, dtype=float))))
