"""Every pair of features of two shapes as a contact of its own, in place of a search for near features."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

import pytest

from nonsmooth.interfaces import FeaturePair, Shape
from nonsmooth.system.pairing import ContactGeometries, installed_pair

_FAR = 1e150
"""Distance up to which the features of a contact are searched for [m]: without a limit."""


def every_pair(contacts: Sequence[FeaturePair]) -> tuple[FeaturePair, ...]:
    """Return contacts with fixed features: those given, and every pair of features that a search may find.

    Contacts that share a search are replaced by one contact for each pair (kind, i, j) of the ``counts`` of the search,
    in the order of its kinds.
    """
    found, searches = list[FeaturePair](), set[int]()
    for contact in contacts:
        search = contact.candidates
        if search is None:
            found.append(contact)
        elif id(search) not in searches:
            searches.add(id(search))
            for kind, (m, n) in search.counts.items():
                for i, j in itertools.product(range(m), range(n)):
                    values = {**contact.values, "candidate": (kind, float(i), float(j), _FAR)}
                    found.append(replace(contact, values=values, candidates=None))
    return tuple(found)


def pairs_of(first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
    """Return every pair of features of two shapes, in the order of their installed kinematics."""
    installed = installed_pair(first, second)
    assert installed is not None
    kinematics, is_in_order = installed
    return every_pair(kinematics.between(*((first, second) if is_in_order else (second, first))))


@contextmanager
def all_features() -> Iterator[None]:
    """Systems that are made within this context have a contact for every pair of features, without a search."""
    between = ContactGeometries.between

    def every(self: ContactGeometries, first: Shape, second: Shape) -> tuple[Sequence[FeaturePair], bool]:
        contacts, is_in_order = between(self, first, second)
        return every_pair(contacts), is_in_order

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ContactGeometries, "between", every)
        yield
