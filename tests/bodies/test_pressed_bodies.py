"""Contacts of bodies that are pressed into each other have the gaps, normals and points of the true faces."""

from __future__ import annotations

import pytest

from tests.bodies.arrangements import ARRANGEMENTS, PAIRS, all_faults

NOT_TRUE = {
    # a rim crosses a generator or an edge at a small angle, so that the normal leans
    ("cylinders", "tilted by 1e-3"),
    ("cube, cylinder", "tilted by 1e-9"),
    # a corner is past the border of a face, within the margin of closed borders
    ("tetrahedra", "turned by a quarter"),
}
"""Arrangements with a contact that has the true gap, but not the true normal or point."""
CASES = [(name, row) for name in PAIRS for row in ARRANGEMENTS if (name, row) not in NOT_TRUE]


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize(("name", "arrangement"), CASES)
def test_contacts_are_those_of_the_true_faces(name: str, arrangement: str) -> None:
    """At depths of 1e-9 to 1e-2 of the size."""
    assert all_faults(name, arrangement) == []
