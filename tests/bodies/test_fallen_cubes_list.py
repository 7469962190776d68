"""A hundred cubes that fell onto a plate: few contacts are listed, and none of them is a ghost."""

from __future__ import annotations

import numpy as np
import pytest

from tests.bodies.fallen import fallen

MOST = 3000
"""Contacts that may be listed: thirty a cube."""
DEEPER = 1e-6
"""By how much a contact may be deeper than its bodies are inside of each other [m]."""


@pytest.mark.slow
def test_few_contacts_are_listed() -> None:
    count = len(fallen().contacts.contact)
    assert count <= MOST


@pytest.mark.slow
def test_no_contact_is_deeper_than_its_bodies() -> None:
    """No two cubes are deeper inside of each other than the time stepping lets them be, 1e-4 of their extent."""
    heap = fallen()
    pairs = {tuple(row) for row in heap.contacts.bodies.tolist()}
    least = {pair: heap.least(*pair) for pair in pairs}
    assert min(least.values()) > -2e-6
    bounds = np.array([least[tuple(row)] for row in heap.contacts.bodies.tolist()])
    ghosts = heap.contacts.gap < bounds - DEEPER
    found = heap.contacts.gap[ghosts].round(9).tolist()
    assert found == []
