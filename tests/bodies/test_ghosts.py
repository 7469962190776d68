"""No contact of two bodies that are pressed into each other is one of features that the bodies keep apart."""

from __future__ import annotations

import pytest

from tests.bodies.arrangements import ARRANGEMENTS, PAIRS, all_faults
from tests.bodies.test_pressed_bodies import TRUE

OTHERS = [(name, row) for name in PAIRS for row in ARRANGEMENTS if row not in TRUE[name]]


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize(("name", "arrangement"), OTHERS)
def test_contacts_are_those_of_the_true_faces(name: str, arrangement: str) -> None:
    """At depths of 1e-9 to 1e-2 of the size."""
    assert all_faults(name, arrangement) == []
