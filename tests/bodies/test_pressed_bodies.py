"""Contacts of bodies that are pressed into each other have the gaps, normals and points of the true faces."""

from __future__ import annotations

import pytest

from tests.bodies.arrangements import ARRANGEMENTS, all_faults

_FLUSH = ["aligned", "turned by 1e-9", "turned by 1e-6", "turned by 1e-3", "turned by a quarter"]
_BOXES = [*_FLUSH, "shifted by 1e-6", "shifted by 1e-3", "shifted", "tilted by 1e-9", "tilted by 1e-6"]
TRUE = {
    "cubes": list(ARRANGEMENTS),
    "bricks": [*_BOXES, "anyhow"],
    "hulls": [*_BOXES, "anyhow"],
    "brick, hull": [*_BOXES, "anyhow"],
    "prisms": ["aligned", "shifted by 1e-6", "turned by 1e-9", "turned by 1e-6", "turned", "tilted by 1e-9", "anyhow"],
    "cylinders": [n for n in ARRANGEMENTS if n not in ("shifted by 1e-6", "shifted by 1e-3", "tilted by 1e-3")],
    "cube, cylinder": [n for n in ARRANGEMENTS if n not in ("turned by 1e-6", "tilted by 1e-9")],
}
"""Pairs with the arrangements in which the features alone, each for itself, tell the faces that are in contact."""


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize(("name", "arrangement"), [(name, row) for name, rows in TRUE.items() for row in rows])
def test_contacts_are_those_of_the_true_faces(name: str, arrangement: str) -> None:
    """At depths of 1e-9 to 1e-2 of the size."""
    assert all_faults(name, arrangement) == []
