"""Every pair of features of two shapes as a contact of its own, in place of a search for near features."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

from nonsmooth.interfaces import FeaturePair

_FAR = 1e150
"""Distance up to which the features of a contact are valid [m]: without a limit."""


def every_pair(contacts: Sequence[FeaturePair]) -> Iterator[FeaturePair]:
    """Yield contacts with fixed features: those given, and every pair of features that a search may find.

    Contacts that share a search are replaced by one contact for each pair (kind, i, j) of the ``counts`` of the search,
    in the order of its kinds.
    """
    searches = set[int]()
    for contact in contacts:
        search = contact.candidates
        if search is None:
            yield contact
        elif id(search) not in searches:
            searches.add(id(search))
            for kind, (m, n) in search.counts.items():
                for i, j in itertools.product(range(m), range(n)):
                    values = {**contact.values, "candidate": (kind, float(i), float(j), _FAR)}
                    yield replace(contact, values=values, candidates=None)
