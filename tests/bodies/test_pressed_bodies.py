"""Contacts of bodies that are pressed into each other have the gaps, normals and points of the true faces."""

from __future__ import annotations

import pytest

from tests.bodies.arrangements import ARRANGEMENTS, PAIRS, all_faults

NOT_TRUE = {("cylinders", "tilted by 1e-3"), ("cube, cylinder", "tilted by 1e-9")}
"""Arrangements with a rim that crosses a generator or an edge at a small angle, along a normal that leans by more."""
CASES = [(name, row) for name in PAIRS for row in ARRANGEMENTS if (name, row) not in NOT_TRUE]


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize(("name", "arrangement"), CASES)
def test_contacts_are_those_of_the_true_faces(name: str, arrangement: str) -> None:
    """At depths of 1e-9 to 1e-2 of the size."""
    assert all_faults(name, arrangement) == []
