"""A hundred cubes that fell onto a plate: every pair that touches has a contact."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tests.bodies.fallen import HALF, fallen


@pytest.mark.slow
def test_every_pair_that_touches_has_a_contact_as_deep() -> None:
    """Nearer than a micrometre there is a contact of the pair with its gap."""
    heap, near = fallen(), 0
    for i, j in itertools.combinations(range(len(heap.poses) + 1), 2):
        if i and np.linalg.norm(heap.poses[i - 1, :3] - heap.poses[j - 1, :3]) > 4.0 * HALF:
            continue
        least = heap.least(i, j)
        if least < 1e-6:
            mine = np.all(np.sort(heap.contacts.bodies, axis=1) == (i, j), axis=1) & heap.contacts.within
            assert np.min(np.abs(heap.contacts.gap[mine] - least), initial=np.inf) < 1e-9, (i, j)
            near += 1
    assert near > 50
