"""Contacts whose features are searched for, as contacts of given features: one for each pair of features."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import replace

from nonsmooth.interfaces import CandidateSearch, FeaturePair

_FAR = 1e150
"""Distance up to which the features of a contact are valid [m]: without a limit."""


def every_pair(contacts: Iterable[FeaturePair]) -> Iterator[FeaturePair]:
    """Yield the contacts of fixed features, and a contact for each pair of features that a search may find.

    Contacts that share a search are replaced by one contact for each pair (kind, i, j) of the ``counts`` of the search,
    in the order of its kinds.
    """
    for contact, search in _by_search(contacts):
        if search is None:
            yield contact
            continue
        for kind, (m, n) in search.counts.items():
            for i, j in itertools.product(range(m), range(n)):
                yield _given(contact, kind, i, j)


def first_pairs(contacts: Iterable[FeaturePair]) -> Iterator[FeaturePair]:
    """Yield contacts of given features: the first with each evaluator, and the first pair of each kind of a search."""
    known = set()
    for contact, search in _by_search(contacts):
        if search is None and contact.evaluator not in known:
            known.add(contact.evaluator)
            yield contact
        for kind, (m, n) in search.counts.items() if search is not None else ():
            if m > 0 and n > 0:
                yield _given(contact, kind, 0, 0)


def _by_search(contacts: Iterable[FeaturePair]) -> Iterator[tuple[FeaturePair, CandidateSearch | None]]:
    """Yield contacts of given features, and the first contact of each search, with the search."""
    known = set[int]()
    for contact in contacts:
        if contact.candidates is None or id(contact.candidates) not in known:
            known.add(id(contact.candidates))
            yield contact, contact.candidates


def _given(contact: FeaturePair, kind: float, i: int, j: int) -> FeaturePair:
    """Return a contact whose search found the features ``i`` and ``j``, and does not find others."""
    return replace(contact, values={**contact.values, "candidate": (kind, float(i), float(j), _FAR)}, candidates=None)
