"""Every pair of features of two shapes as a contact of its own, in place of a search for near features."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import pytest

from bodies.contacts.surface.surface_near import EDGE_ACROSS, OVER_FIRST
from bodies.contacts.surface.surface_tables import N_CORNERS, N_EDGES, N_FACES
from nonsmooth.interfaces import FeaturePair, Shape
from nonsmooth.system.pairing import ContactGeometries, installed_pair
from nonsmooth.testing import features


def every_pair(contacts: Sequence[FeaturePair]) -> tuple[FeaturePair, ...]:
    """Return contacts with fixed features: those given, and every pair of features that a search may find."""
    return tuple(features.every_pair(contacts))


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


def parts_of(contact: FeaturePair, number: float) -> tuple[str, str]:
    """Return the kinds of the features of two surfaces that touch, from the number in the geometry block."""
    kind = contact.values["candidate"][0]  # type: ignore[index]
    if kind == EDGE_ACROSS:
        return "edge", "edge"
    surface = np.array(contact.values["surface_a" if kind == OVER_FIRST else "surface_b"])
    ends = np.cumsum([surface[N_FACES], surface[N_EDGES], surface[N_CORNERS]])
    part = ("face", "edge", "corner")[int(np.searchsorted(ends, number, side="right"))]
    return (part, "corner") if kind == OVER_FIRST else ("corner", part)
