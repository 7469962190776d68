"""A hundred cubes that fell onto a plate: every pair that touches has a contact, and a run lists no other cubes."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tests.bodies.fallen import HALF, Fallen, fallen


def _gaps(heap: Fallen) -> dict[tuple[int, int], float]:
    """Return the gaps of the plate, body 0, and the cubes that are near each other [m]."""
    pairs = itertools.combinations(range(len(heap.poses) + 1), 2)
    places = heap.poses[:, :3]
    near = ((i, j) for i, j in pairs if i == 0 or np.linalg.norm(places[i - 1] - places[j - 1]) <= 4.0 * HALF)
    return {pair: heap.least(*pair) for pair in near}


@pytest.mark.slow
@pytest.mark.parametrize(("of_all", "nearer"), [(True, 1e-6), (False, 0.0)])
def test_every_pair_that_touches_has_a_contact_as_deep(of_all: bool, nearer: float) -> None:
    """Nearer than a micrometre there is a contact of the pair with its gap, in a run of pairs that touch."""
    heap = fallen(of_all)
    touching = {pair: gap for pair, gap in _gaps(heap).items() if gap < nearer}
    assert len(touching) > 50
    for pair, gap in touching.items():
        mine = np.all(np.sort(heap.contacts.bodies, axis=1) == pair, axis=1) & heap.contacts.within
        assert np.min(np.abs(heap.contacts.gap[mine] - gap), initial=np.inf) < 1e-9, pair


@pytest.mark.slow
def test_a_run_lists_the_cubes_that_touch_and_no_others() -> None:
    heap = fallen(of_all=False)
    listed = {(i, j) for i, j in np.sort(heap.contacts.bodies, axis=1).tolist() if i > 0}
    assert listed == {pair for pair, gap in _gaps(heap).items() if gap < 0.0 and pair[0] > 0}
