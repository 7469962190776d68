"""Flush faces that touch when they start carry the weight, and so do parts that end at one place."""

from __future__ import annotations

import pytest

from tests.physics.test_touching_starts import FLAT, WIDER
from tests.physics.touching import stacked

_SHIFTS = ((0.0, 0.0), (1e-9, 1e-9), (1e-6, 0.0), (1e-3, 0.0))
STACKS: list[tuple[str, tuple[float, float]]] = [
    *((name, shift) for name in FLAT for shift in _SHIFTS),
    *((name, (0.0, 0.0)) for name in (*WIDER, "prism of 6", "prism of 8")),
    *((name, shift) for name in ("hollow box", "compound") for shift in ((1e-6, 0.0), (1e-3, 1e-3))),
]
"""Pair and shift [m] of the upper body."""


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize(("name", "shift"), STACKS, ids=str)
def test_a_flush_body_is_carried(name: str, shift: tuple[float, float]) -> None:
    """It stays where it is, and the forces sum up to the weight."""
    found = stacked(name, 2, 0.0, shift)
    assert found.off < 1e-9
    assert found.forces == pytest.approx((1.0, 1.0), abs=1e-9)
