"""Boxes on springs, shifted or turned a little, or flush on one side: the upper one is carried all the same."""

from __future__ import annotations

import pytest

from tests.physics.test_flush_on_springs import HALF, INDENTED, heights

SHIFTS = [(name, shift, 0.0) for name in ("boxes", "hulls", "meshes") for shift in (1e-12, 1e-9, 1e-6)]
TURNS = [(name, 0.0, turn) for name in ("boxes", "hulls", "meshes") for turn in (1e-9, 1e-6, 1e-3, 0.3)]
SIDES = [
    ("flush on one side", 0.01, 0.0),
    ("flush on one side", 0.01 + 1e-6, 0.0),
    ("flush in one direction", 0.01, 0.0),
]


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("name", "shift", "turn"), [*SHIFTS, *TURNS, *SIDES])
def test_the_upper_body_is_carried(name: str, shift: float, turn: float) -> None:
    assert heights(name, shift, turn) == pytest.approx([HALF, 3.0 * HALF], abs=INDENTED)
