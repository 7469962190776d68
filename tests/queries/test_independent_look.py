"""A fixed part of the independent look: every pair that the table of accuracy lists, and all others of its kinds."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Sphere
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.queries.result import DistanceResult
from tests.benchmarks import independent_look as independent
from tests.benchmarks.contact_gaps import Contacts
from tests.benchmarks.independent_look import DRAWN, PAIRS, look, table_pairs


def test_every_pair_of_the_table_is_looked_at() -> None:
    assert table_pairs() <= {frozenset(pair.split("-")) for pair in PAIRS}
    assert frozenset(("mesh",)) in {frozenset(pair.split("-")) for pair in PAIRS}


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("kind", DRAWN)
def test_no_gap_is_wrong(kind: str) -> None:
    """Ours are what planes prove; what libraries say is within the error that they state."""
    pairs = [pair for pair in PAIRS if pair.startswith(f"{kind}-")]
    for pair in pairs:
        tally = look(pair, 6, per_shapes=3)
        assert not tally.wrong, tally.wrong
        assert tally.told + tally.apart == tally.poses
        for library in tally.libraries.values():
            assert library.off == 0
    assert pairs


def test_a_wrong_gap_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ours a ten-thousandth of a millimetre off, on either side."""
    real = Contacts.least
    for off in (1e-7, -1e-7):

        def shifted(self: Contacts, one: Place, two: Place, off: float = off) -> DistanceResult | None:
            found = real(self, one, two)
            return found and dataclasses.replace(found, gap=found.gap + off)

        with monkeypatch.context() as patch:
            patch.setattr(Contacts, "least", shifted)
            assert len(look("ellipsoid-rounded box", 10).wrong) == 10


@pytest.mark.slow
def test_corners_without_a_contact_are_told_from_wrong_gaps() -> None:
    """Two cubes corner to corner have none; a corner over a face, crossed edges and balls have one."""
    cube, ball, here = Box(0.01, 0.01, 0.01), Sphere(0.01), (np.zeros(3), np.eye(3))
    corner = Rotation.align_vectors([[0.0, 0.0, -1.0]], [[1.0, 1.0, 1.0]])[0].as_matrix()
    edges = [Rotation.from_euler(axis, 45, degrees=True).as_matrix() for axis in "xy"]
    for shapes, one, two, none in (
        ((cube, cube), here, (np.array([0.03, 0.03, 0.03]), np.eye(3)), True),
        ((cube, cube), here, (np.array([0.002, 0.001, 0.04]), corner), False),
        ((cube, cube), (np.zeros(3), edges[0]), (np.array([0.001, 0.002, 0.04]), edges[1]), False),
        ((ball, cube), here, (np.array([0.03, 0.03, 0.03]), np.eye(3)), False),
    ):
        found = independent._Asked(*shapes).proved(one, two)
        assert independent.has_no_contact(shapes, one, two, found) == none
